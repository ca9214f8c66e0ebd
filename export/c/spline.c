
/* Value, first and second derivative of a table's curve; a straight line beyond its ends. */
static void gyro_spline(const double *knots, const double pieces[][4], int n, gyro_real time, gyro_real out[3])
{
    const double t = time;
    double u, value, slope, bend;
    int after = 0, end = n;
    while (after < end) {
        const int middle = after + (end - after) / 2;
        if (knots[middle] <= t)
            after = middle + 1;
        else
            end = middle;
    }
    if (t >= knots[n]) {
        const double *c = pieces[n - 1];
        u = knots[n] - knots[n - 1];
        slope = c[1] + u * (2.0 * c[2] + u * (3.0 * c[3]));
        value = c[0] + u * (c[1] + u * (c[2] + u * c[3]));
        u = t - knots[n];
        value = value + u * (slope + u * (0.0 + u * 0.0));
        slope = slope + u * (2.0 * 0.0 + u * (3.0 * 0.0));
        bend = 2.0 * 0.0 + u * (6.0 * 0.0);
    } else {
        const double *c = pieces[after > 0 ? after - 1 : 0];
        const double c2 = after > 0 ? c[2] : 0.0, c3 = after > 0 ? c[3] : 0.0;
        u = t - knots[after > 0 ? after - 1 : 0];
        value = c[0] + u * (c[1] + u * (c2 + u * c3));
        slope = c[1] + u * (2.0 * c2 + u * (3.0 * c3));
        bend = 2.0 * c2 + u * (6.0 * c3);
    }
    out[0] = (gyro_real)value;
    out[1] = (gyro_real)slope;
    out[2] = (gyro_real)bend;
}
