static const float
logf_ln2_hi = 6.9313812256e-1f,
logf_ln2_lo = 9.0580006145e-6f,
logf_Lg1 = 0.66666662693f,
logf_Lg2 = 0.40000972152f,
logf_Lg3 = 0.28498786688f,
logf_Lg4 = 0.24279078841f;

static float libm_logf(float x)
{
    union {float f; uint32_t i;} u = {x};
    float hfsq, f, s, z, R, w, t1, t2, dk;
    uint32_t ix;
    int k;

    ix = u.i;
    k = 0;
    if (ix < 0x00800000 || ix >> 31) {
        if (ix << 1 == 0)
            return -1/(x*x);
        if (ix >> 31)
            return (x-x)/0.0f;
        k -= 25;
        x *= 0x1p25f;
        u.f = x;
        ix = u.i;
    } else if (ix >= 0x7f800000) {
        return x;
    } else if (ix == 0x3f800000) {
        return 0;
    }

    ix += 0x3f800000 - 0x3f3504f3;
    k += (int)(ix >> 23) - 0x7f;
    ix = (ix & 0x007fffff) + 0x3f3504f3;
    u.i = ix;
    x = u.f;

    f = x - 1;
    s = f/(2+f);
    z = s*s;
    w = z*z;
    t1 = w*(logf_Lg2+w*logf_Lg4);
    t2 = z*(logf_Lg1+w*logf_Lg3);
    R = t2 + t1;
    hfsq = 0.5f*f*f;
    dk = k;
    return s*(hfsq+R) + dk*logf_ln2_lo - hfsq + f + dk*logf_ln2_hi;
}
