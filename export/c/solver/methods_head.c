/* One-step methods. Each has the operations of the Rust crate gyro-sim in the same order. */

#define K(x) ((gyro_real)(x))

/* Weighted slopes of a stage: where in the step it is, how many slopes, which ones, their weights. */
typedef struct {
    double c;
    int n;
    unsigned char k[12];
    double a[12];
} gyro_stage;

/* The weighted sum of one element of the slopes. */
static gyro_real gyro_sum(const gyro_stage *stage, gyro_real k[][GYRO_SOLVER_N], int i)
{
    gyro_real sum = K(stage->a[0]) * k[stage->k[0]][i];
    for (int n = 1; n < stage->n; n++)
        sum = K(stage->a[n]) * k[stage->k[n]][i] + sum;
    return sum;
}

/* out = y + h Σ a k */
static void gyro_combine(gyro_real *out, const gyro_real *y, gyro_real h, const gyro_stage *stage,
    gyro_real k[][GYRO_SOLVER_N])
{
    for (int i = 0; i < GYRO_SOLVER_N; i++)
        out[i] = h * gyro_sum(stage, k, i) + y[i];
}

/* The same with weights that are written out, which compilers make more of: y + h (a sum of weighted slopes). */
#define AT(slope, a) K(a) * s->k[slope][i]
#define STAGE(out, sum) \
    for (int i = 0; i < GYRO_SOLVER_N; i++) \
        (out)[i] = h * (sum) + y[i]

/* The squares of the lengths of two differences, of slopes and of the states that they belong to: a rate. */
static void gyro_rate(gyro_real rate[2], const gyro_real *slope_a, const gyro_real *slope_b,
    const gyro_real *state_a, const gyro_real *state_b)
{
    rate[0] = rate[1] = K(0.0);
    for (int i = 0; i < GYRO_SOLVER_N; i++) {
        const gyro_real d = slope_a[i] - slope_b[i], e = state_a[i] - state_b[i];
        rate[0] = d * d + rate[0];
        rate[1] = e * e + rate[1];
    }
}

/* The root mean square of errors over weights, and the index of the largest. */
static gyro_real gyro_size(const gyro_real *errors, const gyro_real *weights, int *worst)
{
    gyro_real sum = K(0.0), largest = K(0.0);
    *worst = 0;
    for (int i = 0; i < GYRO_SOLVER_N; i++) {
        const gyro_real error = FABS(errors[i] / weights[i]);
        if (!isfinite(error)) {
            *worst = i;
            return K(INFINITY);
        }
        sum = error * error + sum;
        if (error > largest) {
            largest = error;
            *worst = i;
        }
    }
    return SQRT(sum / K(GYRO_SOLVER_N));
}

static void gyro_slope(gyro_solver *s, const gyro *m, gyro_real t, const gyro_real *y, gyro_real *dy)
{
    s->statistics.evaluations++;
    gyro_derivative_of_solver(m, t, y, dy);
}
