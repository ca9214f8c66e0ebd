
/* The classical method of order 4 (Kutta 1901) with Hermite's cubic between the ends of a step. */
static const gyro_stage gyro_rk4_half = {0.5, 1, {0}, {0.5}}, gyro_rk4_second = {0.5, 1, {1}, {0.5}},
    gyro_rk4_third = {1.0, 1, {2}, {1.0}},
    gyro_rk4_end = {1.0, 4, {0, 1, 2, 3}, {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0}};

static void gyro_rk4_attempt(gyro_solver *s, const gyro *m, gyro_real t, gyro_real h, const gyro_real *y, int resumes)
{
    const gyro_real half = t + h * K(0.5);
    gyro_real *second = s->stage, *third = s->dense[4];
    if (!resumes)
        gyro_slope(s, m, t, y, s->k[0]);
    gyro_combine(second, y, h, &gyro_rk4_half, s->k);
    gyro_slope(s, m, half, second, s->k[1]);
    gyro_combine(third, y, h, &gyro_rk4_second, s->k);
    gyro_slope(s, m, half, third, s->k[2]);
    gyro_combine(s->end, y, h, &gyro_rk4_third, s->k);
    gyro_slope(s, m, t + h, s->end, s->k[3]);
    gyro_combine(s->end, y, h, &gyro_rk4_end, s->k);
    gyro_normalise_orientations(s->end);
    gyro_rate(s->rate, s->k[2], s->k[1], third, second);
}

static void gyro_rk4_prepare(gyro_solver *s, const gyro *m, gyro_real t, gyro_real h, const gyro_real *y)
{
    gyro_real *cube = s->dense[3];
    gyro_slope(s, m, t + h, s->end, cube);
    for (int i = 0; i < GYRO_SOLVER_N; i++) {
        const gyro_real change = s->end[i] - y[i];
        const gyro_real from = h * s->k[0][i], to = h * cube[i];
        const gyro_real left = change - from, right = to - change;
        s->dense[0][i] = y[i];
        s->dense[1][i] = from;
        s->dense[2][i] = left + left - right;
        cube[i] = right - left;
    }
}

static void gyro_rk4_between(const gyro_solver *s, gyro_real theta, gyro_real *out)
{
    for (int i = 0; i < GYRO_SOLVER_N; i++) {
        const gyro_real inner = theta * s->dense[3][i] + s->dense[2][i];
        out[i] = theta * (theta * inner + s->dense[1][i]) + s->dense[0][i];
    }
}
