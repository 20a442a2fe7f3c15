/* Unknown inputs for Frama-C's Eva: every value of a range, or every bit pattern, at once. */
#ifndef EW_PROVE_UNKNOWN_H
#define EW_PROVE_UNKNOWN_H

#include <stddef.h>
#include <stdint.h>

#include "__fc_builtin.h"

static inline int any_of(int count) { return Frama_C_interval(0, count - 1); }
static inline uint8_t any8(void) { return (uint8_t)Frama_C_unsigned_char_interval(0, UINT8_MAX); }
static inline uint16_t any16(void) { return (uint16_t)Frama_C_unsigned_short_interval(0, UINT16_MAX); }
static inline uint32_t any32(void) { return (uint32_t)Frama_C_unsigned_long_interval(0, UINT32_MAX); }
static inline uint64_t any64(void) { return Frama_C_unsigned_long_long_interval(0, UINT64_MAX); }
static inline int16_t any_s16(void) { return (int16_t)Frama_C_short_interval(INT16_MIN, INT16_MAX); }
static inline int32_t any_s32(void) { return (int32_t)Frama_C_long_interval(INT32_MIN, INT32_MAX); }
static inline int64_t any_s64(void) { return Frama_C_long_long_interval(INT64_MIN, INT64_MAX); }
static inline int32_t between(int32_t least, int32_t most) { return (int32_t)Frama_C_long_interval(least, most); }

/* NULL or what p points to, without two cases to follow. */
static inline void *perhaps(const void *p) { return Frama_C_nondet_ptr(NULL, (void *)p); }

/* Every bit pattern. */
static inline void any_bytes(void *p, size_t size) { Frama_C_make_unknown(p, size); }

#endif
