/* --- Variables ---------------------------------------------------------------------------------------------------- */

fmi3Status fmi3GetFloat64(fmi3Instance handle, const fmi3ValueReference valueReferences[], size_t nValueReferences,
    fmi3Float64 values[], size_t nValues)
{
    size_t i;
    REQUIRE(~0);
    if (nValues != nValueReferences)
        return refuse(c, "every variable has one value");
    for (i = 0; i < nValueReferences; i++) {
        const uint32_t v = valueReferences[i];
        fmi3Status status = fmi3OK;
        if (v == 0)
            values[i] = c->now.t;
        else if (v < FIRST_DERIVATIVE)
            values[i] = c->now.x[v - FIRST_STATE];
        else if (v < FIRST_INPUT) {
            status = derive(c);
            values[i] = c->now.dx[v - FIRST_DERIVATIVE];
        }
#if FMU_HAS_INPUTS
        else if (v < FIRST_PARAMETER)
            values[i] = c->now.m.inputs[v - FIRST_INPUT];
#endif
#if FMU_HAS_PARAMETERS
        else if (v < FIRST_OUTPUT)
            values[i] = c->now.m.parameters[v - FIRST_PARAMETER];
#endif
        else if (v < END) {
            status = observe(c);
            values[i] = c->now.outputs[v - FIRST_OUTPUT];
        } else
            return refuse(c, "there is no variable of this value reference");
        if (status != fmi3OK)
            return status;
    }
    return fmi3OK;
}

static fmi3Status set_one(instance *c, uint32_t v, double value)
{
    condition *const now = &c->now;
    if (!isfinite(value))
        return refuse(c, "a variable cannot be set to what is not finite");
    if (v >= FIRST_STATE && v < FIRST_DERIVATIVE) {
        if (now->phase == CONTINUOUS || now->phase == TERMINATED)
            return refuse(c, "states are set here by fmi3SetContinuousStates");
        now->x[v - FIRST_STATE] = value;
        now->is_moved = now->is_closing_due = 1;
    } else if (v >= FIRST_INPUT && v < FIRST_PARAMETER) {
        gyro_set_input(&now->m, (int)(v - FIRST_INPUT), value);
        gyro_solver_changed(&now->solver);
    } else if (v >= FIRST_PARAMETER && v < FIRST_OUTPUT) {
        if (now->phase == CONTINUOUS || now->phase == TERMINATED)
            return refuse(c, "parameters are set before the run and at events");
        gyro_set_parameter(&now->m, (int)(v - FIRST_PARAMETER), value);
        now->is_moved = now->is_closing_due = 1;
    } else
        return refuse(c, "this variable cannot be set");
    forget(now);
    return fmi3OK;
}

fmi3Status fmi3SetFloat64(fmi3Instance handle, const fmi3ValueReference valueReferences[], size_t nValueReferences,
    const fmi3Float64 values[], size_t nValues)
{
    size_t i;
    REQUIRE(INSTANTIATED | INITIALIZATION | RUNS);
    if (nValues != nValueReferences)
        return refuse(c, "every variable has one value");
    for (i = 0; i < nValueReferences; i++) {
        const fmi3Status status = set_one(c, valueReferences[i], values[i]);
        if (status != fmi3OK)
            return status;
    }
    return fmi3OK;
}

/* There are no variables of other types: only an empty list of them can be asked for. */
#define OTHER_TYPE(name, type)                                                                                         \
    fmi3Status fmi3Get##name(fmi3Instance handle, const fmi3ValueReference valueReferences[], size_t nValueReferences, \
        type values[], size_t nValues)                                                                                 \
    {                                                                                                                  \
        REQUIRE(~0);                                                                                                   \
        (void)valueReferences;                                                                                         \
        (void)values;                                                                                                  \
        (void)nValues;                                                                                                 \
        return nValueReferences ? refuse(c, "all variables are of the type Float64") : fmi3OK;                         \
    }                                                                                                                  \
    fmi3Status fmi3Set##name(fmi3Instance handle, const fmi3ValueReference valueReferences[], size_t nValueReferences, \
        const type values[], size_t nValues)                                                                           \
    {                                                                                                                  \
        REQUIRE(~0);                                                                                                   \
        (void)valueReferences;                                                                                         \
        (void)values;                                                                                                  \
        (void)nValues;                                                                                                 \
        return nValueReferences ? refuse(c, "all variables are of the type Float64") : fmi3OK;                         \
    }

OTHER_TYPE(Float32, fmi3Float32)
OTHER_TYPE(Int8, fmi3Int8)
OTHER_TYPE(UInt8, fmi3UInt8)
OTHER_TYPE(Int16, fmi3Int16)
OTHER_TYPE(UInt16, fmi3UInt16)
OTHER_TYPE(Int32, fmi3Int32)
OTHER_TYPE(UInt32, fmi3UInt32)
OTHER_TYPE(Int64, fmi3Int64)
OTHER_TYPE(UInt64, fmi3UInt64)
OTHER_TYPE(Boolean, fmi3Boolean)
OTHER_TYPE(String, fmi3String)

fmi3Status fmi3GetBinary(fmi3Instance handle, const fmi3ValueReference valueReferences[], size_t nValueReferences,
    size_t valueSizes[], fmi3Binary values[], size_t nValues)
{
    REQUIRE(~0);
    (void)valueReferences;
    (void)valueSizes;
    (void)values;
    (void)nValues;
    return nValueReferences ? refuse(c, "all variables are of the type Float64") : fmi3OK;
}

fmi3Status fmi3SetBinary(fmi3Instance handle, const fmi3ValueReference valueReferences[], size_t nValueReferences,
    const size_t valueSizes[], const fmi3Binary values[], size_t nValues)
{
    REQUIRE(~0);
    (void)valueReferences;
    (void)valueSizes;
    (void)values;
    (void)nValues;
    return nValueReferences ? refuse(c, "all variables are of the type Float64") : fmi3OK;
}

fmi3Status fmi3GetClock(
    fmi3Instance handle, const fmi3ValueReference valueReferences[], size_t nValueReferences, fmi3Clock values[])
{
    REQUIRE(~0);
    (void)valueReferences;
    (void)values;
    return nValueReferences ? refuse(c, "there are no clocks") : fmi3OK;
}

fmi3Status fmi3SetClock(
    fmi3Instance handle, const fmi3ValueReference valueReferences[], size_t nValueReferences, const fmi3Clock values[])
{
    REQUIRE(~0);
    (void)valueReferences;
    (void)values;
    return nValueReferences ? refuse(c, "there are no clocks") : fmi3OK;
}

fmi3Status fmi3GetNumberOfVariableDependencies(
    fmi3Instance handle, fmi3ValueReference valueReference, size_t *nDependencies)
{
    (void)valueReference;
    (void)nDependencies;
    NOT_HERE();
}

fmi3Status fmi3GetVariableDependencies(fmi3Instance handle, fmi3ValueReference dependent,
    size_t elementIndicesOfDependent[], fmi3ValueReference independents[], size_t elementIndicesOfIndependents[],
    fmi3DependencyKind dependencyKinds[], size_t nDependencies)
{
    (void)dependent;
    (void)elementIndicesOfDependent;
    (void)independents;
    (void)elementIndicesOfIndependents;
    (void)dependencyKinds;
    (void)nDependencies;
    NOT_HERE();
}

