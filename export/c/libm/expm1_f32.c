static const float
expm1f_ln2_hi      = 6.9313812256e-01,
expm1f_ln2_lo      = 9.0580006145e-06,
expm1f_invln2      = 1.4426950216e+00,

expm1f_Q1 = -3.3333212137e-2,
expm1f_Q2 =  1.5807170421e-3;

static float libm_expm1f(float x)
{
    float y,hi,lo,c=0,t,e,hxs,hfx,r1,twopk;
    union {float f; uint32_t i;} u = {x};
    uint32_t hx = u.i & 0x7fffffff;
    int k, sign = u.i >> 31;

    if (hx >= 0x4195b844) {
        if (hx > 0x7f800000)
            return x;
        if (sign)
            return -1;
        if (hx > 0x42b17217) {
            x *= 0x1p127f;
            return x;
        }
    }

    if (hx > 0x3eb17218) {
        if (hx < 0x3F851592) {
            if (!sign) {
                hi = x - expm1f_ln2_hi;
                lo = expm1f_ln2_lo;
                k =  1;
            } else {
                hi = x + expm1f_ln2_hi;
                lo = -expm1f_ln2_lo;
                k = -1;
            }
        } else {
            k  = expm1f_invln2*x + (sign ? -0.5f : 0.5f);
            t  = k;
            hi = x - t*expm1f_ln2_hi;
            lo = t*expm1f_ln2_lo;
        }
        x = hi-lo;
        c = (hi-x)-lo;
    } else if (hx < 0x33000000) {
        return x;
    } else
        k = 0;

    hfx = 0.5f*x;
    hxs = x*hfx;
    r1 = 1.0f+hxs*(expm1f_Q1+hxs*expm1f_Q2);
    t  = 3.0f - r1*hfx;
    e  = hxs*((r1-t)/(6.0f - x*t));
    if (k == 0)
        return x - (x*e-hxs);
    e  = x*(e-c) - c;
    e -= hxs;

    if (k == -1)
        return 0.5f*(x-e) - 0.5f;
    if (k == 1) {
        if (x < -0.25f)
            return -2.0f*(e-(x+0.5f));
        return 1.0f + 2.0f*(x-e);
    }
    u.i = (0x7f+k)<<23;
    twopk = u.f;
    if (k < 0 || k > 56) {
        y = x - e + 1.0f;
        if (k == 128)
            y = y*2.0f*0x1p127f;
        else
            y = y*twopk;
        return y - 1.0f;
    }
    u.i = (0x7f-k)<<23;
    if (k < 23)
        y = (x-e+(1-u.f))*twopk;
    else
        y = (x-(e+u.f)+1)*twopk;
    return y;
}
