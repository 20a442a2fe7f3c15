#include "picture_hash.h"

uint32_t picture_hash(uint32_t hash, const uint16_t *units, uint32_t n)
{
    while (n--) {
        hash = (hash ^ (*units & 0xFFu)) * UINT32_C(0x01000193);
        hash = (hash ^ (uint32_t)(*units++ >> 8)) * UINT32_C(0x01000193);
    }
    return hash;
}
