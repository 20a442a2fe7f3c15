#include <stddef.h>

/* The compiler may call these even in freestanding code; a C library has faster ones. `used`, since with -flto
 * they may be thrown away before it does. */
__attribute__((used)) void *memset(void *to, int c, size_t n);
__attribute__((used)) void *memcpy(void *restrict to, const void *restrict from, size_t n);

void *memset(void *to, int c, size_t n)
{
    for (unsigned char *p = to; n--;) {
        *p++ = (unsigned char)c;
        __asm__ volatile("" ::: "memory"); /* or the loop becomes a call of itself */
    }
    return to;
}
void *memcpy(void *restrict to, const void *restrict from, size_t n)
{
    const unsigned char *q = from;
    for (unsigned char *p = to; n--;) {
        *p++ = *q++;
        __asm__ volatile("" ::: "memory");
    }
    return to;
}
