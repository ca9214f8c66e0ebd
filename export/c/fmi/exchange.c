/* --- Model exchange ----------------------------------------------------------------------------------------------- */

fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance handle)
{
    REQUIRE(INITIALIZATION | EVENT);
    return fmi3OK;
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance handle, fmi3Boolean *discreteStatesNeedUpdate,
    fmi3Boolean *terminateSimulation, fmi3Boolean *nominalsOfContinuousStatesChanged,
    fmi3Boolean *valuesOfContinuousStatesChanged, fmi3Boolean *nextEventTimeDefined, fmi3Float64 *nextEventTime)
{
    REQUIRE(EVENT | STEP);
    *discreteStatesNeedUpdate = *terminateSimulation = *nominalsOfContinuousStatesChanged = fmi3False;
    *nextEventTimeDefined = fmi3False;
    *nextEventTime = 0.0;
    *valuesOfContinuousStatesChanged = c->now.is_closing_due ? fmi3True : fmi3False;
    return c->now.is_closing_due ? close_loops(c) : fmi3OK;
}

fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance handle)
{
    REQUIRE(EVENT);
    if (!c->is_exchange)
        return refuse(c, "co-simulation has no continuous-time mode");
    c->now.phase = CONTINUOUS;
    return fmi3OK;
}

/* How far the loops of a state are open, in units of what the tolerance admits. */
static double drift(const condition *now)
{
#if FMU_HAS_LOOPS
    double open[GYRO_N_CLOSURE], most = 0.0;
    int i;
    gyro_loop_closure(&now->m, now->t, now->x, open);
    for (i = 0; i < GYRO_N_CLOSURE; i++)
        most = fmax(most, fabs(open[i]));
    return most / now->tolerance;
#else
    (void)now;
    return 0.0;
#endif
}

/* An event is asked for where the loops have drifted open, at which they are closed. */
fmi3Status fmi3CompletedIntegratorStep(fmi3Instance handle, fmi3Boolean noSetFMUStatePriorToCurrentPoint,
    fmi3Boolean *enterEventMode, fmi3Boolean *terminateSimulation)
{
    REQUIRE(CONTINUOUS);
    (void)noSetFMUStatePriorToCurrentPoint;
    c->now.is_closing_due = drift(&c->now) > 1.0;
    *enterEventMode = c->now.is_closing_due ? fmi3True : fmi3False;
    *terminateSimulation = fmi3False;
    return fmi3OK;
}

fmi3Status fmi3SetTime(fmi3Instance handle, fmi3Float64 time)
{
    REQUIRE(EVENT | CONTINUOUS);
    if (!isfinite(time))
        return refuse(c, "the time is not finite");
    c->now.t = time;
    forget(&c->now);
    return fmi3OK;
}

fmi3Status fmi3SetContinuousStates(
    fmi3Instance handle, const fmi3Float64 continuousStates[], size_t nContinuousStates)
{
    REQUIRE(CONTINUOUS);
    if (nContinuousStates != N_STATES)
        return refuse(c, "the number of states is wrong");
    if (!are_finite(continuousStates, N_STATES))
        return report(c, fmi3Discard, "a state is not finite");
    memcpy(c->now.x, continuousStates, sizeof c->now.x);
    forget(&c->now);
    return fmi3OK;
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance handle, fmi3Float64 derivatives[], size_t nContinuousStates)
{
    fmi3Status status;
    REQUIRE(INITIALIZATION | RUNS | TERMINATED);
    if (nContinuousStates != N_STATES)
        return refuse(c, "the number of states is wrong");
    status = derive(c);
    memcpy(derivatives, c->now.dx, sizeof c->now.dx);
    return status;
}

fmi3Status fmi3GetEventIndicators(fmi3Instance handle, fmi3Float64 eventIndicators[], size_t nEventIndicators)
{
    REQUIRE(~0);
    (void)eventIndicators;
    return nEventIndicators ? refuse(c, "there are no event indicators") : fmi3OK;
}

fmi3Status fmi3GetContinuousStates(fmi3Instance handle, fmi3Float64 continuousStates[], size_t nContinuousStates)
{
    REQUIRE(INITIALIZATION | RUNS | TERMINATED);
    if (nContinuousStates != N_STATES)
        return refuse(c, "the number of states is wrong");
    memcpy(continuousStates, c->now.x, sizeof c->now.x);
    return fmi3OK;
}

fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance handle, fmi3Float64 nominals[], size_t nContinuousStates)
{
    size_t i;
    REQUIRE(INITIALIZATION | RUNS | TERMINATED);
    if (nContinuousStates != N_STATES)
        return refuse(c, "the number of states is wrong");
    for (i = 0; i < N_STATES; i++)
        nominals[i] = 1.0;
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance handle, size_t *nEventIndicators)
{
    REQUIRE(~0);
    *nEventIndicators = 0;
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance handle, size_t *nContinuousStates)
{
    REQUIRE(~0);
    *nContinuousStates = N_STATES;
    return fmi3OK;
}

