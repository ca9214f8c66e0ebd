static const double
sinf_s1pio2 = 1*1.57079632679489661923,
sinf_s2pio2 = 2*1.57079632679489661923,
sinf_s3pio2 = 3*1.57079632679489661923,
sinf_s4pio2 = 4*1.57079632679489661923;

static float libm_sinf(float x)
{
    double y;
    uint32_t ix;
    int n, sign;

    GET_FLOAT_WORD(ix, x);
    sign = ix >> 31;
    ix &= 0x7fffffff;

    if (ix <= 0x3f490fda) {
        if (ix < 0x39800000) {
            return x;
        }
        return libm_sindf(x);
    }
    if (ix <= 0x407b53d1) {
        if (ix <= 0x4016cbe3) {
            if (sign)
                return -libm_cosdf(x + sinf_s1pio2);
            else
                return libm_cosdf(x - sinf_s1pio2);
        }
        return libm_sindf(sign ? -(x + sinf_s2pio2) : -(x - sinf_s2pio2));
    }
    if (ix <= 0x40e231d5) {
        if (ix <= 0x40afeddf) {
            if (sign)
                return libm_cosdf(x + sinf_s3pio2);
            else
                return -libm_cosdf(x - sinf_s3pio2);
        }
        return libm_sindf(sign ? x + sinf_s4pio2 : x - sinf_s4pio2);
    }

    if (ix >= 0x7f800000)
        return x - x;

    n = libm_rem_pio2f(x, &y);
    switch (n&3) {
    case 0: return  libm_sindf(y);
    case 1: return  libm_cosdf(y);
    case 2: return  libm_sindf(-y);
    default:
        return -libm_cosdf(y);
    }
}
