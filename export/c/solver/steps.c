
enum { GYRO_WATCH_UNKNOWN, GYRO_WATCH_NEEDLESS, GYRO_WATCH_NEEDED };

static const struct {
    int error_order;
    double stability;
} gyro_methods[4] = {{0, 2.785}, {5, 3.5}, {8, 6.1}, {4, INFINITY}};

static void gyro_attempt_of_method(gyro_solver *s, const gyro *m, gyro_real h)
{
    switch (s->method) {
    case GYRO_RK4:
        gyro_rk4_attempt(s, m, s->t, h, s->y, s->resumes);
        break;
    case GYRO_TSIT5:
        gyro_tsit5_attempt(s, m, s->t, h, s->y, s->resumes);
        break;
    case GYRO_DOP853:
        gyro_dop853_attempt(s, m, s->t, h, s->y, s->resumes);
        break;
    case GYRO_RODAS4:
#if GYRO_HAS_JACOBIAN
        gyro_rodas4_attempt(s, m, s->t, h, s->y, s->resumes);
#endif
        break;
    }
}

/* Makes the end of the last attempt the start of the next; returns whether the slope there is known already. */
static int gyro_carry(gyro_solver *s)
{
    if (s->method == GYRO_TSIT5) {
        for (int i = 0; i < GYRO_SOLVER_N; i++) {
            const gyro_real slope = s->k[0][i];
            s->k[0][i] = s->k[6][i];
            s->k[6][i] = slope;
        }
        return 1;
    }
    s->is_carried = 1;
    return 0;
}

static void gyro_prepare(gyro_solver *s, const gyro *m, gyro_real t, gyro_real h, const gyro_real *y)
{
    switch (s->method) {
    case GYRO_RK4:
        gyro_rk4_prepare(s, m, t, h, y);
        break;
    case GYRO_TSIT5:
        gyro_tsit5_prepare(s, h, y);
        break;
    case GYRO_DOP853:
        gyro_dop853_prepare(s, m, t, h, y);
        break;
    case GYRO_RODAS4:
#if GYRO_HAS_JACOBIAN
        gyro_rodas4_prepare(s, y);
#endif
        break;
    }
}

static void gyro_between_ends(const gyro_solver *s, gyro_real theta, gyro_real *out)
{
    switch (s->method) {
    case GYRO_RK4:
        gyro_rk4_between(s, theta, out);
        break;
    case GYRO_TSIT5:
        gyro_tsit5_between(s, theta, out);
        break;
    case GYRO_DOP853:
        gyro_dop853_between(s, theta, out);
        break;
    case GYRO_RODAS4:
#if GYRO_HAS_JACOBIAN
        gyro_rodas4_between(s, theta, out);
#endif
        break;
    }
}

static gyro_real gyro_error_of_method(gyro_solver *s, gyro_real h, int *worst)
{
    if (s->method == GYRO_TSIT5)
        return gyro_tsit5_error(s, h, worst);
    if (s->method == GYRO_DOP853)
        return gyro_dop853_error(s, h, worst);
    return gyro_size(s->k[5], s->weights, worst);
}

static gyro_status gyro_check_start(gyro_solver *s)
{
    gyro_status status;
    if (s->is_checked)
        return GYRO_OK;
    if ((unsigned)s->method > GYRO_RODAS4 || (s->method == GYRO_RODAS4 && !GYRO_HAS_JACOBIAN))
        return gyro_fail(s, GYRO_INVALID_METHOD, s->t, 0.0, 0.0, 0, NULL);
    if ((status = gyro_check_time(s, s->t, s->t)) != GYRO_OK || (status = gyro_check_finite(s, s->t, s->y)) != GYRO_OK)
        return status;
    s->is_checked = 1;
    return GYRO_OK;
}

/* The time after a step, and what of it rounding takes. */
static void gyro_after(const gyro_solver *s, gyro_real h, gyro_real after[2])
{
    const gyro_real step = h + s->t_rest;
    after[0] = s->t + step;
    after[1] = step - (after[0] - s->t);
}

static void gyro_attempt(gyro_solver *s, const gyro *m, gyro_real h)
{
    if (s->is_kept) {
        s->resumes = gyro_carry(s) && s->is_untouched;
        s->is_kept = 0;
    }
    gyro_attempt_of_method(s, m, h);
    s->resumes = 1;
}

static gyro_status gyro_correct_trial(gyro_solver *s, const gyro *m, gyro_real t, int *is_corrected)
{
    gyro_status status;
    *is_corrected = s->since_correction + 1 >= s->control.correct_every;
    if (*is_corrected) {
        if ((status = gyro_correction(s, m, t, s->trial)) != GYRO_OK)
            return status;
        s->statistics.corrections++;
    }
    return gyro_check_finite(s, t, s->trial);
}

/* Makes the trial the state. */
static void gyro_go_on(gyro_solver *s, const gyro_real after[2], gyro_real h, int is_corrected, const gyro_real *pivot)
{
    s->since_correction = is_corrected ? 0 : s->since_correction + 1;
    s->before_t = s->t;
    s->before_h = h;
    gyro_copy(s->before, s->y);
    gyro_copy(s->y, s->trial);
    s->t = after[0];
    s->t_rest = after[1];
#if GYRO_HAS_LOOPS
    if (pivot != NULL)
        gyro_push(s, s->t, *pivot);
    else
        s->n_past = 0;
#else
    (void)pivot;
#endif
    s->statistics.accepted++;
    s->statistics.longest_step = fmax(s->statistics.longest_step, h);
}

static void gyro_note(gyro_solver *s, double h)
{
    const double slope = s->rate[0], state = s->rate[1], rounding = 100.0 * (double)EPSILON;
    double size = 0.0, rate;
    for (int i = 0; i < GYRO_SOLVER_N; i++)
        size = size + (double)s->y[i] * (double)s->y[i];
    if (!(isfinite(slope) && state > rounding * rounding * size))
        return;
    rate = sqrt(slope / state);
    s->statistics.fastest_rate = fmax(s->statistics.fastest_rate, rate);
    if (rate * h > 0.8 * gyro_methods[s->method].stability) {
        s->statistics.limited_by_stability++;
        s->stiff++;
        s->not_stiff = 0;
    } else if (++s->not_stiff >= 6) {
        s->stiff = 0;
    }
}

static void gyro_keep(gyro_solver *s, const gyro_real after[2], gyro_real h, int is_corrected, const gyro_real *pivot)
{
    s->is_untouched = 1;
    for (int i = 0; is_corrected && i < GYRO_SOLVER_N; i++)
        if (!(s->trial[i] == s->end[i]))
            s->is_untouched = 0;
    gyro_go_on(s, after, h, is_corrected, pivot);
    s->is_kept = 1;
    s->is_prepared = 0;
#if GYRO_HAS_LOOPS
    s->leap = -1;
#endif
    gyro_note(s, h);
}
