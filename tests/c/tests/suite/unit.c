/* A unit of FMI beside the functions and the solver that it is made of: both must give the same bits. */

#include "gyro.h"
#include "fmi3Functions.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEMAND(holds)                                                                                                  \
    do {                                                                                                               \
        if (!(holds)) {                                                                                                \
            printf("line %d: %s\n", __LINE__, #holds);                                                                 \
            return 1;                                                                                                  \
        }                                                                                                              \
    } while (0)

enum { N = GYRO_N_JOINTS, STEPS = 20 };

static const double step = 0.1;

static int do_step(fmi3Instance unit, int k)
{
    fmi3Boolean event, end, early;
    fmi3Float64 reached;
    return fmi3DoStep(unit, k * step, step, fmi3True, &event, &end, &early, &reached) == fmi3OK && !event && !end;
}

int main(int argc, char **argv)
{
    static gyro_solver solver;
    static gyro m;
    gyro_control control = gyro_default_control(1e-9);
    double x[N], expected[N];
    uint32_t states[N], derivatives[N];
    fmi3Instance unit, exchange;
    fmi3FMUState kept = NULL;
    int i, k;
    DEMAND(argc == 2);
    for (i = 0; i < N; i++) {
        states[i] = 1 + (uint32_t)i;
        derivatives[i] = 1 + N + (uint32_t)i;
    }
    gyro_init(&m);
    gyro_joint_start(&m, expected);
    gyro_solver_init(&solver, GYRO_DOP853, 0.0, expected);
    gyro_solver_set_control(&solver, &control);
    DEMAND(gyro_solver_correct(&solver, &m) == GYRO_OK);

    DEMAND(!fmi3InstantiateCoSimulation("unit", "another", NULL, 0, 0, 0, 0, NULL, 0, NULL, NULL, NULL));
    unit = fmi3InstantiateCoSimulation("unit", argv[1], NULL, 0, 0, 0, 0, NULL, 0, NULL, NULL, NULL);
    exchange = fmi3InstantiateModelExchange("other", argv[1], NULL, 0, 0, NULL, NULL);
    DEMAND(unit && exchange);
    DEMAND(fmi3EnterInitializationMode(unit, fmi3False, 0, 0, fmi3False, 0) == fmi3OK);
    DEMAND(fmi3ExitInitializationMode(unit) == fmi3OK);
    DEMAND(fmi3EnterInitializationMode(exchange, fmi3False, 0, 0, fmi3False, 0) == fmi3OK);
    DEMAND(fmi3ExitInitializationMode(exchange) == fmi3OK);
    DEMAND(fmi3EnterContinuousTimeMode(exchange) == fmi3OK);

    for (k = 0; k < STEPS; k++) {
        if (k == STEPS / 2)
            DEMAND(fmi3GetFMUState(unit, &kept) == fmi3OK);
        DEMAND(do_step(unit, k));
        DEMAND(gyro_solver_advance_to(&solver, &m, k * step + step) == GYRO_OK);
        DEMAND(fmi3GetFloat64(unit, states, N, x, N) == fmi3OK);
        DEMAND(!memcmp(x, solver.y, sizeof x));

        DEMAND(fmi3SetTime(exchange, solver.t) == fmi3OK && fmi3SetContinuousStates(exchange, x, N) == fmi3OK);
        DEMAND(fmi3GetFloat64(exchange, derivatives, N, x, N) == fmi3OK);
        gyro_joint_derivative(&m, solver.t, solver.y, expected);
        DEMAND(!memcmp(x, expected, sizeof x));
    }
    DEMAND(fmi3SetFMUState(unit, kept) == fmi3OK);
    for (k = STEPS / 2; k < STEPS; k++)
        DEMAND(do_step(unit, k));
    DEMAND(fmi3GetFloat64(unit, states, N, x, N) == fmi3OK);
    DEMAND(!memcmp(x, solver.y, sizeof x));
    DEMAND(!do_step(unit, 0));
    DEMAND(fmi3Reset(unit) == fmi3OK && !do_step(unit, 0));
    DEMAND(fmi3FreeFMUState(unit, &kept) == fmi3OK && !kept);
    fmi3FreeInstance(unit);
    fmi3FreeInstance(exchange);
    printf("the same bits\n");
    return 0;
}
