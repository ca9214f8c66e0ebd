static inline float gyro_unlessf(float condition, float x)
{
    return condition <= 0.0f ? x : condition > 0.0f ? 0.0f : condition;
}
