static inline uint32_t libm_bits_f32(float x)
{
    union {float f; uint32_t i;} u;
    u.f = x;
    return u.i;
}

#define GET_FLOAT_WORD(w, x) ((w) = libm_bits_f32(x))
