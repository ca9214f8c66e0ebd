
/* The pair of orders 5 and 4 of Ch. Tsitouras, Computers & Mathematics with Applications 62 (2011), 770-775, with its
 * interpolant of order 4. */
/* The interpolant's coefficients of the square, the cube and the fourth power; the error. */
static const gyro_stage gyro_tsit5_sums[4] = {
    {0.0, 7, {0, 1, 2, 3, 4, 5, 6}, {
        -2.763706197274826, 0.1317, 3.9302962368947516, -12.411077166933676, 37.50931341651104,
        -27.896526289197286, 1.5
    }},
    {0.0, 7, {0, 1, 2, 3, 4, 5, 6}, {
        2.9132554618219126, -0.2234, -5.941033872131505, 30.33818863028232, -88.1789048947664,
        65.09189467479366, -4.0
    }},
    {0.0, 7, {0, 1, 2, 3, 4, 5, 6}, {
        -1.0530884977290216, 0.1017, 2.490627285651253, -16.548102889244902, 47.37952196281928,
        -34.87065786149661, 2.5
    }},
    {0.0, 7, {0, 1, 2, 3, 4, 5, 6}, {
        -0.0017800110522257714, -0.0008164344596567469, 0.007880878010261995, -0.1447110071732629,
        0.5823571654525552, -0.45808210592918695, 1.0 / 66.0
    }}
};

static void gyro_tsit5_attempt(gyro_solver *s, const gyro *m, gyro_real t, gyro_real h, const gyro_real *y, int resumes)
{
    if (!resumes)
        gyro_slope(s, m, t, y, s->k[0]);
    STAGE(s->stage, AT(0, 0.161));
    gyro_slope(s, m, t + K(0.161) * h, s->stage, s->k[1]);
    STAGE(s->stage, AT(0, -0.008480655492356989) + AT(1, 0.335480655492357));
    gyro_slope(s, m, t + K(0.327) * h, s->stage, s->k[2]);
    STAGE(s->stage, AT(0, 2.8971530571054935) + AT(1, -6.359448489975075) + AT(2, 4.3622954328695815));
    gyro_slope(s, m, t + K(0.9) * h, s->stage, s->k[3]);
    STAGE(s->stage, AT(0, 5.325864828439257) + AT(1, -11.748883564062828) + AT(2, 7.4955393428898365)
        + AT(3, -0.09249506636175525));
    gyro_slope(s, m, t + K(0.9800255409045097) * h, s->stage, s->k[4]);
    STAGE(s->stage, AT(0, 5.86145544294642) + AT(1, -12.92096931784711) + AT(2, 8.159367898576159)
        + AT(3, -0.071584973281401) + AT(4, -0.028269050394068383));
    gyro_slope(s, m, t + K(1.0) * h, s->stage, s->k[5]);
    STAGE(s->end, AT(0, 0.09646076681806523) + AT(1, 0.01) + AT(2, 0.4798896504144996)
        + AT(3, 1.379008574103742) + AT(4, -3.290069515436081) + AT(5, 2.324710524099774));
    gyro_normalise_orientations(s->end);
    gyro_slope(s, m, t + K(1.0) * h, s->end, s->k[6]);
    gyro_rate(s->rate, s->k[6], s->k[5], s->end, s->stage);
}

static void gyro_tsit5_prepare(gyro_solver *s, gyro_real h, const gyro_real *y)
{
    for (int i = 0; i < GYRO_SOLVER_N; i++) {
        s->dense[0][i] = y[i];
        s->dense[1][i] = h * s->k[0][i];
        for (int n = 0; n < 3; n++)
            s->dense[n + 2][i] = h * gyro_sum(&gyro_tsit5_sums[n], s->k, i);
    }
}

static void gyro_tsit5_between(const gyro_solver *s, gyro_real theta, gyro_real *out)
{
    for (int i = 0; i < GYRO_SOLVER_N; i++) {
        gyro_real inner = theta * s->dense[4][i] + s->dense[3][i];
        inner = theta * inner + s->dense[2][i];
        out[i] = theta * (theta * inner + s->dense[1][i]) + s->dense[0][i];
    }
}

static gyro_real gyro_tsit5_error(gyro_solver *s, gyro_real h, int *worst)
{
    gyro_real *errors = s->dense[5];
    for (int i = 0; i < GYRO_SOLVER_N; i++)
        errors[i] = h * gyro_sum(&gyro_tsit5_sums[3], s->k, i);
    return gyro_size(errors, s->weights, worst);
}
