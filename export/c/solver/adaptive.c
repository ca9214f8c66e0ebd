
/* Steps under error control. */

static gyro_status gyro_check_control(gyro_solver *s)
{
    const gyro_control *c = &s->control;
    const double smallest = 4.0 * (double)EPSILON;
    if (!(c->relative >= smallest && c->absolute > 0.0 && isfinite(c->relative) && isfinite(c->absolute)))
        return gyro_fail(s, GYRO_INVALID_TOLERANCE, s->t, smallest, 0.0, 0, NULL);
    if (!(c->first_step >= 0.0 && isfinite(c->first_step)))
        return gyro_fail(s, GYRO_INVALID_STEP, s->t, c->first_step, 0.0, 0, NULL);
    if (!(c->smallest_step >= 0.0 && isfinite(c->smallest_step)))
        return gyro_fail(s, GYRO_INVALID_STEP, s->t, c->smallest_step, 0.0, 0, NULL);
    if (!(c->largest_step > 0.0))
        return gyro_fail(s, GYRO_INVALID_STEP, s->t, c->largest_step, 0.0, 0, NULL);
    return GYRO_OK;
}

static double gyro_scaled(const gyro_control *c, gyro_real value, gyro_real y)
{
    const double size = fabs((double)value) / (c->absolute + c->relative * fabs((double)y));
    return isfinite(size) ? size : 0.0;
}

static double gyro_largest(const gyro_solver *s, const gyro_real *values)
{
    double largest = 0.0;
    for (int i = 0; i < GYRO_SOLVER_N; i++)
        largest = fmax(largest, gyro_scaled(&s->control, values[i], s->y[i]));
    return largest;
}

/* Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, section II.4. */
static gyro_real gyro_guess_first_step(gyro_solver *s, const gyro *m, gyro_real t_end)
{
    const double left = t_end - s->t;
    double state, slope, small, bend, steepest, guess;
    gyro_slope(s, m, s->t, s->y, s->trial);
    state = gyro_largest(s, s->y);
    slope = gyro_largest(s, s->trial);
    small = fmin(state < 1e-5 || slope < 1e-5 ? 1e-6 * left : 0.01 * state / slope, left);
    for (int i = 0; i < GYRO_SOLVER_N; i++)
        s->weights[i] = K(small) * s->trial[i] + s->y[i];
    gyro_slope(s, m, s->t + K(small), s->weights, s->before);
    for (int i = 0; i < GYRO_SOLVER_N; i++)
        s->before[i] = s->before[i] - s->trial[i];
    bend = gyro_largest(s, s->before) / small;
    steepest = fmax(slope, bend);
    guess = steepest <= 1e-15 ? small * 1e3
        : libm_pow(0.01 / steepest, 1.0 / (double)gyro_methods[s->method].error_order);
    guess = fmin(fmin(guess, 100.0 * small), left);
    return K(isfinite(guess) && guess > 0.0 ? guess : left * 1e-6);
}

/* The next step's length; is_last: whether it ends at t_end. */
static gyro_real gyro_length(const gyro_solver *s, gyro_real t_end, int *is_last)
{
    const gyro_real left = t_end - s->t, largest = K(s->control.largest_step);
    const gyro_real h = s->next_step > largest ? largest : s->next_step;
    *is_last = left <= h * K(1.01);
    return *is_last ? left : left < h + h ? left * K(0.5) : h;
}

static gyro_status gyro_check_budget(gyro_solver *s, gyro_real t_end, gyro_real h)
{
    const uint64_t taken = s->statistics.accepted + s->statistics.rejected;
    const uint64_t left = s->control.budget > taken ? s->control.budget - taken : 0;
    if (left == 0)
        return gyro_fail(s, GYRO_TOO_MANY_STEPS, s->t, (double)taken, 0.0, 0, NULL);
    if (s->stiff >= 15 && (double)(t_end - s->t) / (double)h > (double)left)
        return gyro_fail(s, GYRO_STIFF, s->t, s->statistics.fastest_rate, h, 0, NULL);
    return GYRO_OK;
}

static void gyro_weigh(gyro_solver *s)
{
    for (int i = 0; i < GYRO_SOLVER_N; i++) {
        const gyro_real start = FABS(s->y[i]), end = FABS(s->end[i]);
        s->weights[i] = K(s->control.relative) * (end > start ? end : start) + K(s->control.absolute);
    }
}

/* By how much the next step may be longer. */
static double gyro_factor(const gyro_solver *s, double error, double before)
{
    const double order = gyro_methods[s->method].error_order, damping = 0.2 / order;
    const double factor = before > 0.0
        ? 0.9 * libm_pow(fmax(error, 1e-10), 0.75 * damping - 1.0 / order) * libm_pow(before, damping)
        : 0.9 * libm_pow(error, -1.0 / order);
    return factor < 0.2 ? 0.2 : factor > 6.0 ? 6.0 : factor;
}

static void gyro_grow(gyro_solver *s, gyro_real h, double error, int has_failed, int is_last)
{
    double factor;
    gyro_real next;
    if (!is_last)
        s->statistics.shortest_step = fmin(s->statistics.shortest_step, h);
    factor = gyro_factor(s, error, s->last_error);
    factor = has_failed ? fmin(factor, 1.0) : factor;
    s->last_error = fmax(error, 1e-4);
    next = h * K(factor);
    /* A step that was cut short says little about the next one. */
    if (!is_last || next > s->next_step)
        s->next_step = next;
}

static double gyro_shortest(const gyro_solver *s)
{
    return fmax(fmax(16.0 * (double)EPSILON * fabs((double)s->t), s->control.smallest_step), DBL_MIN);
}

/* Takes the end of the attempt as the trial, corrects it and keeps it. */
static gyro_status gyro_take(gyro_solver *s, const gyro *m, gyro_real t_end, gyro_real h, int is_last, int *is_cut)
{
    gyro_real after[2] = {t_end, K(0.0)};
    gyro_status status;
    int is_corrected;
    if (!is_last)
        gyro_after(s, h, after);
    gyro_copy(s->trial, s->end);
    *is_cut = 0;
#if GYRO_HAS_LOOPS
    gyro_real pivot, shorter;
    if ((status = gyro_settle(s, m, after[0], &is_corrected, &pivot)) != GYRO_OK)
        return status;
    if (gyro_before_pose(s, m, h, pivot, &shorter)) {
        const gyro_real shortest = h * K(0.2);
        s->statistics.rejected++;
        s->next_step = shorter < shortest ? shortest : shorter;
        *is_cut = 1;
        return GYRO_OK;
    }
    gyro_keep(s, after, h, is_corrected, &pivot);
#else
    if ((status = gyro_correct_trial(s, m, after[0], &is_corrected)) != GYRO_OK)
        return status;
    gyro_keep(s, after, h, is_corrected, NULL);
#endif
    return GYRO_OK;
}

static gyro_status gyro_try_towards(gyro_solver *s, const gyro *m, gyro_real t_end)
{
    gyro_status status;
    int has_failed = 0;
    if ((status = gyro_check_start(s)) != GYRO_OK)
        return status;
    if (gyro_methods[s->method].error_order == 0)
        return gyro_fail(s, GYRO_INVALID_METHOD, s->t, 0.0, 0.0, 0, NULL);
    if ((status = gyro_check_control(s)) != GYRO_OK || (status = gyro_check_time(s, s->t, t_end)) != GYRO_OK)
        return status;
    if (t_end <= s->t)
        return GYRO_OK;
    if (s->next_step == K(0.0))
        s->next_step = gyro_guess_first_step(s, m, t_end);
#if GYRO_HAS_LOOPS
    gyro_watch(s, m);
#endif
    for (;;) {
        int is_last, is_cut, worst;
        gyro_real h;
        double error;
#if GYRO_HAS_LOOPS
        int has_leapt;
        if ((status = gyro_approach(s, m, t_end, &has_leapt)) != GYRO_OK || has_leapt)
            return status;
#endif
        h = gyro_length(s, t_end, &is_last);
        if ((status = gyro_check_budget(s, t_end, h)) != GYRO_OK)
            return status;
        gyro_attempt(s, m, h);
        gyro_weigh(s);
        error = gyro_error_of_method(s, h, &worst);
        if (error <= 1.0) {
            status = gyro_take(s, m, t_end, h, is_last, &is_cut);
            if (status == GYRO_OK && !is_cut) {
                gyro_grow(s, h, error, has_failed, is_last);
                return GYRO_OK;
            }
            if (status == GYRO_OK) {
                has_failed = 1;
                continue;
            }
        } else {
            status = isfinite(error) ? GYRO_OK : gyro_fail(s, GYRO_NOT_FINITE, s->t, 0.0, 0.0, worst, NULL);
        }
        s->statistics.rejected++;
#if GYRO_HAS_LOOPS
        gyro_real length, pivot;
        if (!s->is_approaching && gyro_has_pose(s, &length, &pivot))
            gyro_begin_approach(s);
#endif
        s->next_step = h * K(status != GYRO_OK ? 0.2 : fmin(gyro_factor(s, error, 0.0), 1.0));
        has_failed = 1;
        if ((double)s->next_step < gyro_shortest(s))
            return status != GYRO_OK ? status
                : gyro_fail(s, GYRO_STEP_TOO_SHORT, s->t, s->next_step, 0.0, worst, NULL);
    }
}
