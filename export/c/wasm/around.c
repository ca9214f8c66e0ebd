/* What JavaScript calls beside the functions of the header: the place of the mechanism, and what C passes in structures.
 * For the mechanism `gyro`. */
#include "gyro.h"

#include <string.h>

#define EXPORT(name) __attribute__((export_name(name)))

void *memcpy(void *restrict to, const void *restrict from, size_t n)
{
    unsigned char *restrict t = to;
    const unsigned char *restrict f = from;
    while (n-- > 0)
        *t++ = *f++;
    return to;
}

void *memset(void *to, int value, size_t n)
{
    unsigned char *t = to;
    while (n-- > 0)
        *t++ = (unsigned char)value;
    return to;
}

static gyro mechanism;

EXPORT("mechanism") const gyro *gyro_wasm_mechanism(void)
{
    return &mechanism;
}
