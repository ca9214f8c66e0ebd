
/* The solver. It holds all that it needs; it allocates nothing and shares nothing, so that several may run at once. */

/* One-step methods. */
typedef enum {
    GYRO_RK4,     /* order 4, for steps of fixed length */
    GYRO_TSIT5,   /* order 5(4), for moderate tolerances */
    GYRO_DOP853,  /* order 8(5, 3), for fine tolerances */
    GYRO_RODAS4   /* order 4(3), for stiff mechanisms; where the mechanism has the function joint_jacobian */
} gyro_method;

/* What came of a call. */
typedef enum {
    GYRO_OK = 0,
    GYRO_NOT_FINITE,       /* an element of the state is not finite; index: which */
    GYRO_NO_CONVERGENCE,   /* joints cannot be closed; value: what is left open; owner: where */
    GYRO_SINGULAR,         /* a pose with more freedoms than elsewhere; value: the pivot; owner: where */
    GYRO_JUMP,             /* a correction would go too far; value: how far, limit: how far it may; owner: where */
    GYRO_STEP_TOO_SHORT,   /* the tolerance cannot be met; value: the step, s; index: the worst element */
    GYRO_TOO_MANY_STEPS,   /* the budget is spent; value: the steps taken */
    GYRO_STIFF,            /* stability alone keeps the steps short; value: the fastest rate, 1/s; limit: the step, s */
    GYRO_INVALID_STEP,     /* a length of a step that cannot be; value: the length */
    GYRO_INVALID_TIME,     /* a time that is not finite, or not within the last step; value: the time */
    GYRO_INVALID_TOLERANCE,/* value: the smallest relative tolerance that can be */
    GYRO_INVALID_METHOD    /* the mechanism has no Jacobian, or the method no estimate of its error */
} gyro_status;

/* The words of a status. */
const char *gyro_status_text(gyro_status status);

/* What is known of the last failure. */
typedef struct {
    gyro_status status;
    int index;
    const char *owner; /* the joint, coupler or driver; NULL where it is not known */
    double t, value, limit;
} gyro_error;

/* Settings. */
typedef struct {
    double relative, absolute;        /* tolerances of each element of the state */
    double first_step;                /* s; zero: chosen by the solver */
    double smallest_step, largest_step;
    uint64_t budget;                  /* of steps, accepted and rejected */
    uint32_t correct_every;           /* steps between two corrections; 1: after each step */
} gyro_control;

/* What steps have cost, and what they have met. */
typedef struct {
    uint64_t accepted, rejected, corrections, evaluations, jacobians, limited_by_stability, leaps;
    double fastest_rate, shortest_step, longest_step;
} gyro_statistics;

/* A solver. Its fields are its own but for `control`, `statistics` and `error`. */
typedef struct {
    gyro_control control;
    gyro_statistics statistics;
    gyro_error error;
    gyro_method method;
    gyro_real t, t_rest, before_t, before_h, next_step, rate[2];
    gyro_real y[GYRO_SOLVER_N], before[GYRO_SOLVER_N], weights[GYRO_SOLVER_N], trial[GYRO_SOLVER_N];
    gyro_real k[16][GYRO_SOLVER_N], stage[GYRO_SOLVER_N], end[GYRO_SOLVER_N], dense[8][GYRO_SOLVER_N];
    double last_error;
    uint32_t since_correction, stiff, not_stiff;
    int is_kept, is_prepared, is_untouched, is_checked, is_carried, resumes;
#if GYRO_HAS_JACOBIAN
    gyro_real jacobian[GYRO_SOLVER_N * GYRO_SOLVER_N], factors[GYRO_SOLVER_N * GYRO_SOLVER_N];
    gyro_real time_slope[GYRO_SOLVER_N];
    int pivots[GYRO_SOLVER_N];
#endif
#if GYRO_HAS_LOOPS
    /* The last states, for poses that are stepped over. */
    struct {
        gyro_real t, pivot, y[GYRO_SOLVER_N];
    } past[10];
    gyro_real raw[GYRO_SOLVER_N];
    double approach_error;
    int newest, n_past, watch, leap, is_approaching;
    uint32_t attempts;
#endif
} gyro_solver;

/* Starts a solver at time t, in a state of joint coordinates (GYRO_N_JOINTS numbers). */
void gyro_solver_init(gyro_solver *s, gyro_method method, gyro_real t, const gyro_real *x);

/* Settings as they are unless they are changed, with a tolerance. */
gyro_control gyro_default_control(double tolerance);

/* Sets them. */
void gyro_solver_set_control(gyro_solver *s, const gyro_control *control);

/* One step of fixed length h, s. Inputs may be changed between steps; call gyro_solver_changed then. */
gyro_status gyro_solver_step(gyro_solver *s, const gyro *m, gyro_real h);

/* One step under error control, at most to t_end. */
gyro_status gyro_solver_step_towards(gyro_solver *s, const gyro *m, gyro_real t_end);

/* Steps under error control to t_end. A time that is not later than the solver's is reached already: no step, GYRO_OK. */
gyro_status gyro_solver_advance_to(gyro_solver *s, const gyro *m, gyro_real t_end);

/* Closes the loops of the state now, for instance of a start. */
gyro_status gyro_solver_correct(gyro_solver *s, const gyro *m);

/* The state at a time within the last step, or at its end. */
gyro_status gyro_solver_interpolate(gyro_solver *s, const gyro *m, gyro_real t, gyro_real *x);

/* Says that parameters or inputs have changed: what was known of the slope is forgotten. */
void gyro_solver_changed(gyro_solver *s);

/* Sets the state, which the solver goes on from. */
void gyro_solver_set_state(gyro_solver *s, const gyro_real *x);

/* For callers that cannot read this header: the bytes of a solver, its time, and its state (GYRO_N_JOINTS numbers). */
size_t gyro_solver_bytes(void);
gyro_real gyro_solver_time(const gyro_solver *s);
const gyro_real *gyro_solver_state(const gyro_solver *s);
