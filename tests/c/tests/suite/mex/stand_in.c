/* Calls a MEX file as MATLAB would: as docs/julia-and-matlab.md does, and as nobody should. */
#include "mex.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static jmp_buf caller;
static char message[256];

bool mxIsDouble(const mxArray *array)
{
    return array->is_double;
}

size_t mxGetNumberOfElements(const mxArray *array)
{
    return array->rows * array->columns;
}

double *mxGetPr(const mxArray *array)
{
    return array->numbers;
}

mxArray *mxCreateDoubleMatrix(size_t rows, size_t columns, mxComplexity complexity)
{
    static mxArray array;
    static double numbers[64];
    (void)complexity;
    if (rows * columns > 64)
        abort();
    memset(numbers, 0, sizeof numbers);
    array = (mxArray){rows, columns, numbers, true};
    return &array;
}

void mexErrMsgIdAndTxt(const char *identifier, const char *format, ...)
{
    va_list values;
    int n = snprintf(message, sizeof message, "%s: ", identifier);
    va_start(values, format);
    vsnprintf(message + n, sizeof message - (size_t)n, format, values);
    va_end(values);
    longjmp(caller, 1);
}

/* Whether a call is refused in these words. */
static int is_refused(const char *words, int n_given, const mxArray *times, const mxArray *parameters)
{
    mxArray *results[1] = {NULL};
    const mxArray *given[2] = {times, parameters};
    if (setjmp(caller) == 0) {
        mexFunction(1, results, n_given, given);
        strcpy(message, "not refused");
    }
    if (strstr(message, words))
        return 1;
    printf("%s, not %s\n", message, words);
    return 0;
}

int main(void)
{
    double at[5], past[2] = {0.2, 0.1}, length[2] = {0.4, 0.4}, nan = NAN, infinite = INFINITY;
    const mxArray times = {1, 5, at, true}, parameters = {1, 1, length, true}, backwards = {1, 2, past, true};
    const mxArray two = {1, 2, length, true}, single = {1, 1, length, false}, none = {1, 1, &nan, true};
    const mxArray never = {1, 1, &infinite, true};
    mxArray *results[1];
    const mxArray *given[2] = {&times, &parameters};
    for (int k = 0; k < 5; k++)
        at[k] = 0.2 * (k + 1);
    if (!is_refused("pendulum:usage", 1, &times, &parameters) || !is_refused("pendulum:usage", 2, &times, &two)
        || !is_refused("pendulum:usage", 2, &times, &single) || !is_refused("pendulum:usage", 2, &single, &parameters)
        || !is_refused("parameter 1 cannot be nan", 2, &times, &none)
        || !is_refused("times begin at 0 s", 2, &none, &parameters)
        || !is_refused("unlike 0.1 s", 2, &backwards, &parameters)
        || !is_refused("pendulum:solver: a time is not finite", 2, &never, &parameters))
        return 1;
    if (setjmp(caller) != 0) {
        printf("%s\n", message);
        return 2;
    }
    mexFunction(1, results, 2, given);
    if (results[0]->rows != 2 || results[0]->columns != 5)
        return 3;
    for (int k = 0; k < 5; k++)
        printf("%.1f s: %+.6f rad, %+.6f rad/s\n", at[k], results[0]->numbers[2 * k], results[0]->numbers[2 * k + 1]);
    return 0;
}
