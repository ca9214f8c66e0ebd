/* --- Derivatives -------------------------------------------------------------------------------------------------- */

#if FMU_HAS_SLOPES
/* Partial derivatives of (f, outputs) by (states, inputs), row by row. */
typedef struct {
    double f_x[N_STATES * N_STATES], f_t[N_STATES], f_i[AT_LEAST_ONE(N_STATES * GYRO_N_INPUTS)];
    double g_x[AT_LEAST_ONE(GYRO_N_OUTPUTS * N_STATES)], g_a[AT_LEAST_ONE(GYRO_N_OUTPUTS * GYRO_N_RATES)];
    double g_i[AT_LEAST_ONE(GYRO_N_OUTPUTS * GYRO_N_INPUTS)];
} slopes;

/* Coordinates and rates: what of the state outputs depend on; work is none of it. */
enum { N_MOVING = N_STATES - FMU_N_WORK, FIRST_RATE = N_MOVING - GYRO_N_RATES };

static fmi3Status find_slopes(instance *c, slopes *found)
{
    condition *const now = &c->now;
    const fmi3Status status = derive(c);
    if (status != fmi3OK)
        return status;
    gyro_joint_jacobian(&now->m, now->t, now->x, found->f_x, found->f_t);
    gyro_joint_input_jacobian(&now->m, now->t, now->x, found->f_i);
#if FMU_HAS_OUTPUTS
    gyro_outputs_by_state(&now->m, now->t, now->x, now->dx + FIRST_RATE, found->g_x);
    gyro_outputs_by_accelerations(&now->m, now->t, now->x, now->dx + FIRST_RATE, found->g_a);
    gyro_outputs_by_inputs(&now->m, now->t, now->x, now->dx + FIRST_RATE, found->g_i);
#endif
    return fmi3OK;
}

/* How a variable changes with (states, inputs). */
static fmi3Status row_of(const instance *c, const slopes *found, uint32_t v, double row[N_STATES + GYRO_N_INPUTS])
{
    int i, k;
    for (i = 0; i < N_STATES + GYRO_N_INPUTS; i++)
        row[i] = 0.0;
    if (v >= FIRST_STATE && v < FIRST_DERIVATIVE)
        row[v - FIRST_STATE] = 1.0;
    else if (v >= FIRST_DERIVATIVE && v < FIRST_INPUT) {
        const size_t n = v - FIRST_DERIVATIVE;
        memcpy(row, found->f_x + n * N_STATES, N_STATES * sizeof *row);
        for (i = 0; i < GYRO_N_INPUTS; i++)
            row[N_STATES + i] = found->f_i[n * GYRO_N_INPUTS + (size_t)i];
    } else if (v >= FIRST_OUTPUT && v < END) {
        const size_t n = v - FIRST_OUTPUT;
        for (i = 0; i < N_MOVING; i++)
            row[i] = found->g_x[n * N_MOVING + (size_t)i];
        for (i = 0; i < GYRO_N_INPUTS; i++)
            row[N_STATES + i] = found->g_i[n * GYRO_N_INPUTS + (size_t)i];
        for (k = 0; k < GYRO_N_RATES; k++) {
            const double slope = found->g_a[n * GYRO_N_RATES + (size_t)k];
            const int at = FIRST_RATE + k;
            for (i = 0; i < N_STATES; i++)
                row[i] += slope * found->f_x[at * N_STATES + i];
            for (i = 0; i < GYRO_N_INPUTS; i++)
                row[N_STATES + i] += slope * found->f_i[at * GYRO_N_INPUTS + i];
        }
    } else
        return refuse(c, "derivatives are known of states, their derivatives and outputs");
    return fmi3OK;
}

/* The place of a state or input among the columns; -1 for another variable. */
static int column_of(uint32_t v)
{
    if (v >= FIRST_STATE && v < FIRST_DERIVATIVE)
        return (int)(v - FIRST_STATE);
    if (v >= FIRST_INPUT && v < FIRST_PARAMETER)
        return (int)(v - FIRST_INPUT) + N_STATES;
    return -1;
}

static fmi3Status multiply(instance *c, const fmi3ValueReference unknowns[], size_t nUnknowns,
    const fmi3ValueReference knowns[], size_t nKnowns, const double seed[], double sensitivity[], int is_adjoint)
{
    double row[N_STATES + GYRO_N_INPUTS];
    size_t i, k;
    fmi3Status status = fmi3OK;
    slopes *const found = (slopes *)malloc(sizeof(slopes));
    if (!found)
        return refuse(c, "there is no memory left");
    status = find_slopes(c, found);
    for (i = 0; i < (is_adjoint ? nKnowns : nUnknowns); i++)
        sensitivity[i] = 0.0;
    for (i = 0; status == fmi3OK && i < nUnknowns; i++) {
        status = row_of(c, found, unknowns[i], row);
        for (k = 0; status == fmi3OK && k < nKnowns; k++) {
            const int column = column_of(knowns[k]);
            if (column < 0)
                status = refuse(c, "derivatives are known by states and inputs");
            else if (is_adjoint)
                sensitivity[k] += row[column] * seed[i];
            else
                sensitivity[i] += row[column] * seed[k];
        }
    }
    free(found);
    return status;
}

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance handle, const fmi3ValueReference unknowns[], size_t nUnknowns,
    const fmi3ValueReference knowns[], size_t nKnowns, const fmi3Float64 seed[], size_t nSeed,
    fmi3Float64 sensitivity[], size_t nSensitivity)
{
    REQUIRE(INITIALIZATION | RUNS | TERMINATED);
    if (nSeed != nKnowns || nSensitivity != nUnknowns)
        return refuse(c, "a number of seeds or sensitivities is wrong");
    return multiply(c, unknowns, nUnknowns, knowns, nKnowns, seed, sensitivity, 0);
}

fmi3Status fmi3GetAdjointDerivative(fmi3Instance handle, const fmi3ValueReference unknowns[], size_t nUnknowns,
    const fmi3ValueReference knowns[], size_t nKnowns, const fmi3Float64 seed[], size_t nSeed,
    fmi3Float64 sensitivity[], size_t nSensitivity)
{
    REQUIRE(INITIALIZATION | RUNS | TERMINATED);
    if (nSeed != nUnknowns || nSensitivity != nKnowns)
        return refuse(c, "a number of seeds or sensitivities is wrong");
    return multiply(c, unknowns, nUnknowns, knowns, nKnowns, seed, sensitivity, 1);
}
#else
fmi3Status fmi3GetDirectionalDerivative(fmi3Instance handle, const fmi3ValueReference unknowns[], size_t nUnknowns,
    const fmi3ValueReference knowns[], size_t nKnowns, const fmi3Float64 seed[], size_t nSeed,
    fmi3Float64 sensitivity[], size_t nSensitivity)
{
    (void)unknowns, (void)nUnknowns, (void)knowns, (void)nKnowns;
    (void)seed, (void)nSeed, (void)sensitivity, (void)nSensitivity;
    NOT_HERE();
}

fmi3Status fmi3GetAdjointDerivative(fmi3Instance handle, const fmi3ValueReference unknowns[], size_t nUnknowns,
    const fmi3ValueReference knowns[], size_t nKnowns, const fmi3Float64 seed[], size_t nSeed,
    fmi3Float64 sensitivity[], size_t nSensitivity)
{
    (void)unknowns, (void)nUnknowns, (void)knowns, (void)nKnowns;
    (void)seed, (void)nSeed, (void)sensitivity, (void)nSensitivity;
    NOT_HERE();
}
#endif

