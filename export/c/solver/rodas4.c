
/* Rodas4: the L-stable, stiffly accurate Rosenbrock method of order 4 of Hairer and Wanner, Solving Ordinary
 * Differential Equations II (2nd ed. 1996), section VI.4. */

/* Gaussian elimination with row pivoting: factors take the matrix's place, pivots say which row came to stand where. */
static void gyro_factorise(gyro_real *matrix, int *pivots)
{
    enum { N = GYRO_SOLVER_N };
    for (int column = 0; column < N; column++) {
        int best = column;
        for (int row = column + 1; row < N; row++)
            if (FABS(matrix[row * N + column]) > FABS(matrix[best * N + column]))
                best = row;
        pivots[column] = best;
        for (int k = 0; best != column && k < N; k++) {
            const gyro_real element = matrix[column * N + k];
            matrix[column * N + k] = matrix[best * N + k];
            matrix[best * N + k] = element;
        }
        const gyro_real inverse = K(1.0) / matrix[column * N + column];
        for (int row = column + 1; row < N; row++) {
            const gyro_real factor = matrix[row * N + column] * inverse;
            matrix[row * N + column] = factor;
            if (factor == K(0.0))
                continue;
            for (int k = column + 1; k < N; k++)
                matrix[row * N + k] = -factor * matrix[column * N + k] + matrix[row * N + k];
        }
        matrix[column * N + column] = inverse;
    }
}

static void gyro_solve_factors(const gyro_real *factors, const int *pivots, gyro_real *x)
{
    enum { N = GYRO_SOLVER_N };
    for (int row = 0; row < N; row++) {
        const gyro_real element = x[row];
        x[row] = x[pivots[row]];
        x[pivots[row]] = element;
    }
    for (int row = 1; row < N; row++)
        for (int k = 0; k < row; k++)
            x[row] = -factors[row * N + k] * x[k] + x[row];
    for (int row = N - 1; row >= 0; row--) {
        for (int k = row + 1; k < N; k++)
            x[row] = -factors[row * N + k] * x[k] + x[row];
        x[row] = x[row] * factors[row * N + row];
    }
}

/* Of each stage: where its slope is taken, from which changes, and how its right-hand side is made of them. */
static const gyro_stage gyro_rodas4_states[4] = {
    {0.386, 1, {0}, {1.544}},
    {0.21, 2, {0, 1}, {0.9466785280815826, 0.2557011698983284}},
    {0.63, 3, {0, 1, 2}, {3.314825187068521, 2.896124015972201, 0.9986419139977817}},
    {1.0, 4, {0, 1, 2, 3}, {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.687886036105895}}
};

static const gyro_stage gyro_rodas4_sides[5] = {
    {-0.1043, 1, {0}, {-5.6688}},
    {0.1035, 2, {0, 1}, {-2.430093356833875, -0.2063599157091915}},
    {-0.0362, 3, {0, 1, 2}, {-0.1073529058151375, -9.594562251023355, -20.47028614809616}},
    {0.0, 4, {0, 1, 2, 3}, {7.496443313967647, -10.24680431464352, -33.99990352819905, 11.7089089320616}},
    {0.0, 5, {0, 1, 2, 3, 4}, {
        8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136, -6.058818238834054
    }}
};

static const gyro_stage gyro_rodas4_sums[2] = {
    {0.0, 5, {0, 1, 2, 3, 4}, {
        10.12623508344586, -7.487995877610167, -34.80091861555747, -7.992771707568823, 1.025137723295662
    }},
    {0.0, 5, {0, 1, 2, 3, 4}, {
        -0.6762803392801253, 6.087714651680015, 16.43084320892478, 24.76722511418386, -6.594389125716872
    }}
};

static void gyro_rodas4_side(gyro_solver *s, gyro_real *u, double d, gyro_real h)
{
    if (d != 0.0) {
        const gyro_real weight = K(d) * h;
        for (int i = 0; i < GYRO_SOLVER_N; i++)
            u[i] = weight * s->time_slope[i] + u[i];
    }
    gyro_solve_factors(s->factors, s->pivots, u);
}

/* The changes of the stages are s->k[0] to s->k[5], the slope where the step starts is s->k[6]. */
static void gyro_rodas4_attempt(gyro_solver *s, const gyro *m, gyro_real t, gyro_real h, const gyro_real *y,
    int resumes)
{
    enum { N = GYRO_SOLVER_N };
    const gyro_real per_h = K(1.0) / h, diagonal = K(1.0) / (K(0.25) * h);
    gyro_real *slope = s->k[7];
    if (!resumes) {
        gyro_joint_jacobian(m, t, y, s->jacobian, s->time_slope);
        gyro_slope(s, m, t, y, s->k[6]);
        s->statistics.jacobians++;
    }
    for (int i = 0; i < N * N; i++)
        s->factors[i] = -s->jacobian[i];
    for (int i = 0; i < N; i++)
        s->factors[i * (N + 1)] = s->factors[i * (N + 1)] + diagonal;
    gyro_factorise(s->factors, s->pivots);
    for (int i = 0; i < N; i++)
        s->k[0][i] = s->k[6][i];
    gyro_rodas4_side(s, s->k[0], 0.25, h);
    for (int n = 0; n < 5; n++) {
        if (n < 4) {
            gyro_combine(s->stage, y, K(1.0), &gyro_rodas4_states[n], s->k);
        } else {
            for (int i = 0; i < N; i++)
                s->stage[i] = s->stage[i] + s->k[4][i];
        }
        gyro_slope(s, m, t + K(n < 4 ? gyro_rodas4_states[n].c : 1.0) * h, s->stage, slope);
        gyro_combine(s->k[n + 1], slope, per_h, &gyro_rodas4_sides[n], s->k);
        gyro_rodas4_side(s, s->k[n + 1], gyro_rodas4_sides[n].c, h);
    }
    for (int i = 0; i < N; i++)
        s->end[i] = K(1.0) * (K(1.0) * s->k[5][i]) + s->stage[i];
    gyro_normalise_orientations(s->end);
    s->rate[0] = s->rate[1] = K(0.0);
}

static void gyro_rodas4_prepare(gyro_solver *s, const gyro_real *y)
{
    for (int i = 0; i < GYRO_SOLVER_N; i++) {
        s->dense[0][i] = y[i];
        s->dense[1][i] = gyro_sum(&gyro_rodas4_sums[0], s->k, i);
        s->dense[2][i] = gyro_sum(&gyro_rodas4_sums[1], s->k, i);
    }
}

static void gyro_rodas4_between(const gyro_solver *s, gyro_real theta, gyro_real *out)
{
    const gyro_real rest = K(1.0) - theta;
    for (int i = 0; i < GYRO_SOLVER_N; i++) {
        const gyro_real bend = theta * s->dense[2][i] + s->dense[1][i];
        out[i] = rest * s->dense[0][i] + theta * (rest * bend + s->end[i]);
    }
}
