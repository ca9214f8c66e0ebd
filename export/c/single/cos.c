static float gyro_cosf(float x)
{
    const float size = x < 0.0f ? -x : x;
    sine_reduced r;
    float value;
    if (!(size <= 1e4f)) {
        return libm_cosf(x);
    }
    if (!(size > (float)0.785)) {
        return cosine_near_zero(x, 0.0f);
    }
    r = sine_reduce(x);
    value = sine_is_odd(r.quadrant) ? sine_near_zero(r.left, r.rest) : cosine_near_zero(r.left, r.rest);
    return r.quadrant > 0.5f || r.quadrant < -1.5f ? -value : value;
}
