/* An instance holds the mechanism, its joint state and a solver. Variables are numbered as in modelDescription.xml: time,
 * states, their derivatives, inputs, parameters, outputs. */

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    N_STATES = GYRO_N_JOINTS,
    FIRST_STATE = 1,
    FIRST_DERIVATIVE = FIRST_STATE + N_STATES,
    FIRST_INPUT = FIRST_DERIVATIVE + N_STATES,
    FIRST_PARAMETER = FIRST_INPUT + GYRO_N_INPUTS,
    FIRST_OUTPUT = FIRST_PARAMETER + GYRO_N_PARAMETERS,
    END = FIRST_OUTPUT + GYRO_N_OUTPUTS
};

/* A length that an array can have. */
#define AT_LEAST_ONE(n) ((n) > 0 ? (n) : 1)

typedef enum {
    INSTANTIATED = 1,
    INITIALIZATION = 2,
    EVENT = 4,
    CONTINUOUS = 8, /* model exchange between events */
    STEP = 16,      /* co-simulation */
    TERMINATED = 32
} phase;

#define RUNS (EVENT | CONTINUOUS | STEP)

/* All that changes: what an FMU state is a copy of. */
typedef struct {
    fmu_mechanism m;
    gyro_solver solver;
    double t, tolerance;
    double x[N_STATES];
    double dx[N_STATES];
    double outputs[AT_LEAST_ONE(GYRO_N_OUTPUTS)];
    int phase;
    int has_derivatives, has_outputs; /* whether dx and outputs are those of t, x, inputs and parameters */
    int is_moved;                     /* whether the state was set since the solver saw it */
    int is_closing_due;               /* whether loops are to be closed at the next event */
} condition;

typedef struct {
    condition now;
    int is_exchange; /* model exchange, not co-simulation */
    int is_logging;
    fmi3InstanceEnvironment environment;
    fmi3LogMessageCallback log;
} instance;

static fmi3Status report(const instance *c, fmi3Status status, const char *message)
{
    if (c->log && c->is_logging)
        c->log(c->environment, status, status == fmi3Discard ? "logStatusDiscard" : "logStatusError", message);
    return status;
}

static fmi3Status refuse(const instance *c, const char *message)
{
    return report(c, fmi3Error, message);
}

/* Whether a call is allowed now. */
static int is_in(const instance *c, int phases)
{
    return c && (c->now.phase & phases);
}

#define REQUIRE(phases)                                                                                                \
    instance *const c = (instance *)handle;                                                                            \
    if (!c)                                                                                                            \
        return fmi3Error;                                                                                              \
    if (!is_in(c, phases))                                                                                             \
        return refuse(c, "this function may not be called now")

#define NOT_HERE()                                                                                                     \
    instance *const c = (instance *)handle;                                                                            \
    return c ? refuse(c, "the mechanism has no such variable or function") : fmi3Error

static void forget(condition *now)
{
    now->has_derivatives = now->has_outputs = 0;
}

static void begin(condition *now)
{
    memset(now, 0, sizeof *now);
    gyro_init(&now->m);
    gyro_joint_start(&now->m, now->x);
    now->tolerance = FMU_TOLERANCE;
    now->phase = INSTANTIATED;
    now->is_moved = 1;
}

static void prepare_solver(condition *now)
{
    gyro_control control = gyro_default_control(now->tolerance);
    gyro_solver_init(&now->solver, FMU_METHOD, now->t, now->x);
    gyro_solver_set_control(&now->solver, &control);
    now->is_moved = 0;
}

/* Closes the loops of the state. */
static fmi3Status close_loops(instance *c)
{
    condition *const now = &c->now;
    gyro_status status;
    prepare_solver(now);
    status = gyro_solver_correct(&now->solver, &now->m);
    if (status != GYRO_OK)
        return refuse(c, gyro_status_text(status));
    memcpy(now->x, now->solver.y, sizeof now->x);
    forget(now);
    now->is_closing_due = 0;
    return fmi3OK;
}

static int are_finite(const double *values, size_t n)
{
    size_t i;
    for (i = 0; i < n; i++)
        if (!isfinite(values[i]))
            return 0;
    return 1;
}

static fmi3Status derive(instance *c)
{
    condition *const now = &c->now;
    if (!now->has_derivatives) {
        gyro_joint_derivative(&now->m, now->t, now->x, now->dx);
        now->has_derivatives = 1;
    }
    return are_finite(now->dx, N_STATES) ? fmi3OK : report(c, fmi3Discard, "a derivative is not finite in this state");
}

static fmi3Status observe(instance *c)
{
    condition *const now = &c->now;
    if (!now->has_outputs) {
#if FMU_HAS_OUTPUTS
        gyro_joint_outputs(&now->m, now->t, now->x, now->outputs);
#endif
        now->has_outputs = 1;
    }
    return are_finite(now->outputs, GYRO_N_OUTPUTS) ? fmi3OK : report(c, fmi3Discard, "an output is not finite here");
}

/* --- Instances ---------------------------------------------------------------------------------------------------- */

const char *fmi3GetVersion(void)
{
    return fmi3Version;
}

fmi3Status fmi3SetDebugLogging(
    fmi3Instance handle, fmi3Boolean loggingOn, size_t nCategories, const fmi3String categories[])
{
    instance *const c = (instance *)handle;
    (void)nCategories;
    (void)categories;
    if (!c)
        return fmi3Error;
    c->is_logging = loggingOn;
    return fmi3OK;
}

static fmi3Instance instantiate(fmi3String token, int is_exchange, fmi3Boolean loggingOn,
    fmi3InstanceEnvironment environment, fmi3LogMessageCallback log)
{
    instance *c;
    if (!token || strcmp(token, FMU_TOKEN) != 0) {
        if (log)
            log(environment, fmi3Error, "logStatusError", "the instantiation token is not that of this FMU");
        return NULL;
    }
    c = (instance *)calloc(1, sizeof *c);
    if (!c)
        return NULL;
    c->is_exchange = is_exchange;
    c->is_logging = loggingOn;
    c->environment = environment;
    c->log = log;
    begin(&c->now);
    return c;
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String instanceName, fmi3String instantiationToken,
    fmi3String resourcePath, fmi3Boolean visible, fmi3Boolean loggingOn, fmi3InstanceEnvironment instanceEnvironment,
    fmi3LogMessageCallback logMessage)
{
    (void)instanceName;
    (void)resourcePath;
    (void)visible;
    return instantiate(instantiationToken, 1, loggingOn, instanceEnvironment, logMessage);
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String instanceName, fmi3String instantiationToken, fmi3String resourcePath,
    fmi3Boolean visible, fmi3Boolean loggingOn, fmi3Boolean eventModeUsed, fmi3Boolean earlyReturnAllowed,
    const fmi3ValueReference requiredIntermediateVariables[], size_t nRequiredIntermediateVariables,
    fmi3InstanceEnvironment instanceEnvironment, fmi3LogMessageCallback logMessage,
    fmi3IntermediateUpdateCallback intermediateUpdate)
{
    (void)instanceName;
    (void)resourcePath;
    (void)visible;
    (void)eventModeUsed;
    (void)earlyReturnAllowed;
    (void)requiredIntermediateVariables;
    (void)nRequiredIntermediateVariables;
    (void)intermediateUpdate;
    return instantiate(instantiationToken, 0, loggingOn, instanceEnvironment, logMessage);
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String instanceName, fmi3String instantiationToken,
    fmi3String resourcePath, fmi3Boolean visible, fmi3Boolean loggingOn, fmi3InstanceEnvironment instanceEnvironment,
    fmi3LogMessageCallback logMessage, fmi3ClockUpdateCallback clockUpdate, fmi3LockPreemptionCallback lockPreemption,
    fmi3UnlockPreemptionCallback unlockPreemption)
{
    (void)instanceName;
    (void)instantiationToken;
    (void)resourcePath;
    (void)visible;
    (void)clockUpdate;
    (void)lockPreemption;
    (void)unlockPreemption;
    if (logMessage && loggingOn)
        logMessage(instanceEnvironment, fmi3Error, "logStatusError", "there is no scheduled execution of this FMU");
    return NULL;
}

void fmi3FreeInstance(fmi3Instance handle)
{
    free(handle);
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance handle, fmi3Boolean toleranceDefined, fmi3Float64 tolerance,
    fmi3Float64 startTime, fmi3Boolean stopTimeDefined, fmi3Float64 stopTime)
{
    REQUIRE(INSTANTIATED);
    (void)stopTimeDefined;
    (void)stopTime;
    if (!isfinite(startTime))
        return refuse(c, "the start time is not finite");
    if (toleranceDefined && !(tolerance > 0.0 && isfinite(tolerance)))
        return refuse(c, "the tolerance must be positive");
    if (toleranceDefined)
        c->now.tolerance = tolerance;
    c->now.t = startTime;
    c->now.phase = INITIALIZATION;
    forget(&c->now);
    return fmi3OK;
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance handle)
{
    REQUIRE(INITIALIZATION);
    if (close_loops(c) != fmi3OK)
        return fmi3Error;
    c->now.phase = c->is_exchange ? EVENT : STEP;
    return fmi3OK;
}

fmi3Status fmi3EnterEventMode(fmi3Instance handle)
{
    REQUIRE(CONTINUOUS);
    c->now.phase = EVENT;
    return fmi3OK;
}

fmi3Status fmi3Terminate(fmi3Instance handle)
{
    REQUIRE(RUNS);
    c->now.phase = TERMINATED;
    return fmi3OK;
}

fmi3Status fmi3Reset(fmi3Instance handle)
{
    instance *const c = (instance *)handle;
    if (!c)
        return fmi3Error;
    begin(&c->now);
    return fmi3OK;
}

/* --- Variables ---------------------------------------------------------------------------------------------------- */

fmi3Status fmi3GetFloat64(fmi3Instance handle, const fmi3ValueReference valueReferences[], size_t nValueReferences,
    fmi3Float64 values[], size_t nValues)
{
    size_t i;
    REQUIRE(~0);
    if (nValues != nValueReferences)
        return refuse(c, "every variable has one value");
    for (i = 0; i < nValueReferences; i++) {
        const uint32_t v = valueReferences[i];
        fmi3Status status = fmi3OK;
        if (v == 0)
            values[i] = c->now.t;
        else if (v < FIRST_DERIVATIVE)
            values[i] = c->now.x[v - FIRST_STATE];
        else if (v < FIRST_INPUT) {
            status = derive(c);
            values[i] = c->now.dx[v - FIRST_DERIVATIVE];
        }
#if FMU_HAS_INPUTS
        else if (v < FIRST_PARAMETER)
            values[i] = c->now.m.inputs[v - FIRST_INPUT];
#endif
#if FMU_HAS_PARAMETERS
        else if (v < FIRST_OUTPUT)
            values[i] = c->now.m.parameters[v - FIRST_PARAMETER];
#endif
        else if (v < END) {
            status = observe(c);
            values[i] = c->now.outputs[v - FIRST_OUTPUT];
        } else
            return refuse(c, "there is no variable of this value reference");
        if (status != fmi3OK)
            return status;
    }
    return fmi3OK;
}

static fmi3Status set_one(instance *c, uint32_t v, double value)
{
    condition *const now = &c->now;
    if (!isfinite(value))
        return refuse(c, "a variable cannot be set to what is not finite");
    if (v >= FIRST_STATE && v < FIRST_DERIVATIVE) {
        if (now->phase == CONTINUOUS || now->phase == TERMINATED)
            return refuse(c, "states are set here by fmi3SetContinuousStates");
        now->x[v - FIRST_STATE] = value;
        now->is_moved = now->is_closing_due = 1;
    } else if (v >= FIRST_INPUT && v < FIRST_PARAMETER) {
        gyro_set_input(&now->m, (int)(v - FIRST_INPUT), value);
        gyro_solver_changed(&now->solver);
    } else if (v >= FIRST_PARAMETER && v < FIRST_OUTPUT) {
        if (now->phase == CONTINUOUS || now->phase == TERMINATED)
            return refuse(c, "parameters are set before the run and at events");
        gyro_set_parameter(&now->m, (int)(v - FIRST_PARAMETER), value);
        now->is_moved = now->is_closing_due = 1;
    } else
        return refuse(c, "this variable cannot be set");
    forget(now);
    return fmi3OK;
}

fmi3Status fmi3SetFloat64(fmi3Instance handle, const fmi3ValueReference valueReferences[], size_t nValueReferences,
    const fmi3Float64 values[], size_t nValues)
{
    size_t i;
    REQUIRE(INSTANTIATED | INITIALIZATION | RUNS);
    if (nValues != nValueReferences)
        return refuse(c, "every variable has one value");
    for (i = 0; i < nValueReferences; i++) {
        const fmi3Status status = set_one(c, valueReferences[i], values[i]);
        if (status != fmi3OK)
            return status;
    }
    return fmi3OK;
}

/* There are no variables of other types: only an empty list of them can be asked for. */
#define OTHER_TYPE(name, type)                                                                                         \
    fmi3Status fmi3Get##name(fmi3Instance handle, const fmi3ValueReference valueReferences[], size_t nValueReferences, \
        type values[], size_t nValues)                                                                                 \
    {                                                                                                                  \
        REQUIRE(~0);                                                                                                   \
        (void)valueReferences;                                                                                         \
        (void)values;                                                                                                  \
        (void)nValues;                                                                                                 \
        return nValueReferences ? refuse(c, "all variables are of the type Float64") : fmi3OK;                         \
    }                                                                                                                  \
    fmi3Status fmi3Set##name(fmi3Instance handle, const fmi3ValueReference valueReferences[], size_t nValueReferences, \
        const type values[], size_t nValues)                                                                           \
    {                                                                                                                  \
        REQUIRE(~0);                                                                                                   \
        (void)valueReferences;                                                                                         \
        (void)values;                                                                                                  \
        (void)nValues;                                                                                                 \
        return nValueReferences ? refuse(c, "all variables are of the type Float64") : fmi3OK;                         \
    }

OTHER_TYPE(Float32, fmi3Float32)
OTHER_TYPE(Int8, fmi3Int8)
OTHER_TYPE(UInt8, fmi3UInt8)
OTHER_TYPE(Int16, fmi3Int16)
OTHER_TYPE(UInt16, fmi3UInt16)
OTHER_TYPE(Int32, fmi3Int32)
OTHER_TYPE(UInt32, fmi3UInt32)
OTHER_TYPE(Int64, fmi3Int64)
OTHER_TYPE(UInt64, fmi3UInt64)
OTHER_TYPE(Boolean, fmi3Boolean)
OTHER_TYPE(String, fmi3String)

fmi3Status fmi3GetBinary(fmi3Instance handle, const fmi3ValueReference valueReferences[], size_t nValueReferences,
    size_t valueSizes[], fmi3Binary values[], size_t nValues)
{
    REQUIRE(~0);
    (void)valueReferences;
    (void)valueSizes;
    (void)values;
    (void)nValues;
    return nValueReferences ? refuse(c, "all variables are of the type Float64") : fmi3OK;
}

fmi3Status fmi3SetBinary(fmi3Instance handle, const fmi3ValueReference valueReferences[], size_t nValueReferences,
    const size_t valueSizes[], const fmi3Binary values[], size_t nValues)
{
    REQUIRE(~0);
    (void)valueReferences;
    (void)valueSizes;
    (void)values;
    (void)nValues;
    return nValueReferences ? refuse(c, "all variables are of the type Float64") : fmi3OK;
}

fmi3Status fmi3GetClock(
    fmi3Instance handle, const fmi3ValueReference valueReferences[], size_t nValueReferences, fmi3Clock values[])
{
    REQUIRE(~0);
    (void)valueReferences;
    (void)values;
    return nValueReferences ? refuse(c, "there are no clocks") : fmi3OK;
}

fmi3Status fmi3SetClock(
    fmi3Instance handle, const fmi3ValueReference valueReferences[], size_t nValueReferences, const fmi3Clock values[])
{
    REQUIRE(~0);
    (void)valueReferences;
    (void)values;
    return nValueReferences ? refuse(c, "there are no clocks") : fmi3OK;
}

fmi3Status fmi3GetNumberOfVariableDependencies(
    fmi3Instance handle, fmi3ValueReference valueReference, size_t *nDependencies)
{
    (void)valueReference;
    (void)nDependencies;
    NOT_HERE();
}

fmi3Status fmi3GetVariableDependencies(fmi3Instance handle, fmi3ValueReference dependent,
    size_t elementIndicesOfDependent[], fmi3ValueReference independents[], size_t elementIndicesOfIndependents[],
    fmi3DependencyKind dependencyKinds[], size_t nDependencies)
{
    (void)dependent;
    (void)elementIndicesOfDependent;
    (void)independents;
    (void)elementIndicesOfIndependents;
    (void)dependencyKinds;
    (void)nDependencies;
    NOT_HERE();
}

/* --- The whole state ---------------------------------------------------------------------------------------------- */

fmi3Status fmi3GetFMUState(fmi3Instance handle, fmi3FMUState *FMUState)
{
    REQUIRE(~0);
    if (!FMUState)
        return refuse(c, "there is no place for the state");
    if (!*FMUState && !(*FMUState = malloc(sizeof(condition))))
        return refuse(c, "there is no memory left");
    memcpy(*FMUState, &c->now, sizeof(condition));
    return fmi3OK;
}

fmi3Status fmi3SetFMUState(fmi3Instance handle, fmi3FMUState FMUState)
{
    REQUIRE(~0);
    if (!FMUState)
        return refuse(c, "there is no state to go back to");
    memcpy(&c->now, FMUState, sizeof(condition));
    return fmi3OK;
}

fmi3Status fmi3FreeFMUState(fmi3Instance handle, fmi3FMUState *FMUState)
{
    (void)handle;
    if (FMUState) {
        free(*FMUState);
        *FMUState = NULL;
    }
    return fmi3OK;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance handle, fmi3FMUState FMUState, size_t *size)
{
    REQUIRE(~0);
    (void)FMUState;
    *size = sizeof(condition);
    return fmi3OK;
}

fmi3Status fmi3SerializeFMUState(
    fmi3Instance handle, fmi3FMUState FMUState, fmi3Byte serializedState[], size_t size)
{
    REQUIRE(~0);
    if (!FMUState || size < sizeof(condition))
        return refuse(c, "the state does not fit");
    memcpy(serializedState, FMUState, sizeof(condition));
    return fmi3OK;
}

fmi3Status fmi3DeserializeFMUState(
    fmi3Instance handle, const fmi3Byte serializedState[], size_t size, fmi3FMUState *FMUState)
{
    REQUIRE(~0);
    if (size != sizeof(condition))
        return refuse(c, "this is no state of this FMU");
    if (!*FMUState && !(*FMUState = malloc(sizeof(condition))))
        return refuse(c, "there is no memory left");
    memcpy(*FMUState, serializedState, sizeof(condition));
    /* Names of joints are addresses, which another process has elsewhere. */
    ((condition *)*FMUState)->solver.error.owner = NULL;
    return fmi3OK;
}

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

/* --- What mechanisms do not have ---------------------------------------------------------------------------------- */

fmi3Status fmi3EnterConfigurationMode(fmi3Instance handle)
{
    NOT_HERE();
}

fmi3Status fmi3ExitConfigurationMode(fmi3Instance handle)
{
    NOT_HERE();
}

fmi3Status fmi3GetIntervalDecimal(fmi3Instance handle, const fmi3ValueReference valueReferences[],
    size_t nValueReferences, fmi3Float64 intervals[], fmi3IntervalQualifier qualifiers[])
{
    (void)valueReferences, (void)nValueReferences, (void)intervals, (void)qualifiers;
    NOT_HERE();
}

fmi3Status fmi3GetIntervalFraction(fmi3Instance handle, const fmi3ValueReference valueReferences[],
    size_t nValueReferences, fmi3UInt64 counters[], fmi3UInt64 resolutions[], fmi3IntervalQualifier qualifiers[])
{
    (void)valueReferences, (void)nValueReferences, (void)counters, (void)resolutions, (void)qualifiers;
    NOT_HERE();
}

fmi3Status fmi3GetShiftDecimal(
    fmi3Instance handle, const fmi3ValueReference valueReferences[], size_t nValueReferences, fmi3Float64 shifts[])
{
    (void)valueReferences, (void)nValueReferences, (void)shifts;
    NOT_HERE();
}

fmi3Status fmi3GetShiftFraction(fmi3Instance handle, const fmi3ValueReference valueReferences[],
    size_t nValueReferences, fmi3UInt64 counters[], fmi3UInt64 resolutions[])
{
    (void)valueReferences, (void)nValueReferences, (void)counters, (void)resolutions;
    NOT_HERE();
}

fmi3Status fmi3SetIntervalDecimal(fmi3Instance handle, const fmi3ValueReference valueReferences[],
    size_t nValueReferences, const fmi3Float64 intervals[])
{
    (void)valueReferences, (void)nValueReferences, (void)intervals;
    NOT_HERE();
}

fmi3Status fmi3SetIntervalFraction(fmi3Instance handle, const fmi3ValueReference valueReferences[],
    size_t nValueReferences, const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
{
    (void)valueReferences, (void)nValueReferences, (void)counters, (void)resolutions;
    NOT_HERE();
}

fmi3Status fmi3SetShiftDecimal(fmi3Instance handle, const fmi3ValueReference valueReferences[],
    size_t nValueReferences, const fmi3Float64 shifts[])
{
    (void)valueReferences, (void)nValueReferences, (void)shifts;
    NOT_HERE();
}

fmi3Status fmi3SetShiftFraction(fmi3Instance handle, const fmi3ValueReference valueReferences[],
    size_t nValueReferences, const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
{
    (void)valueReferences, (void)nValueReferences, (void)counters, (void)resolutions;
    NOT_HERE();
}

fmi3Status fmi3ActivateModelPartition(
    fmi3Instance handle, fmi3ValueReference clockReference, fmi3Float64 activationTime)
{
    (void)clockReference, (void)activationTime;
    NOT_HERE();
}

/* --- Model exchange ----------------------------------------------------------------------------------------------- */

fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance handle)
{
    REQUIRE(INITIALIZATION | EVENT);
    return fmi3OK;
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance handle, fmi3Boolean *discreteStatesNeedUpdate,
    fmi3Boolean *terminateSimulation, fmi3Boolean *nominalsOfContinuousStatesChanged,
    fmi3Boolean *valuesOfContinuousStatesChanged, fmi3Boolean *nextEventTimeDefined, fmi3Float64 *nextEventTime)
{
    REQUIRE(EVENT | STEP);
    *discreteStatesNeedUpdate = *terminateSimulation = *nominalsOfContinuousStatesChanged = fmi3False;
    *nextEventTimeDefined = fmi3False;
    *nextEventTime = 0.0;
    *valuesOfContinuousStatesChanged = c->now.is_closing_due ? fmi3True : fmi3False;
    return c->now.is_closing_due ? close_loops(c) : fmi3OK;
}

fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance handle)
{
    REQUIRE(EVENT);
    if (!c->is_exchange)
        return refuse(c, "co-simulation has no continuous-time mode");
    c->now.phase = CONTINUOUS;
    return fmi3OK;
}

/* How far the loops of a state are open, in units of what the tolerance admits. */
static double drift(const condition *now)
{
#if FMU_HAS_LOOPS
    double open[GYRO_N_CLOSURE], most = 0.0;
    int i;
    gyro_loop_closure(&now->m, now->t, now->x, open);
    for (i = 0; i < GYRO_N_CLOSURE; i++)
        most = fmax(most, fabs(open[i]));
    return most / now->tolerance;
#else
    (void)now;
    return 0.0;
#endif
}

/* An event is asked for where the loops have drifted open, at which they are closed. */
fmi3Status fmi3CompletedIntegratorStep(fmi3Instance handle, fmi3Boolean noSetFMUStatePriorToCurrentPoint,
    fmi3Boolean *enterEventMode, fmi3Boolean *terminateSimulation)
{
    REQUIRE(CONTINUOUS);
    (void)noSetFMUStatePriorToCurrentPoint;
    c->now.is_closing_due = drift(&c->now) > 1.0;
    *enterEventMode = c->now.is_closing_due ? fmi3True : fmi3False;
    *terminateSimulation = fmi3False;
    return fmi3OK;
}

fmi3Status fmi3SetTime(fmi3Instance handle, fmi3Float64 time)
{
    REQUIRE(EVENT | CONTINUOUS);
    if (!isfinite(time))
        return refuse(c, "the time is not finite");
    c->now.t = time;
    forget(&c->now);
    return fmi3OK;
}

fmi3Status fmi3SetContinuousStates(
    fmi3Instance handle, const fmi3Float64 continuousStates[], size_t nContinuousStates)
{
    REQUIRE(CONTINUOUS);
    if (nContinuousStates != N_STATES)
        return refuse(c, "the number of states is wrong");
    if (!are_finite(continuousStates, N_STATES))
        return report(c, fmi3Discard, "a state is not finite");
    memcpy(c->now.x, continuousStates, sizeof c->now.x);
    forget(&c->now);
    return fmi3OK;
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance handle, fmi3Float64 derivatives[], size_t nContinuousStates)
{
    fmi3Status status;
    REQUIRE(INITIALIZATION | RUNS | TERMINATED);
    if (nContinuousStates != N_STATES)
        return refuse(c, "the number of states is wrong");
    status = derive(c);
    memcpy(derivatives, c->now.dx, sizeof c->now.dx);
    return status;
}

fmi3Status fmi3GetEventIndicators(fmi3Instance handle, fmi3Float64 eventIndicators[], size_t nEventIndicators)
{
    REQUIRE(~0);
    (void)eventIndicators;
    return nEventIndicators ? refuse(c, "there are no event indicators") : fmi3OK;
}

fmi3Status fmi3GetContinuousStates(fmi3Instance handle, fmi3Float64 continuousStates[], size_t nContinuousStates)
{
    REQUIRE(INITIALIZATION | RUNS | TERMINATED);
    if (nContinuousStates != N_STATES)
        return refuse(c, "the number of states is wrong");
    memcpy(continuousStates, c->now.x, sizeof c->now.x);
    return fmi3OK;
}

fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance handle, fmi3Float64 nominals[], size_t nContinuousStates)
{
    size_t i;
    REQUIRE(INITIALIZATION | RUNS | TERMINATED);
    if (nContinuousStates != N_STATES)
        return refuse(c, "the number of states is wrong");
    for (i = 0; i < N_STATES; i++)
        nominals[i] = 1.0;
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance handle, size_t *nEventIndicators)
{
    REQUIRE(~0);
    *nEventIndicators = 0;
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance handle, size_t *nContinuousStates)
{
    REQUIRE(~0);
    *nContinuousStates = N_STATES;
    return fmi3OK;
}

/* --- Co-simulation ------------------------------------------------------------------------------------------------ */

fmi3Status fmi3EnterStepMode(fmi3Instance handle)
{
    NOT_HERE();
}

fmi3Status fmi3GetOutputDerivatives(fmi3Instance handle, const fmi3ValueReference valueReferences[],
    size_t nValueReferences, const fmi3Int32 orders[], fmi3Float64 values[], size_t nValues)
{
    (void)valueReferences, (void)nValueReferences, (void)orders, (void)values, (void)nValues;
    NOT_HERE();
}

/* Inputs are held over a communication step. A step that fails leaves the instance at the time that it reached. */
fmi3Status fmi3DoStep(fmi3Instance handle, fmi3Float64 currentCommunicationPoint, fmi3Float64 communicationStepSize,
    fmi3Boolean noSetFMUStatePriorToCurrentPoint, fmi3Boolean *eventHandlingNeeded, fmi3Boolean *terminateSimulation,
    fmi3Boolean *earlyReturn, fmi3Float64 *lastSuccessfulTime)
{
    double t_end;
    gyro_status status = GYRO_OK;
    REQUIRE(STEP);
    (void)noSetFMUStatePriorToCurrentPoint;
    *eventHandlingNeeded = *terminateSimulation = *earlyReturn = fmi3False;
    *lastSuccessfulTime = c->now.t;
    if (c->is_exchange)
        return refuse(c, "model exchange has no steps");
    t_end = currentCommunicationPoint + communicationStepSize;
    if (!isfinite(t_end) || !(communicationStepSize > 0.0))
        return refuse(c, "a communication step must be positive and finite");
    if (fabs(currentCommunicationPoint - c->now.t) > 1e-9 * communicationStepSize + 1e-13 * fabs(c->now.t))
        return refuse(c, "the communication point is not where the last step has ended");
    if (c->now.is_closing_due && close_loops(c) != fmi3OK)
        return fmi3Error;
    if (c->now.is_moved)
        prepare_solver(&c->now);
    /* Rounding of the communication point must not add a tiny step. */
    if (t_end > c->now.solver.t)
        status = gyro_solver_advance_to(&c->now.solver, &c->now.m, t_end);
    memcpy(c->now.x, c->now.solver.y, sizeof c->now.x);
    *lastSuccessfulTime = c->now.t = c->now.solver.t;
    forget(&c->now);
    return status == GYRO_OK ? fmi3OK : refuse(c, gyro_status_text(status));
}
