
/* A derivative of a table's curve; the third one is that of the piece that begins at a knot. */
static gyro_real gyro_curve(const double *knots, const double pieces[][4], int n, int order, gyro_real at)
{
    const double x = at;
    gyro_real out[3];
    int after = 0, end = n;
    if (order < 3) {
        gyro_spline(knots, pieces, n, at, out);
        return out[order];
    }
    while (after < end) {
        const int middle = after + (end - after) / 2;
        if (knots[middle] <= x)
            after = middle + 1;
        else
            end = middle;
    }
    return x >= knots[n] || after == 0 ? (gyro_real)0 : (gyro_real)(6.0 * pieces[after - 1][3]);
}
