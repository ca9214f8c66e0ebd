static const double
sin_S1  = -1.66666666666666324348e-01,
sin_S2  =  8.33333333332248946124e-03,
sin_S3  = -1.98412698298579493134e-04,
sin_S4  =  2.75573137070700676789e-06,
sin_S5  = -2.50507602534068634195e-08,
sin_S6  =  1.58969099521155010221e-10;

static double libm_k_sin(double x, double y, int iy)
{
    double z,r,v,w;

    z = x*x;
    w = z*z;
    r = sin_S2 + z*(sin_S3 + z*sin_S4) + z*w*(sin_S5 + z*sin_S6);
    v = z*x;
    if (iy == 0)
        return x + v*(sin_S1 + z*r);
    else
        return x - ((z*(0.5*y - v*r) - y) - v*sin_S1);
}

static const double
cos_C1  =  4.16666666666666019037e-02,
cos_C2  = -1.38888888888741095749e-03,
cos_C3  =  2.48015872894767294178e-05,
cos_C4  = -2.75573143513906633035e-07,
cos_C5  =  2.08757232129817482790e-09,
cos_C6  = -1.13596475577881948265e-11;

static double libm_k_cos(double x, double y)
{
    double hz,z,r,w;

    z  = x*x;
    w  = z*z;
    r  = z*(cos_C1+z*(cos_C2+z*cos_C3)) + w*w*(cos_C4+z*(cos_C5+z*cos_C6));
    hz = 0.5*z;
    w  = 1.0-hz;
    return w + (((1.0-w)-hz) + (z*r-x*y));
}
