/* Reads numbers and writes numbers, as their bytes: what exported functions make of them. For the mechanism `gyro`. */
#include "gyro.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static gyro_real number(void)
{
    gyro_real x = 0;
    if (fread(&x, sizeof x, 1, stdin) != 1)
        exit(3);
    return x;
}

static void numbers(gyro_real *x, int n)
{
    for (int i = 0; i < n; i++)
        x[i] = number();
}

static void tell(const gyro_real *x, int n)
{
    fwrite(x, sizeof *x, (size_t)n, stdout);
}

static void count(uint64_t n)
{
    const gyro_real x = (gyro_real)n;
    tell(&x, 1);
}

/* Functions of random states. */
static void kernels(const gyro *m)
{
    static gyro_real y[GYRO_N_STATE], x[GYRO_N_JOINTS], rates[GYRO_N_RATES + 1], out[GYRO_N_STATE + GYRO_N_JOINTS + 2];
    static gyro_real big[4096];
    int n = (int)number();
    while (n-- > 0) {
        const gyro_real t = number();
        numbers(y, GYRO_N_STATE);
        numbers(x, GYRO_N_JOINTS);
        gyro_joint_accelerations(m, t, x, rates);
        tell(rates, GYRO_N_RATES);
        gyro_joint_derivative(m, t, x, out);
        tell(out, GYRO_N_JOINTS);
        gyro_to_maximal(m, t, x, out);
        tell(out, GYRO_N_STATE);
        memset(out, 0, sizeof out);
        gyro_to_joints(m, t, y, out);
        tell(out, GYRO_N_JOINTS);
        gyro_energy(m, t, y, out);
        tell(out, 2);
        gyro_outputs(m, t, y, big);
        tell(big, GYRO_N_OUTPUTS);
        gyro_phi(m, t, y, big);
        tell(big, GYRO_N_CONSTRAINTS);
        gyro_velocity_residual(m, t, y, big);
        tell(big, GYRO_N_ROWS);
        gyro_read_joints(m, t, y, big);
        tell(big, GYRO_N_READINGS);
        gyro_derivative(m, t, y, out);
        tell(out, GYRO_N_STATE);
        gyro_corrected_derivative(m, t, y, out);
        tell(out, GYRO_N_STATE);
    }
}

static void run(const gyro *m, gyro_method method)
{
    static gyro_solver solver;
    static gyro_real x[GYRO_N_JOINTS];
    const double tolerance = (double)number();
    const gyro_real end = number();
    const int n_steps = (int)number(), n_samples = (int)number();
    int sample = 0;
    gyro_control control = gyro_default_control(tolerance);
    gyro_status status = GYRO_OK;
    gyro_joint_start(m, x);
    gyro_solver_init(&solver, method, 0, x);
    gyro_solver_set_control(&solver, &control);
    while (status == GYRO_OK && sample < n_samples) {
        const gyro_real at = end * (gyro_real)(sample + 1) / (gyro_real)n_samples;
        if (solver.t >= at) {
            status = gyro_solver_interpolate(&solver, m, at, x);
            tell(x, GYRO_N_JOINTS);
            sample++;
        } else if (n_steps > 0) {
            status = gyro_solver_step(&solver, m, end / (gyro_real)n_steps);
        } else {
            status = gyro_solver_step_towards(&solver, m, end);
        }
    }
    count((uint64_t)status);
    tell(solver.y, GYRO_N_JOINTS);
    count(solver.statistics.accepted);
    count(solver.statistics.rejected);
    count(solver.statistics.evaluations);
    count(solver.statistics.leaps);
}

int main(int argc, char **argv)
{
    static gyro m;
    gyro_init(&m);
    for (int i = 0; i < GYRO_N_PARAMETERS; i++)
        gyro_set_parameter(&m, i, number());
    for (int i = 0; i < GYRO_N_INPUTS; i++)
        gyro_set_input(&m, i, number());
    if (argc < 2)
        return 2;
    if (strcmp(argv[1], "kernels") == 0)
        kernels(&m);
    else
        run(&m, (gyro_method)atoi(argv[1]));
    return 0;
}
