/* Calls that nobody should make: each is answered by a status, none by a crash. For the mechanism `gyro`. */
#include "gyro.h"

#include <math.h>
#include <stdio.h>

static gyro_solver solver;
static gyro_real x[GYRO_N_JOINTS], y[GYRO_N_STATE];

/* A solver in a state with one number replaced; to a time, by a method, with tolerances. */
static gyro_status run(const gyro *m, int method, int place, gyro_real number, gyro_real t, gyro_real t_end,
    double tolerance)
{
    gyro_control control = gyro_default_control(tolerance);
    control.budget = 200;
    gyro_joint_start(m, x);
    if (place >= 0)
        x[place] = number;
    gyro_solver_init(&solver, (gyro_method)method, t, x);
    gyro_solver_set_control(&solver, &control);
    return gyro_solver_advance_to(&solver, m, t_end);
}

int main(void)
{
    static const double numbers[] = {NAN, INFINITY, -INFINITY, 1e308, -1e308, 1e-310, 0.0, -0.0, 1e16};
    static const double tolerances[] = {1e-8, 1e300, 1e-300, 0.0, -1.0, NAN, INFINITY, 1.0};
    unsigned counts[16] = {0};
    gyro m;
    gyro_init(&m);
    for (int method = -1; method <= 5; method++) {
        for (int n = 0; n < (int)(sizeof numbers / sizeof *numbers); n++) {
            const gyro_real number = (gyro_real)numbers[n];
            for (int place = 0; place < GYRO_N_JOINTS; place++) {
                counts[run(&m, method, place, number, 0, 1, 1e-4)]++;
                counts[gyro_solver_step(&solver, &m, (gyro_real)1e-3)]++;
            }
            counts[run(&m, method, -1, 0, number, 1, 1e-4)]++;
            counts[run(&m, method, -1, 0, 0, number, 1e-4)]++;
            counts[gyro_solver_step(&solver, &m, number)]++;
            counts[gyro_solver_interpolate(&solver, &m, number, x)]++;
            counts[gyro_solver_correct(&solver, &m)]++;
            if (gyro_set_parameter(&m, -1, number) || gyro_set_parameter(&m, GYRO_N_PARAMETERS, number)
                || gyro_set_input(&m, -1, number) || gyro_set_input(&m, GYRO_N_INPUTS, number))
                return 1;
            for (int place = 0; place < GYRO_N_PARAMETERS; place++) {
                if (gyro_set_parameter(&m, place, number) != !!isfinite(number))
                    return 2;
                counts[run(&m, method, -1, 0, 0, 1, 1e-4)]++;
                gyro_init(&m);
            }
            for (int place = 0; place < GYRO_N_INPUTS; place++) {
                if (gyro_set_input(&m, place, number) != !!isfinite(number))
                    return 3;
                counts[run(&m, method, -1, 0, 0, 1, 1e-4)]++;
                gyro_init(&m);
            }
            for (int i = 0; i < GYRO_N_STATE; i++)
                y[i] = number;
            gyro_to_joints(&m, number, y, x);
            gyro_energy(&m, number, y, x);
            gyro_joint_accelerations(&m, number, x, y);
            gyro_to_maximal(&m, number, x, y);
        }
        for (int n = 0; n < (int)(sizeof tolerances / sizeof *tolerances); n++)
            counts[run(&m, method, -1, 0, 0, 1, tolerances[n])]++;
        /* A solver that has not stepped, and one whose control is nonsense. */
        gyro_solver_init(&solver, (gyro_method)method, 0, x);
        counts[gyro_solver_interpolate(&solver, &m, (gyro_real)-1, x)]++;
        for (int n = 0; n < (int)(sizeof numbers / sizeof *numbers); n++) {
            gyro_control control = gyro_default_control(1e-4);
            control.first_step = control.smallest_step = control.largest_step = numbers[n];
            control.budget = (uint64_t)n;
            control.correct_every = (uint32_t)n;
            gyro_joint_start(&m, x);
            gyro_solver_init(&solver, (gyro_method)method, 0, x);
            gyro_solver_set_control(&solver, &control);
            counts[gyro_solver_advance_to(&solver, &m, 1)]++;
        }
    }
    for (int status = 0; status < 12; status++)
        printf("%u %s\n", counts[status], gyro_status_text((gyro_status)status));
    return 0;
}
