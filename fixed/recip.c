/* Reciprocals of normalised mantissas: a table, linear interpolation, one Newton step. The
 * arithmetic is in the header, for the places where a call would cost as much as the work. */
#include "edgewalk/fixed.h"

const uint16_t ew_recip_entries[(1 << EW_RECIP_BITS) + 1] EW_HOT_TABLE = {
#include "recip_table.inc"
};

EW_HOT uint32_t ew_recip_table(uint32_t m) { return ew_recip_table_inline(m); }
EW_HOT uint32_t ew_recip_newton(uint32_t m) { return ew_recip_newton_inline(m); }
