/* --- Co-simulation ------------------------------------------------------------------------------------------------ */

fmi3Status fmi3EnterStepMode(fmi3Instance handle)
{
    NOT_HERE();
}

fmi3Status fmi3GetOutputDerivatives(fmi3Instance handle, const fmi3ValueReference valueReferences[],
    size_t nValueReferences, const fmi3Int32 orders[], fmi3Float64 values[], size_t nValues)
{
    (void)valueReferences, (void)nValueReferences, (void)orders, (void)values, (void)nValues;
    NOT_HERE();
}

/* Inputs are held over a communication step. A step that fails leaves the instance at the time that it reached. */
fmi3Status fmi3DoStep(fmi3Instance handle, fmi3Float64 currentCommunicationPoint, fmi3Float64 communicationStepSize,
    fmi3Boolean noSetFMUStatePriorToCurrentPoint, fmi3Boolean *eventHandlingNeeded, fmi3Boolean *terminateSimulation,
    fmi3Boolean *earlyReturn, fmi3Float64 *lastSuccessfulTime)
{
    double t_end;
    gyro_status status = GYRO_OK;
    REQUIRE(STEP);
    (void)noSetFMUStatePriorToCurrentPoint;
    *eventHandlingNeeded = *terminateSimulation = *earlyReturn = fmi3False;
    *lastSuccessfulTime = c->now.t;
    if (c->is_exchange)
        return refuse(c, "model exchange has no steps");
    t_end = currentCommunicationPoint + communicationStepSize;
    if (!isfinite(t_end) || !(communicationStepSize > 0.0))
        return refuse(c, "a communication step must be positive and finite");
    if (fabs(currentCommunicationPoint - c->now.t) > 1e-9 * communicationStepSize + 1e-13 * fabs(c->now.t))
        return refuse(c, "the communication point is not where the last step has ended");
    if (c->now.is_closing_due && close_loops(c) != fmi3OK)
        return fmi3Error;
    if (c->now.is_moved)
        prepare_solver(&c->now);
    /* Rounding of the communication point must not add a tiny step. */
    if (t_end > c->now.solver.t)
        status = gyro_solver_advance_to(&c->now.solver, &c->now.m, t_end);
    memcpy(c->now.x, c->now.solver.y, sizeof c->now.x);
    *lastSuccessfulTime = c->now.t = c->now.solver.t;
    forget(&c->now);
    return status == GYRO_OK ? fmi3OK : refuse(c, gyro_status_text(status));
}
