static const double
sindf_S1 = -0x15555554cbac77.0p-55,
sindf_S2 =  0x111110896efbb2.0p-59,
sindf_S3 = -0x1a00f9e2cae774.0p-65,
sindf_S4 =  0x16cd878c3b46a7.0p-71;

static float libm_sindf(double x)
{
    double r, s, w, z;

    z = x*x;
    w = z*z;
    r = sindf_S3 + z*sindf_S4;
    s = z*x;
    return (x + s*(sindf_S1 + z*sindf_S2)) + s*w*r;
}

static const double
cosdf_C0  = -0x1ffffffd0c5e81.0p-54,
cosdf_C1  =  0x155553e1053a42.0p-57,
cosdf_C2  = -0x16c087e80f1e27.0p-62,
cosdf_C3  =  0x199342e0ee5069.0p-68;

static float libm_cosdf(double x)
{
    double r, w, z;

    z = x*x;
    w = z*z;
    r = cosdf_C2+z*cosdf_C3;
    return ((1.0+z*cosdf_C0) + w*cosdf_C1) + (w*z)*r;
}

static const double
rem_pio2f_toint   = 1.5/DBL_EPSILON,
rem_pio2f_pio4    = 0x1.921fb6p-1,
rem_pio2f_invpio2 = 6.36619772367581382433e-01,
rem_pio2f_pio2_1  = 1.57079631090164184570e+00,
rem_pio2f_pio2_1t = 1.58932547735281966916e-08;

static int libm_rem_pio2f(float x, double *y)
{
    union {float f; uint32_t i;} u = {x};
    double tx[1],ty[1];
    double fn;
    uint32_t ix;
    int n, sign, e0;

    ix = u.i & 0x7fffffff;

    if (ix < 0x4dc90fdb) {
        fn = (double)x*rem_pio2f_invpio2 + rem_pio2f_toint - rem_pio2f_toint;
        n  = (int32_t)fn;
        *y = x - fn*rem_pio2f_pio2_1 - fn*rem_pio2f_pio2_1t;

        if (*y < -rem_pio2f_pio4) {
            n--;
            fn--;
            *y = x - fn*rem_pio2f_pio2_1 - fn*rem_pio2f_pio2_1t;
        } else if (*y > rem_pio2f_pio4) {
            n++;
            fn++;
            *y = x - fn*rem_pio2f_pio2_1 - fn*rem_pio2f_pio2_1t;
        }
        return n;
    }
    if(ix>=0x7f800000) {
        *y = x-x;
        return 0;
    }

    sign = u.i>>31;
    e0 = (ix>>23) - (0x7f+23);
    u.i = ix - (e0<<23);
    tx[0] = u.f;
    n  =  libm_rem_pio2_large(tx,ty,e0,1,0);
    if (sign) {
        *y = -ty[0];
        return -n;
    }
    *y = ty[0];
    return n;
}
