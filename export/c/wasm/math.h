/* What the exported source takes of <math.h>, for a compiler that has no C library: instructions of WebAssembly, and what
 * follows from them. */
#pragma once

#define INFINITY __builtin_inff()
#define isfinite(x) __builtin_isfinite(x)
#define isnan(x) __builtin_isnan(x)
#define sqrt(x) __builtin_sqrt(x)
#define sqrtf(x) __builtin_sqrtf(x)
#define fabs(x) __builtin_fabs(x)
#define fabsf(x) __builtin_fabsf(x)
#define floor(x) __builtin_floor(x)
#define floorf(x) __builtin_floorf(x)

/* Of a number and something that is none, the number. */
static inline double fmax(double a, double b) { return b != b || a > b ? a : b; }
static inline double fmin(double a, double b) { return b != b || a < b ? a : b; }
