/* A hash of a picture, to hold one machine's against another's. */
#ifndef PICTURE_HASH_H
#define PICTURE_HASH_H

#include <stdint.h>

#define PICTURE_HASH_START UINT32_C(0x811C9DC5)

/* FNV-1a, 32 bits, over n 16-bit units, low byte first. Source: draft-eastlake-fnv. */
uint32_t picture_hash(uint32_t hash, const uint16_t *units, uint32_t n);

#endif
