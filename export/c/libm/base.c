static inline uint64_t libm_bits(double x)
{
    union {double f; uint64_t i;} u;
    u.f = x;
    return u.i;
}

static inline double libm_from_bits(uint64_t i)
{
    union {double f; uint64_t i;} u;
    u.i = i;
    return u.f;
}

#define GET_HIGH_WORD(hi, x) ((hi) = (uint32_t)(libm_bits(x) >> 32))
#define GET_LOW_WORD(lo, x) ((lo) = (uint32_t)libm_bits(x))
#define EXTRACT_WORDS(hi, lo, x) (GET_HIGH_WORD(hi, x), GET_LOW_WORD(lo, x))
#define SET_HIGH_WORD(x, hi) ((x) = libm_from_bits((uint64_t)(uint32_t)(hi) << 32 | (uint32_t)libm_bits(x)))
#define SET_LOW_WORD(x, lo) ((x) = libm_from_bits(libm_bits(x) >> 32 << 32 | (uint32_t)(lo)))
