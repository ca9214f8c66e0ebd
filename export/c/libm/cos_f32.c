static const double
cosf_c1pio2 = 1*1.57079632679489661923,
cosf_c2pio2 = 2*1.57079632679489661923,
cosf_c3pio2 = 3*1.57079632679489661923,
cosf_c4pio2 = 4*1.57079632679489661923;

static float libm_cosf(float x)
{
    double y;
    uint32_t ix;
    unsigned n, sign;

    GET_FLOAT_WORD(ix, x);
    sign = ix >> 31;
    ix &= 0x7fffffff;

    if (ix <= 0x3f490fda) {
        if (ix < 0x39800000) {
            return 1.0f;
        }
        return libm_cosdf(x);
    }
    if (ix <= 0x407b53d1) {
        if (ix > 0x4016cbe3)
            return -libm_cosdf(sign ? x+cosf_c2pio2 : x-cosf_c2pio2);
        else {
            if (sign)
                return libm_sindf(x + cosf_c1pio2);
            else
                return libm_sindf(cosf_c1pio2 - x);
        }
    }
    if (ix <= 0x40e231d5) {
        if (ix > 0x40afeddf)
            return libm_cosdf(sign ? x+cosf_c4pio2 : x-cosf_c4pio2);
        else {
            if (sign)
                return libm_sindf(-x - cosf_c3pio2);
            else
                return libm_sindf(x - cosf_c3pio2);
        }
    }

    if (ix >= 0x7f800000)
        return x-x;

    n = libm_rem_pio2f(x,&y);
    switch (n&3) {
    case 0: return  libm_cosdf(y);
    case 1: return  libm_sindf(-y);
    case 2: return -libm_cosdf(y);
    default:
        return  libm_sindf(y);
    }
}
