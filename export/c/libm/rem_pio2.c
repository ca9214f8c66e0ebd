static const double
rem_pio2_toint   = 1.5/DBL_EPSILON,
rem_pio2_pio4    = 0x1.921fb54442d18p-1,
rem_pio2_invpio2 = 6.36619772367581382433e-01,
rem_pio2_pio2_1  = 1.57079632673412561417e+00,
rem_pio2_pio2_1t = 6.07710050650619224932e-11,
rem_pio2_pio2_2  = 6.07710050630396597660e-11,
rem_pio2_pio2_2t = 2.02226624879595063154e-21,
rem_pio2_pio2_3  = 2.02226624871116645580e-21,
rem_pio2_pio2_3t = 8.47842766036889956997e-32;

static int libm_rem_pio2(double x, double *y)
{
    union {double f; uint64_t i;} u = {x};
    double z,w,t,r,fn;
    double tx[3],ty[2];
    uint32_t ix;
    int sign, n, ex, ey, i;

    sign = u.i>>63;
    ix = u.i>>32 & 0x7fffffff;
    if (ix <= 0x400f6a7a) {
        if ((ix & 0xfffff) == 0x921fb)
            goto medium;
        if (ix <= 0x4002d97c) {
            if (!sign) {
                z = x - rem_pio2_pio2_1;
                y[0] = z - rem_pio2_pio2_1t;
                y[1] = (z-y[0]) - rem_pio2_pio2_1t;
                return 1;
            } else {
                z = x + rem_pio2_pio2_1;
                y[0] = z + rem_pio2_pio2_1t;
                y[1] = (z-y[0]) + rem_pio2_pio2_1t;
                return -1;
            }
        } else {
            if (!sign) {
                z = x - 2*rem_pio2_pio2_1;
                y[0] = z - 2*rem_pio2_pio2_1t;
                y[1] = (z-y[0]) - 2*rem_pio2_pio2_1t;
                return 2;
            } else {
                z = x + 2*rem_pio2_pio2_1;
                y[0] = z + 2*rem_pio2_pio2_1t;
                y[1] = (z-y[0]) + 2*rem_pio2_pio2_1t;
                return -2;
            }
        }
    }
    if (ix <= 0x401c463b) {
        if (ix <= 0x4015fdbc) {
            if (ix == 0x4012d97c)
                goto medium;
            if (!sign) {
                z = x - 3*rem_pio2_pio2_1;
                y[0] = z - 3*rem_pio2_pio2_1t;
                y[1] = (z-y[0]) - 3*rem_pio2_pio2_1t;
                return 3;
            } else {
                z = x + 3*rem_pio2_pio2_1;
                y[0] = z + 3*rem_pio2_pio2_1t;
                y[1] = (z-y[0]) + 3*rem_pio2_pio2_1t;
                return -3;
            }
        } else {
            if (ix == 0x401921fb)
                goto medium;
            if (!sign) {
                z = x - 4*rem_pio2_pio2_1;
                y[0] = z - 4*rem_pio2_pio2_1t;
                y[1] = (z-y[0]) - 4*rem_pio2_pio2_1t;
                return 4;
            } else {
                z = x + 4*rem_pio2_pio2_1;
                y[0] = z + 4*rem_pio2_pio2_1t;
                y[1] = (z-y[0]) + 4*rem_pio2_pio2_1t;
                return -4;
            }
        }
    }
    if (ix < 0x413921fb) {
medium:

        fn = (double)x*rem_pio2_invpio2 + rem_pio2_toint - rem_pio2_toint;
        n = (int32_t)fn;
        r = x - fn*rem_pio2_pio2_1;
        w = fn*rem_pio2_pio2_1t;

        if (r - w < -rem_pio2_pio4) {
            n--;
            fn--;
            r = x - fn*rem_pio2_pio2_1;
            w = fn*rem_pio2_pio2_1t;
        } else if (r - w > rem_pio2_pio4) {
            n++;
            fn++;
            r = x - fn*rem_pio2_pio2_1;
            w = fn*rem_pio2_pio2_1t;
        }
        y[0] = r - w;
        u.f = y[0];
        ey = u.i>>52 & 0x7ff;
        ex = ix>>20;
        if (ex - ey > 16) {
            t = r;
            w = fn*rem_pio2_pio2_2;
            r = t - w;
            w = fn*rem_pio2_pio2_2t - ((t-r)-w);
            y[0] = r - w;
            u.f = y[0];
            ey = u.i>>52 & 0x7ff;
            if (ex - ey > 49) {
                t = r;
                w = fn*rem_pio2_pio2_3;
                r = t - w;
                w = fn*rem_pio2_pio2_3t - ((t-r)-w);
                y[0] = r - w;
            }
        }
        y[1] = (r - y[0]) - w;
        return n;
    }

    if (ix >= 0x7ff00000) {
        y[0] = y[1] = x - x;
        return 0;
    }

    u.f = x;
    u.i &= (uint64_t)-1>>12;
    u.i |= (uint64_t)(0x3ff + 23)<<52;
    z = u.f;
    for (i=0; i < 2; i++) {
        tx[i] = (double)(int32_t)z;
        z     = (z-tx[i])*0x1p24;
    }
    tx[i] = z;

    while (tx[i] == 0.0)
        i--;
    n = libm_rem_pio2_large(tx,ty,(int)(ix>>20)-(0x3ff+23),i+1,1);
    if (sign) {
        y[0] = -ty[0];
        y[1] = -ty[1];
        return -n;
    }
    y[0] = ty[0];
    y[1] = ty[1];
    return n;
}
