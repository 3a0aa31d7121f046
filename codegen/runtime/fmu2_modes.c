/* FMI 2.0: what belongs to model exchange or to co-simulation alone, and what is not supported. */
#include <string.h>

#include "fmi2Functions.h"
#include "fmu2.h"

fmi2Status fmi2EnterEventMode(fmi2Component c)
{
    ((fmu2 *)c)->core.at.phase = FMU_EVENT;
    return fmi2OK;
}

fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *info)
{
    fmu2 *const f = c;
    int moved = 0;
    const fmu_error failed = fmu_event(&f->core, &moved);
    memset(info, 0, sizeof *info);
    info->valuesOfContinuousStatesChanged = moved;
    info->nextEventTimeDefined = fmu_next_break(&f->core, &info->nextEventTime);
    return fmu2_tell(f, failed);
}

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c)
{
    ((fmu2 *)c)->core.at.phase = FMU_CONTINUOUS;
    return fmi2OK;
}

fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean kept, fmi2Boolean *event,
                                       fmi2Boolean *end)
{
    (void)c, (void)kept;
    *event = *end = fmi2False;
    return fmi2OK;
}

fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time)
{
    fmu_set_time(&((fmu2 *)c)->core, time);
    return fmi2OK;
}

fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t nx)
{
    fmu2 *const f = c;
    return fmu2_tell(f, nx == FMU_STATES ? fmu_set_states(&f->core, x) : "wrong number of states");
}

fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real derivatives[], size_t nx)
{
    fmu2 *const f = c;
    const fmu_error failed = nx == FMU_STATES ? fmu_refresh(&f->core) : "wrong number of states";
    if (!failed)
        memcpy(derivatives, f->core.shot.rate, sizeof(double) * nx);
    return fmu2_tell(f, failed);
}

fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real indicators[], size_t ni)
{
    fmu2 *const f = c;
    return fmu2_tell(f, ni == FMU_INDICATORS ? fmu_indicators(&f->core, indicators)
                                             : "wrong number of event indicators");
}

fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t nx)
{
    fmu2 *const f = c;
    const fmu_error failed = nx == FMU_STATES ? fmu_refresh(&f->core) : "wrong number of states";
    if (!failed)
        memcpy(x, f->core.at.s, sizeof(double) * nx);
    return fmu2_tell(f, failed);
}

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real nominals[], size_t nx)
{
    (void)c;
    for (size_t i = 0; i < nx; i++)
        nominals[i] = 1.0;
    return fmi2OK;
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                       const fmi2Integer order[], const fmi2Real value[])
{
    fmu2 *const f = c;
    for (size_t i = 0; i < nvr; i++) {
        if (vr[i] >= FMU_VARIABLES || fmu_variables[vr[i]].kind != FMU_INPUT || order[i] != 1)
            return fmu2_tell(f, "only the first derivatives of inputs can be set");
        f->core.at.slopes[fmu_variables[vr[i]].index] = value[i];
        f->core.stale = 1;
    }
    return fmi2OK;
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real step, fmi2Boolean kept)
{
    fmu2 *const f = c;
    (void)kept;
    if (f->core.at.phase != FMU_STEPPING)
        return fmu2_tell(f, "fmi2DoStep: not initialized for co-simulation");
    return fmu2_tell(f, fmu_advance(&f->core, time, step));
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size)
{
    (void)c, (void)state;
    *size = sizeof(fmu_memory);
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size)
{
    if (size != sizeof(fmu_memory))
        return fmu2_tell(c, "fmi2SerializeFMUstate: wrong size");
    memcpy(bytes, state, size);
    return fmi2OK;
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size,
                                   fmi2FMUstate *state)
{
    fmu2 *const f = c;
    if (size != sizeof(fmu_memory))
        return fmu2_tell(f, "fmi2DeSerializeFMUstate: wrong size");
    if (!*state)
        *state = f->call.allocateMemory(1, size);
    if (!*state)
        return fmu2_tell(f, "fmi2DeSerializeFMUstate: no memory");
    memcpy(*state, bytes, size);
    return fmi2OK;
}

#define REFUSED(name, rest, count)                                          \
    fmi2Status name rest                                                    \
    {                                                                       \
        return (count) == 0 ? fmi2OK : fmu2_tell(c, #name ": not supported"); \
    }

#define VR fmi2Component c, const fmi2ValueReference vr[], size_t nvr
REFUSED(fmi2GetBoolean, (VR, fmi2Boolean v[]), ((void)vr, (void)v, nvr))
REFUSED(fmi2GetString, (VR, fmi2String v[]), ((void)vr, (void)v, nvr))
REFUSED(fmi2SetInteger, (VR, const fmi2Integer v[]), ((void)vr, (void)v, nvr))
REFUSED(fmi2SetBoolean, (VR, const fmi2Boolean v[]), ((void)vr, (void)v, nvr))
REFUSED(fmi2SetString, (VR, const fmi2String v[]), ((void)vr, (void)v, nvr))
REFUSED(fmi2GetRealOutputDerivatives, (VR, const fmi2Integer o[], fmi2Real v[]),
        ((void)vr, (void)o, (void)v, nvr))
REFUSED(fmi2CancelStep, (fmi2Component c), 1)
#define KIND fmi2Component c, const fmi2StatusKind k
REFUSED(fmi2GetStatus, (KIND, fmi2Status *v), ((void)k, (void)v, 1))
REFUSED(fmi2GetIntegerStatus, (KIND, fmi2Integer *v), ((void)k, (void)v, 1))
REFUSED(fmi2GetStringStatus, (KIND, fmi2String *v), ((void)k, (void)v, 1))

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value)
{
    if (kind != fmi2LastSuccessfulTime)
        return fmu2_tell(c, "fmi2GetRealStatus: only the last successful time is known");
    *value = ((fmu2 *)c)->core.at.time;
    return fmi2OK;
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value)
{
    if (kind != fmi2Terminated)
        return fmu2_tell(c, "fmi2GetBooleanStatus: only whether it terminated is known");
    *value = ((fmu2 *)c)->core.at.phase == FMU_ENDED;
    return fmi2OK;
}
