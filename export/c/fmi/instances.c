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

