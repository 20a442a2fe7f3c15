# The layers of the core, each needing only those above it here.
CORE_SRCS += $(addprefix src/raster/,cost.c draw2d.c edge.c fill.c font.c loops.c raster.c setup.c span.c target.c \
  texture.c triangle.c)
CORE_SRCS += $(addprefix src/geometry/,active.c clip.c draw.c light.c picture.c transform.c visible.c)
CORE_SRCS += $(addprefix src/scene/,scene.c)
CORE_SRCS += $(wildcard src/display/*.c)

check-tables: check-font
check-font:
	@mkdir -p $(B)/src
	$(PYTHON) -B src/raster/font_table.py -o $(B)/src/font_table.inc
	cmp src/raster/font_table.inc $(B)/src/font_table.inc
.PHONY: check-font
