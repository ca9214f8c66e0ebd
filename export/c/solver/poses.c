
#if GYRO_HAS_LOOPS
/* Poses with more freedoms than elsewhere are not stepped through but over, by a polynomial through the last states. */

static void gyro_push(gyro_solver *s, gyro_real t, gyro_real pivot)
{
    s->newest = (s->newest + 1) % 10;
    s->past[s->newest].t = t;
    s->past[s->newest].pivot = pivot;
    gyro_copy(s->past[s->newest].y, s->y);
    s->n_past = s->n_past < 10 ? s->n_past + 1 : 10;
}

/* The state so many steps ago. */
static int gyro_age(const gyro_solver *s, int age)
{
    return (s->newest + 10 - age % 10) % 10;
}

/* One over the time between each state and the one that so many are before it, by this number, from 1 on. */
static void gyro_inverse_spans(const gyro_solver *s, gyro_real spans[10][10])
{
    for (int degree = 0; degree < s->n_past; degree++)
        for (int k = 0; k < s->n_past - degree - 1; k++)
            spans[degree][k] = K(1.0) / (s->past[gyro_age(s, k)].t - s->past[gyro_age(s, k + degree + 1)].t);
}

/* The terms of Newton's polynomial of one element. */
static void gyro_terms(const gyro_solver *s, gyro_real spans[10][10], int i, gyro_real t, gyro_real terms[10])
{
    gyro_real differences[10], product = K(1.0);
    for (int age = 0; age < 10; age++)
        differences[age] = s->past[gyro_age(s, age)].y[i];
    for (int degree = 0; degree < s->n_past; degree++) {
        terms[degree] = product * differences[0];
        product = product * (t - s->past[gyro_age(s, degree)].t);
        for (int k = 0; k < s->n_past - degree - 1; k++)
            differences[k] = (differences[k] - differences[k + 1]) * spans[degree][k];
    }
}

static void gyro_polynomial(const gyro_solver *s, gyro_real t, int degree, gyro_real *out)
{
    gyro_real spans[10][10] = {{K(0.0)}};
    gyro_inverse_spans(s, spans);
    for (int i = 0; i < GYRO_SOLVER_N; i++) {
        gyro_real terms[10], sum = K(0.0);
        gyro_terms(s, spans, i, t, terms);
        for (int k = 0; k <= degree && k < s->n_past; k++)
            sum = sum + terms[k];
        out[i] = sum;
    }
}

/* The degree whose next terms are the smallest, and their size in tolerances; -1 where too few states are known. */
static int gyro_best_fit(const gyro_solver *s, gyro_real t, gyro_real rounding, double *error)
{
    double sums[10] = {0.0}, best = 0.0;
    gyro_real spans[10][10] = {{K(0.0)}};
    int degree = -1;
    gyro_inverse_spans(s, spans);
    for (int i = 0; i < GYRO_SOLVER_N; i++) {
        gyro_real terms[10];
        gyro_terms(s, spans, i, t, terms);
        for (int k = 0; k < s->n_past; k++) {
            const gyro_real left = FABS(terms[k]) - rounding;
            const double term = left > K(0.0) ? (double)(left / s->weights[i]) : 0.0;
            sums[k] += term * term;
        }
    }
    for (int n = 1; n + 2 < s->n_past; n++) {
        const double size = fmax(fmax(fmax(0.0, sums[n]), sums[n + 1]), sums[n + 2]);
        if (degree < 0 || size < best) {
            best = size;
            degree = n + 2;
        }
    }
    *error = sqrt(best / (double)GYRO_SOLVER_N);
    return degree;
}

static void gyro_look_out(gyro_solver *s)
{
    if (s->watch == GYRO_WATCH_UNKNOWN)
        s->watch = GYRO_WATCH_NEEDED;
}

static void gyro_watch(gyro_solver *s, const gyro *m)
{
    const char *owner;
    if (s->n_past > 0)
        return;
    gyro_push(s, s->t, gyro_clearance(m, s->t, s->y, &owner));
    s->watch = GYRO_WATCH_NEEDED;
}

/* Names the pose where a failure is but its symptom. */
static gyro_status gyro_blame(gyro_solver *s, const gyro *m, gyro_status status)
{
    const int is_symptom = status == GYRO_NOT_FINITE || (status == GYRO_SINGULAR && s->error.owner == NULL)
        || status == GYRO_STEP_TOO_SHORT || status == GYRO_TOO_MANY_STEPS || status == GYRO_STIFF;
    if (is_symptom && s->watch == GYRO_WATCH_NEEDED) {
        const char *owner;
        const gyro_real pivot = gyro_clearance(m, s->t, s->y, &owner);
        if (pivot < K(1e-3))
            return gyro_fail(s, GYRO_SINGULAR, s->t, pivot, 0.0, 0, owner);
    }
    return status;
}

/* How far rounding changes a correction near a pose. */
static gyro_real gyro_rounding(const gyro_solver *s, gyro_real pivot)
{
    gyro_real largest = K(0.0);
    for (int i = 0; i < GYRO_SOLVER_N; i++)
        if (FABS(s->y[i]) > largest)
            largest = FABS(s->y[i]);
    return EPSILON * largest / (pivot * pivot);
}

/* How far the correction has changed the trial beyond rounding, in tolerances. */
static double gyro_change_beyond(const gyro_solver *s, gyro_real rounding)
{
    double sum = 0.0;
    for (int i = 0; i < GYRO_SOLVER_N; i++) {
        const gyro_real change = (FABS(s->trial[i] - s->raw[i]) - rounding) / s->weights[i];
        const double part = fmax(change, 0.0);
        sum = sum + part * part;
    }
    return sqrt(sum / (double)GYRO_SOLVER_N);
}

/* Corrects the trial; pivot says how far it is from singular poses. */
static gyro_status gyro_settle(gyro_solver *s, const gyro *m, gyro_real t, int *is_corrected, gyro_real *pivot)
{
    const char *owner, *worst_owner;
    gyro_status status;
    gyro_copy(s->raw, s->trial);
    if ((status = gyro_correct_trial(s, m, t, is_corrected)) != GYRO_OK)
        return status;
    *pivot = gyro_clearance(m, t, s->trial, &owner);
    const gyro_real drift = gyro_worst(m, t, s->trial, &worst_owner) + EPSILON;
    if (*pivot * *pivot <= K(100.0) * drift)
        return gyro_fail(s, GYRO_SINGULAR, t, *pivot, 0.0, 0, owner);
    const double found = gyro_change_beyond(s, gyro_rounding(s, *pivot) * K(64.0));
    /* What has drifted over several steps, or came with the start, is not this step's. */
    if (*is_corrected && s->since_correction == 0 && s->n_past > 1 && found > 10.0) {
        double change = 0.0;
        for (int i = 0; i < GYRO_SOLVER_N; i++)
            change = fmax(change, FABS(s->raw[i] - s->trial[i]));
        return gyro_fail(s, GYRO_JUMP, t, change, change * 10.0 / found, 0, owner);
    }
    return GYRO_OK;
}


/* The length of the way over a pose that the motion is coming near to: twice the way to it. Returns whether it is. */
static int gyro_has_pose(const gyro_solver *s, gyro_real *length, gyro_real *pivot)
{
    if (s->n_past < 2)
        return 0;
    const gyro_real now_t = s->past[gyro_age(s, 0)].t, now = s->past[gyro_age(s, 0)].pivot;
    const gyro_real before_t = s->past[gyro_age(s, 1)].t, before = s->past[gyro_age(s, 1)].pivot;
    if (now >= before)
        return 0;
    const gyro_real distance = (now_t - before_t) * now / (before - now);
    *length = distance + distance;
    *pivot = now;
    return 1;
}

/* A shorter step, up to where a pose may be within this one; zero where there is none. */
static int gyro_before_pose(gyro_solver *s, const gyro *m, gyro_real h, gyro_real pivot, gyro_real *shorter)
{
    const char *owner;
    if (s->n_past > 1) {
        const gyro_real now = s->past[gyro_age(s, 0)].pivot, before = s->past[gyro_age(s, 1)].pivot;
        const gyro_real span = s->past[gyro_age(s, 0)].t - s->past[gyro_age(s, 1)].t;
        const gyro_real expected = now + (now - before) / span * h;
        const gyro_real less = pivot < now ? pivot : now;
        if (FABS(pivot - expected) < less * K(0.25))
            return 0;
    }
    gyro_prepare(s, m, s->t, h, s->y);
    gyro_real last = gyro_clearance(m, s->t, s->y, &owner);
    for (int look = 1; look <= 8; look++) {
        const gyro_real theta = K(look / 8.0);
        gyro_between_ends(s, theta, s->raw);
        const gyro_real now = gyro_clearance(m, s->t + theta * h, s->raw, &owner);
        if (now + now < last) {
            *shorter = K((look - 1) / 8.0) * h;
            return 1;
        }
        last = now;
    }
    return 0;
}

/* Steps over a pose by a polynomial through the last states, where they allow it. */
static int gyro_leap(gyro_solver *s, const gyro *m, gyro_real t_end)
{
    gyro_real length, pivot, landing, after[2];
    double error, before;
    int degree, is_corrected;
    if (!gyro_has_pose(s, &length, &pivot))
        return 0;
    if (length < t_end - s->t) {
        gyro_after(s, length, after);
    } else {
        length = t_end - s->t;
        after[0] = t_end;
        after[1] = K(0.0);
    }
    degree = gyro_best_fit(s, after[0], gyro_rounding(s, pivot) * K(8.0), &error);
    if (degree < 0)
        return 0;
    before = 0.0;
    if (s->is_approaching) {
        before = s->approach_error;
        s->approach_error = error;
    }
    if (isnan(error) || error > (error > before ? 100.0 : 1.0))
        return 0;
    gyro_polynomial(s, after[0], degree, s->trial);
    if (gyro_settle(s, m, after[0], &is_corrected, &landing) != GYRO_OK || !(landing > pivot * K(0.25)))
        return 0;
    s->is_untouched = 0;
    gyro_go_on(s, after, length, is_corrected, &landing);
    s->is_kept = s->resumes = 0;
    s->leap = degree;
    s->statistics.leaps++;
    s->next_step = length;
    return 1;
}

static void gyro_begin_approach(gyro_solver *s)
{
    s->is_approaching = 1;
    s->attempts = 0;
    s->approach_error = INFINITY;
}

/* Goes towards a pose by short steps, and over it; says in has_leapt whether it did. */
static gyro_status gyro_approach(gyro_solver *s, const gyro *m, gyro_real t_end, int *has_leapt)
{
    gyro_real length, pivot;
    double sum = 0.0;
    const char *owner;
    *has_leapt = 0;
    if (!gyro_has_pose(s, &length, &pivot)) {
        s->is_approaching = 0;
        return GYRO_OK;
    }
    if (!s->is_approaching && length < s->next_step + s->next_step)
        gyro_begin_approach(s);
    const gyro_real longest = length * K(0.5 * 0.35);
    if (!s->is_approaching)
        return GYRO_OK;
    /* Steps that the tolerance keeps short lead to no pose. */
    s->attempts += s->next_step > longest;
    for (int i = 0; i < GYRO_SOLVER_N; i++)
        s->weights[i] = K(s->control.relative) * FABS(s->y[i]) + K(s->control.absolute);
    const gyro_real change = gyro_rounding(s, pivot) * K(8.0);
    for (int i = 0; i < GYRO_SOLVER_N; i++) {
        const double part = change / s->weights[i];
        sum = sum + part * part;
    }
    if (s->attempts > 300 || sqrt(sum / (double)GYRO_SOLVER_N) > 2e5) {
        gyro_clearance(m, s->t, s->y, &owner);
        return gyro_fail(s, GYRO_SINGULAR, s->t, pivot, 0.0, 0, owner);
    }
    if (gyro_leap(s, m, t_end)) {
        s->is_approaching = 0;
        *has_leapt = 1;
        return GYRO_OK;
    }
    if (s->next_step > longest)
        s->next_step = longest;
    return GYRO_OK;
}
#endif
