static const double
exp_half[2] = {0.5, -0.5},
exp_ln2hi = 6.93147180369123816490e-01,
exp_ln2lo = 1.90821492927058770002e-10,
exp_invln2 = 1.44269504088896338700e+00,
exp_P1 = 1.66666666666666019037e-01,
exp_P2 = -2.77777777770155933842e-03,
exp_P3 = 6.61375632143793436117e-05,
exp_P4 = -1.65339022054652515390e-06,
exp_P5 = 4.13813679705723846039e-08;

static double libm_exp(double x)
{
    double hi, lo, c, xx, y;
    int k, sign;
    uint32_t hx;

    GET_HIGH_WORD(hx, x);
    sign = hx >> 31;
    hx &= 0x7fffffff;

    if (hx >= 0x4086232b) {
        if (isnan(x))
            return x;
        if (x > 709.782712893383973096) {
            x *= 0x1p1023;
            return x;
        }
        if (x < -745.13321910194110842)
            return 0;
    }

    if (hx > 0x3fd62e42) {
        if (hx >= 0x3ff0a2b2)
            k = (int)(exp_invln2*x + exp_half[sign]);
        else
            k = 1 - sign - sign;
        hi = x - k*exp_ln2hi;
        lo = k*exp_ln2lo;
        x = hi - lo;
    } else if (hx > 0x3e300000) {
        k = 0;
        hi = x;
        lo = 0;
    } else {
        return 1 + x;
    }

    xx = x*x;
    c = x - xx*(exp_P1+xx*(exp_P2+xx*(exp_P3+xx*(exp_P4+xx*exp_P5))));
    y = 1 + (x*c/(2-c) - lo + hi);
    return k == 0 ? y : libm_scalbn(y, k);
}
