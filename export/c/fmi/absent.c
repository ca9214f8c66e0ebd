/* --- What mechanisms do not have ---------------------------------------------------------------------------------- */

fmi3Status fmi3EnterConfigurationMode(fmi3Instance handle)
{
    NOT_HERE();
}

fmi3Status fmi3ExitConfigurationMode(fmi3Instance handle)
{
    NOT_HERE();
}

fmi3Status fmi3GetIntervalDecimal(fmi3Instance handle, const fmi3ValueReference valueReferences[],
    size_t nValueReferences, fmi3Float64 intervals[], fmi3IntervalQualifier qualifiers[])
{
    (void)valueReferences, (void)nValueReferences, (void)intervals, (void)qualifiers;
    NOT_HERE();
}

fmi3Status fmi3GetIntervalFraction(fmi3Instance handle, const fmi3ValueReference valueReferences[],
    size_t nValueReferences, fmi3UInt64 counters[], fmi3UInt64 resolutions[], fmi3IntervalQualifier qualifiers[])
{
    (void)valueReferences, (void)nValueReferences, (void)counters, (void)resolutions, (void)qualifiers;
    NOT_HERE();
}

fmi3Status fmi3GetShiftDecimal(
    fmi3Instance handle, const fmi3ValueReference valueReferences[], size_t nValueReferences, fmi3Float64 shifts[])
{
    (void)valueReferences, (void)nValueReferences, (void)shifts;
    NOT_HERE();
}

fmi3Status fmi3GetShiftFraction(fmi3Instance handle, const fmi3ValueReference valueReferences[],
    size_t nValueReferences, fmi3UInt64 counters[], fmi3UInt64 resolutions[])
{
    (void)valueReferences, (void)nValueReferences, (void)counters, (void)resolutions;
    NOT_HERE();
}

fmi3Status fmi3SetIntervalDecimal(fmi3Instance handle, const fmi3ValueReference valueReferences[],
    size_t nValueReferences, const fmi3Float64 intervals[])
{
    (void)valueReferences, (void)nValueReferences, (void)intervals;
    NOT_HERE();
}

fmi3Status fmi3SetIntervalFraction(fmi3Instance handle, const fmi3ValueReference valueReferences[],
    size_t nValueReferences, const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
{
    (void)valueReferences, (void)nValueReferences, (void)counters, (void)resolutions;
    NOT_HERE();
}

fmi3Status fmi3SetShiftDecimal(fmi3Instance handle, const fmi3ValueReference valueReferences[],
    size_t nValueReferences, const fmi3Float64 shifts[])
{
    (void)valueReferences, (void)nValueReferences, (void)shifts;
    NOT_HERE();
}

fmi3Status fmi3SetShiftFraction(fmi3Instance handle, const fmi3ValueReference valueReferences[],
    size_t nValueReferences, const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
{
    (void)valueReferences, (void)nValueReferences, (void)counters, (void)resolutions;
    NOT_HERE();
}

fmi3Status fmi3ActivateModelPartition(
    fmi3Instance handle, fmi3ValueReference clockReference, fmi3Float64 activationTime)
{
    (void)clockReference, (void)activationTime;
    NOT_HERE();
}

