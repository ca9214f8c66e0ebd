static const float
expf_half[2] = {0.5f, -0.5f},
expf_ln2hi = 6.9314575195e-1f,
expf_ln2lo = 1.4286067653e-6f,
expf_invln2 = 1.4426950216e+0f,
expf_P1 = 1.6666625440e-1f,
expf_P2 = -2.7667332906e-3f;

static float libm_expf(float x)
{
    float hi, lo, c, xx, y;
    int k, sign;
    uint32_t hx;

    GET_FLOAT_WORD(hx, x);
    sign = hx >> 31;
    hx &= 0x7fffffff;

    if (hx >= 0x42aeac50) {
        if (hx > 0x7f800000)
            return x;
        if (hx >= 0x42b17218 && !sign) {
            x *= 0x1p127f;
            return x;
        }
        if (sign && hx >= 0x42cff1b5)
            return 0;
    }

    if (hx > 0x3eb17218) {
        if (hx > 0x3f851592)
            k = (int)(expf_invln2*x + expf_half[sign]);
        else
            k = 1 - sign - sign;
        hi = x - k*expf_ln2hi;
        lo = k*expf_ln2lo;
        x = hi - lo;
    } else if (hx > 0x39000000) {
        k = 0;
        hi = x;
        lo = 0;
    } else {
        return 1 + x;
    }

    xx = x*x;
    c = x - xx*(expf_P1+xx*expf_P2);
    y = 1 + (x*c/(2-c) - lo + hi);
    return k == 0 ? y : libm_scalbnf(y, k);
}
