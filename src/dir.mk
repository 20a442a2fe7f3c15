# The layers of the core, each needing only those above it here.
CORE_SRCS += $(addprefix src/raster/,cost.c edge.c fill.c loops.c raster.c setup.c span.c target.c texture.c triangle.c)
CORE_SRCS += $(addprefix src/geometry/,active.c clip.c draw.c light.c picture.c transform.c)
CORE_SRCS += $(addprefix src/scene/,scene.c)
CORE_SRCS += $(wildcard src/display/*.c)
