/* Sine and cosine in single precision throughout, at most one unit in the last place from the correctly rounded value
   up to 1e4 rad: gyro-sim's, operation for operation. */
typedef struct { float left, rest, quadrant; } sine_reduced;

static float sine_nearest(float x)
{
    return (x + 12582912.0f) - 12582912.0f;
}

static float sine_difference(float a, float b, float *rest)
{
    const float difference = a - b;
    const float taken = difference - a;
    *rest = (a - (difference - taken)) - (b + taken);
    return difference;
}

/* x less a multiple of pi/2, which is taken away in parts. */
static sine_reduced sine_reduce(float x)
{
    sine_reduced r;
    float first, second;
    const float n = sine_nearest(x * (float)0.63661977236758134308);
    const float most = (x - n * 1.5703125f) - n * (float)4.837512969970703e-4;
    const float next = sine_difference(most, n * (float)7.549533620476723e-8, &first);
    r.left = sine_difference(next, n * (float)2.5632829192545614e-12, &second);
    r.rest = (first + second) - n * (float)6.123234262925839e-17;
    r.quadrant = n - sine_nearest(n * 0.25f) * 4.0f;
    return r;
}

static float sine_near_zero(float x, float rest)
{
    const float z = x * x;
    const float series =
        (float)-0.16666655242443085 + z * ((float)0.008332188241183758 + z * (float)-1.951809972524643e-4);
    return x + (x * z * series + rest * (1.0f - 0.5f * z));
}

static float cosine_near_zero(float x, float rest)
{
    const float z = x * x;
    const float series =
        (float)0.04166664555668831 + z * ((float)-0.0013887310633435845 + z * (float)2.4432552891084924e-5);
    const float half = 0.5f * z;
    const float most = 1.0f - half;
    return most + (((1.0f - most) - half) + (z * z * series - x * rest));
}

static int sine_is_odd(float quadrant)
{
    const float size = quadrant < 0.0f ? -quadrant : quadrant;
    return size > 0.5f && size < 1.5f;
}
