
/* Joint coordinates are closed by Newton's iteration; trees have nothing to close. */

static gyro_status gyro_fail(gyro_solver *s, gyro_status status, double t, double value, double limit, int index,
    const char *owner)
{
    s->error.status = status;
    s->error.t = t;
    s->error.value = value;
    s->error.limit = limit;
    s->error.index = index;
    s->error.owner = owner;
    return status;
}

static gyro_status gyro_check_finite(gyro_solver *s, gyro_real t, const gyro_real *y)
{
    for (int i = 0; i < GYRO_SOLVER_N; i++)
        if (!isfinite(y[i]))
            return gyro_fail(s, GYRO_NOT_FINITE, t, 0.0, 0.0, i, NULL);
    return GYRO_OK;
}

static gyro_status gyro_check_time(gyro_solver *s, gyro_real t, gyro_real t_end)
{
    if (isfinite(t) && isfinite(t_end))
        return GYRO_OK;
    return gyro_fail(s, GYRO_INVALID_TIME, t, t_end, 0.0, 0, NULL);
}

static void gyro_copy(gyro_real *to, const gyro_real *from)
{
    for (int i = 0; i < GYRO_SOLVER_N; i++)
        to[i] = from[i];
}

#if GYRO_HAS_LOOPS
/* Of each row that closes a loop: whether it is a length, and whose it is. */
static const struct {
    int is_length;
    const char *owner;
} gyro_closure_rows[GYRO_N_CLOSURE] = {GYRO_CLOSURE_ROWS};

/* The largest violation of a row, lengths in units of the mechanism's size. */
static gyro_real gyro_worst(const gyro *m, gyro_real t, const gyro_real *x, const char **owner)
{
    gyro_real closure[GYRO_N_CLOSURE], worst = K(0.0);
    *owner = NULL;
    gyro_loop_closure(m, t, x, closure);
    for (int n = 0; n < GYRO_N_CLOSURE; n++) {
        const gyro_real row = gyro_closure_rows[n].is_length ? FABS(closure[n] / K(GYRO_SIZE)) : FABS(closure[n]);
        /* What is not finite replaces the worst and is then kept. */
        if (isfinite(worst) && (!isfinite(row) || row > worst || *owner == NULL)) {
            worst = row;
            *owner = gyro_closure_rows[n].owner;
        }
    }
    return worst;
}

/* How large the numbers are that a row subtracts, at least one. */
static gyro_real gyro_magnitude(const gyro *m, gyro_real t, const gyro_real *x)
{
    gyro_real y[GYRO_N_STATE], reach = K(0.0), largest = K(1.0);
    gyro_to_maximal(m, t, x, y);
    for (int body = 0; body < GYRO_N_BODIES; body++)
        for (int k = 0; k < 3; k++)
            if (FABS(y[7 * body + k]) > reach)
                reach = FABS(y[7 * body + k]);
    reach = reach / K(GYRO_SIZE);
    for (int n = 0; n < (int)sizeof gyro_places; n++) {
        if (gyro_places[n] == GYRO_PLACE_ANGLE && FABS(*x) > largest)
            largest = FABS(*x);
        x += gyro_n_coordinates(gyro_places[n]);
    }
    return reach > K(1.0) ? largest * reach : largest;
}

/* A change of more than half a radian or half the mechanism's size leads to another pose. */
static gyro_status gyro_refuse_jump(gyro_solver *s, gyro_real t, const gyro_real *before, const gyro_real *x,
    const char *owner)
{
    for (int n = 0; n < (int)sizeof gyro_places; n++) {
        for (int k = 0; k < gyro_n_coordinates(gyro_places[n]); k++) {
            const unsigned char place = gyro_places[n];
            /* Euler parameters change by half the angle of a turn. */
            const gyro_real scale = place == GYRO_PLACE_ANGLE ? K(1.0)
                : place == GYRO_PLACE_ORIENTATION || (place == GYRO_PLACE_BODY && k >= 3) ? K(2.0)
                : K(1.0) / K(GYRO_SIZE);
            const gyro_real change = FABS((*x++ - *before++) * scale);
            if (change > K(0.5))
                return gyro_fail(s, GYRO_JUMP, t, change, 0.5, 0, owner);
        }
    }
    return GYRO_OK;
}

static gyro_status gyro_correction(gyro_solver *s, const gyro *m, gyro_real t, gyro_real *x)
{
    const gyro_real tolerance = EPSILON * K(16.0);
    gyro_real before[GYRO_SOLVER_N], worst;
    const char *owner;
    gyro_status status;
    gyro_normalise_orientations(x);
    if ((status = gyro_check_finite(s, t, x)) != GYRO_OK)
        return status;
    worst = gyro_worst(m, t, x, &owner);
    for (int iteration = 0; iteration < 10; iteration++) {
        gyro_copy(before, x);
        gyro_close_positions(m, t, x);
        if ((status = gyro_refuse_jump(s, t, before, x, owner)) != GYRO_OK)
            return status;
        gyro_normalise_orientations(x);
        if ((status = gyro_check_finite(s, t, x)) != GYRO_OK)
            return status;
        worst = gyro_worst(m, t, x, &owner);
        if (worst <= tolerance || worst <= tolerance * gyro_magnitude(m, t, x)) {
            gyro_close_velocities(m, t, x);
            return gyro_check_finite(s, t, x);
        }
    }
    return gyro_fail(s, GYRO_NO_CONVERGENCE, t, worst, 0.0, 0, owner);
}

/* How near the rows of the closure's Jacobian are to depending on each other. */
static gyro_real gyro_clearance(const gyro *m, gyro_real t, const gyro_real *x, const char **owner)
{
    gyro_real squares[GYRO_N_CLOSURE], sum = K(0.0), largest = K(0.0);
    int nearest = -1;
    gyro_closure_distances(m, t, x, squares);
    for (int n = 0; n < GYRO_N_CLOSURE; n++) {
        gyro_real square = squares[n];
        if (gyro_closure_rows[n].is_length)
            square = square / (K(GYRO_SIZE) * K(GYRO_SIZE));
        const gyro_real inverse = K(1.0) / square;
        if (!(square > K(0.0) && isfinite(inverse))) {
            *owner = gyro_closure_rows[n].owner;
            return K(0.0);
        }
        sum = sum + inverse;
        if (nearest < 0 || inverse > largest) {
            largest = inverse;
            nearest = n;
        }
    }
    *owner = gyro_closure_rows[nearest].owner;
    return K(1.0) / SQRT(sum);
}
#else
static gyro_status gyro_correction(gyro_solver *s, const gyro *m, gyro_real t, gyro_real *x)
{
    (void)s;
    (void)m;
    (void)t;
    (void)x;
    return GYRO_OK;
}
#endif
