/* --- The whole state ---------------------------------------------------------------------------------------------- */

fmi3Status fmi3GetFMUState(fmi3Instance handle, fmi3FMUState *FMUState)
{
    REQUIRE(~0);
    if (!FMUState)
        return refuse(c, "there is no place for the state");
    if (!*FMUState && !(*FMUState = malloc(sizeof(condition))))
        return refuse(c, "there is no memory left");
    memcpy(*FMUState, &c->now, sizeof(condition));
    return fmi3OK;
}

fmi3Status fmi3SetFMUState(fmi3Instance handle, fmi3FMUState FMUState)
{
    REQUIRE(~0);
    if (!FMUState)
        return refuse(c, "there is no state to go back to");
    memcpy(&c->now, FMUState, sizeof(condition));
    return fmi3OK;
}

fmi3Status fmi3FreeFMUState(fmi3Instance handle, fmi3FMUState *FMUState)
{
    (void)handle;
    if (FMUState) {
        free(*FMUState);
        *FMUState = NULL;
    }
    return fmi3OK;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance handle, fmi3FMUState FMUState, size_t *size)
{
    REQUIRE(~0);
    (void)FMUState;
    *size = sizeof(condition);
    return fmi3OK;
}

fmi3Status fmi3SerializeFMUState(
    fmi3Instance handle, fmi3FMUState FMUState, fmi3Byte serializedState[], size_t size)
{
    REQUIRE(~0);
    if (!FMUState || size < sizeof(condition))
        return refuse(c, "the state does not fit");
    memcpy(serializedState, FMUState, sizeof(condition));
    return fmi3OK;
}

fmi3Status fmi3DeserializeFMUState(
    fmi3Instance handle, const fmi3Byte serializedState[], size_t size, fmi3FMUState *FMUState)
{
    REQUIRE(~0);
    if (size != sizeof(condition))
        return refuse(c, "this is no state of this FMU");
    if (!*FMUState && !(*FMUState = malloc(sizeof(condition))))
        return refuse(c, "there is no memory left");
    memcpy(*FMUState, serializedState, sizeof(condition));
    /* Names of joints are addresses, which another process has elsewhere. */
    ((condition *)*FMUState)->solver.error.owner = NULL;
    return fmi3OK;
}

