/* The word that start-up paints the free stack with. Also read by the assembler. */
#define STACK_PAINT 0xA5C3E187
