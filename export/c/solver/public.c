
gyro_control gyro_default_control(double tolerance)
{
    gyro_control control;
    control.relative = control.absolute = tolerance;
    control.first_step = control.smallest_step = 0.0;
    control.largest_step = INFINITY;
    control.budget = 10000000;
    control.correct_every = 1;
    return control;
}

void gyro_solver_init(gyro_solver *s, gyro_method method, gyro_real t, const gyro_real *x)
{
    memset(s, 0, sizeof *s);
    s->method = method;
    s->control = gyro_default_control(1e-8);
    s->t = s->before_t = t;
    s->last_error = 1e-4;
    s->statistics.shortest_step = INFINITY;
    gyro_copy(s->y, x);
    gyro_copy(s->before, x);
#if GYRO_HAS_LOOPS
    s->leap = -1;
#endif
}

void gyro_solver_set_control(gyro_solver *s, const gyro_control *control)
{
    s->control = *control;
    s->next_step = K(control->first_step);
}

gyro_status gyro_solver_step(gyro_solver *s, const gyro *m, gyro_real h)
{
    gyro_real after[2];
    gyro_status status;
    int is_corrected;
    if ((status = gyro_check_start(s)) != GYRO_OK)
        return status;
    if (!isfinite(h))
        return gyro_fail(s, GYRO_INVALID_STEP, s->t, h, 0.0, 0, NULL);
#if GYRO_HAS_LOOPS
    gyro_look_out(s);
#endif
    gyro_attempt(s, m, h);
    gyro_after(s, h, after);
    gyro_copy(s->trial, s->end);
    if ((status = gyro_correct_trial(s, m, after[0], &is_corrected)) == GYRO_OK) {
        gyro_keep(s, after, h, is_corrected, NULL);
        return GYRO_OK;
    }
    s->resumes = 0;
    return BLAMED(s, m, status);
}

gyro_status gyro_solver_step_towards(gyro_solver *s, const gyro *m, gyro_real t_end)
{
    const gyro_status status = gyro_try_towards(s, m, t_end);
    return status == GYRO_OK ? status : BLAMED(s, m, status);
}

gyro_status gyro_solver_advance_to(gyro_solver *s, const gyro *m, gyro_real t_end)
{
    gyro_status status;
    do {
        if ((status = gyro_solver_step_towards(s, m, t_end)) != GYRO_OK)
            return status;
    } while (s->t < t_end);
    return GYRO_OK;
}

gyro_status gyro_solver_correct(gyro_solver *s, const gyro *m)
{
    gyro_status status;
    if ((status = gyro_check_time(s, s->t, s->t)) != GYRO_OK)
        return status;
    gyro_copy(s->trial, s->y);
    if ((status = gyro_correction(s, m, s->t, s->trial)) != GYRO_OK)
        return BLAMED(s, m, status);
    gyro_copy(s->y, s->trial);
    s->statistics.corrections++;
    s->since_correction = 0;
    s->is_untouched = 0;
    return GYRO_OK;
}

static void gyro_between(const gyro_solver *s, gyro_real t, gyro_real *x)
{
#if GYRO_HAS_LOOPS
    if (s->leap >= 0)
        gyro_polynomial(s, t, s->leap + 1, x);
    else
#endif
        gyro_between_ends(s, (t - s->before_t) / s->before_h, x);
    gyro_normalise_orientations(x);
}

gyro_status gyro_solver_interpolate(gyro_solver *s, const gyro *m, gyro_real t, gyro_real *x)
{
    gyro_status status;
    int is_known = s->is_kept;
    if (t >= s->t) {
        gyro_copy(x, s->y);
        return GYRO_OK;
    }
#if GYRO_HAS_LOOPS
    is_known = is_known || s->leap >= 0;
#endif
    if (!is_known || !(t >= s->before_t && t <= s->t))
        return gyro_fail(s, GYRO_INVALID_TIME, s->t, t, 0.0, 0, NULL);
    if (!s->is_prepared && s->is_kept) {
        gyro_prepare(s, m, s->before_t, s->before_h, s->before);
        s->is_prepared = 1;
    }
    gyro_between(s, t, x);
    status = gyro_correction(s, m, t, x);
#if GYRO_HAS_LOOPS
    /* Too near a singular pose for a correction the motion between steps is no less smooth. */
    if ((status == GYRO_JUMP || status == GYRO_SINGULAR || status == GYRO_NO_CONVERGENCE)
        && s->watch == GYRO_WATCH_NEEDED) {
        gyro_between(s, t, x);
        return GYRO_OK;
    }
#endif
    return status;
}

void gyro_solver_changed(gyro_solver *s)
{
    s->is_untouched = s->resumes = 0;
#if GYRO_HAS_LOOPS
    s->n_past = 0;
    s->leap = -1;
#endif
}

void gyro_solver_set_state(gyro_solver *s, const gyro_real *x)
{
    gyro_copy(s->y, x);
    s->is_untouched = s->is_checked = 0;
#if GYRO_HAS_LOOPS
    s->n_past = 0;
    s->leap = -1;
#endif
}

const char *gyro_status_text(gyro_status status)
{
    switch (status) {
    case GYRO_OK: return "no failure";
    case GYRO_NOT_FINITE: return "an element of the state is not finite";
    case GYRO_NO_CONVERGENCE: return "the joints cannot be closed";
    case GYRO_SINGULAR: return "the mechanism is in a singular pose";
    case GYRO_JUMP: return "a correction would lead to another pose";
    case GYRO_STEP_TOO_SHORT: return "the tolerance cannot be met";
    case GYRO_TOO_MANY_STEPS: return "the budget of steps is spent";
    case GYRO_STIFF: return "stability keeps the steps too short: take rodas4";
    case GYRO_INVALID_STEP: return "a step of this length cannot be taken";
    case GYRO_INVALID_TIME: return "a time is not finite or not within the last step";
    case GYRO_INVALID_TOLERANCE: return "tolerances must be positive, and not below what numbers can tell";
    case GYRO_INVALID_METHOD: return "this mechanism or call has no such method";
    }
    return "unknown";
}

size_t gyro_solver_bytes(void)
{
    return sizeof(gyro_solver);
}

gyro_real gyro_solver_time(const gyro_solver *s)
{
    return s->t;
}

const gyro_real *gyro_solver_state(const gyro_solver *s)
{
    return s->y;
}
