
EXPORT("solver_control") void gyro_wasm_control(gyro_solver *s, double relative, double absolute, double first_step,
    double smallest_step, double largest_step, double budget, uint32_t correct_every)
{
    gyro_control control = gyro_default_control(relative);
    control.absolute = absolute;
    control.first_step = first_step;
    control.smallest_step = smallest_step;
    control.largest_step = largest_step;
    control.budget = (uint64_t)budget;
    control.correct_every = correct_every;
    gyro_solver_set_control(s, &control);
}

EXPORT("solver_statistic") double gyro_wasm_statistic(const gyro_solver *s, int which)
{
    const gyro_statistics *of = &s->statistics;
    const double all[] = {(double)of->accepted, (double)of->rejected, (double)of->corrections, (double)of->evaluations,
        (double)of->jacobians, (double)of->limited_by_stability, (double)of->leaps, of->fastest_rate, of->shortest_step,
        of->longest_step};
    return which >= 0 && which < (int)(sizeof all / sizeof *all) ? all[which] : 0.0;
}

/* Of the last failure: its time, number and limit. */
EXPORT("solver_failure") double gyro_wasm_failure(const gyro_solver *s, int which)
{
    return which == 0 ? s->error.t : which == 1 ? s->error.value : s->error.limit;
}

EXPORT("solver_index") int gyro_wasm_index(const gyro_solver *s)
{
    return s->error.index;
}

EXPORT("solver_owner") const char *gyro_wasm_owner(const gyro_solver *s)
{
    return s->error.owner;
}
