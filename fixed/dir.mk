# Numbers: formats, reciprocals, vectors, matrices, quaternions.
CORE_SRCS += $(addprefix fixed/,arithmetic.c error.c matrix.c quaternion.c recip.c vector.c)

check-tables:  ## make the generated tables again and compare them byte for byte
	@mkdir -p $(B)/fixed
	$(PYTHON) fixed/recip_table.py -o $(B)/fixed/recip_table.inc
	cmp fixed/recip_table.inc $(B)/fixed/recip_table.inc
	$(PYTHON) fixed/quaternion_table.py -o $(B)/fixed/quaternion_table.inc
	cmp fixed/quaternion_table.inc $(B)/fixed/quaternion_table.inc
.PHONY: check-tables
