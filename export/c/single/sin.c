static float gyro_sinf(float x)
{
    const float size = x < 0.0f ? -x : x;
    sine_reduced r;
    float value;
    if (!(size <= 1e4f)) {
        return libm_sinf(x);
    }
    if (!(size > (float)0.785)) {
        return sine_near_zero(x, 0.0f);
    }
    r = sine_reduce(x);
    value = sine_is_odd(r.quadrant) ? cosine_near_zero(r.left, r.rest) : sine_near_zero(r.left, r.rest);
    return r.quadrant > 1.5f || r.quadrant < -0.5f ? -value : value;
}
