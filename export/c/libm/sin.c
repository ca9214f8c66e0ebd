static double libm_sin(double x)
{
    double y[2];
    uint32_t ix;
    unsigned n;

    GET_HIGH_WORD(ix, x);
    ix &= 0x7fffffff;

    if (ix <= 0x3fe921fb) {
        if (ix < 0x3e500000) {
            return x;
        }
        return libm_k_sin(x, 0.0, 0);
    }

    if (ix >= 0x7ff00000)
        return x - x;

    n = libm_rem_pio2(x, y);
    switch (n&3) {
    case 0: return  libm_k_sin(y[0], y[1], 1);
    case 1: return  libm_k_cos(y[0], y[1]);
    case 2: return -libm_k_sin(y[0], y[1], 1);
    default:
        return -libm_k_cos(y[0], y[1]);
    }
}
