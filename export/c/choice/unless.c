static inline double gyro_unless(double condition, double x)
{
    return condition <= 0.0 ? x : condition > 0.0 ? 0.0 : condition;
}
