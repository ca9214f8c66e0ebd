// Runs a contender over all states, and times that.
#define _POSIX_C_SOURCE 200809L
#include <time.h>

// self, q, v, tau, accelerations
typedef void run(void *, const double *, const double *, const double *, double *);

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// Seconds of so many repetitions over n states; `selfs` has one object for each state.
double clock_run(run *f, void **selfs, int n, int n_q, int n_v, const double *q, const double *v, const double *tau,
                 double *out, int repetitions) {
    const double start = now();
    for (int r = 0; r < repetitions; r++)
        for (int k = 0; k < n; k++) f(selfs[k], q + k * n_q, v + k * n_v, tau + k * n_v, out + k * n_v);
    return now() - start;
}
