static inline float gyro_whenf(float condition, float x)
{
    return condition > 0.0f ? x : condition <= 0.0f ? 0.0f : condition;
}
