static inline uint32_t libm_bits_f32(float x)
{
    union {float f; uint32_t i;} u;
    u.f = x;
    return u.i;
}

static inline float libm_from_bits_f32(uint32_t i)
{
    union {float f; uint32_t i;} u;
    u.i = i;
    return u.f;
}

#define GET_FLOAT_WORD(w, x) ((w) = libm_bits_f32(x))
#define SET_FLOAT_WORD(x, w) ((x) = libm_from_bits_f32(w))
