/* As much of MATLAB's interface for C as docs/julia-and-matlab.md uses. */
#include <stdbool.h>
#include <stddef.h>

typedef struct {
    size_t rows, columns;
    double *numbers;
    bool is_double;
} mxArray;

typedef enum { mxREAL } mxComplexity;

bool mxIsDouble(const mxArray *array);
size_t mxGetNumberOfElements(const mxArray *array);
double *mxGetPr(const mxArray *array);
mxArray *mxCreateDoubleMatrix(size_t rows, size_t columns, mxComplexity complexity);
void mexErrMsgIdAndTxt(const char *identifier, const char *format, ...);
void mexFunction(int n_results, mxArray *results[], int n_given, const mxArray *given[]);
