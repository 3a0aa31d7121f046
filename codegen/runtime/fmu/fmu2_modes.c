/* FMI 2.0: what belongs to model exchange or to co-simulation alone, the saved states, and what is
 * not supported. */
#include <string.h>

#include "fmi2Functions.h"
#include "fmu2.h"

fmi2Status fmi2EnterEventMode(fmi2Component c)
{
    return fmu2_tell(c, fmu_enter(CORE(c), FMU_EVENT));
}

fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *info)
{
    int moved = 0;
    const fmu_error failed = fmu_update(CORE(c), &moved);
    memset(info, 0, sizeof *info);
    info->valuesOfContinuousStatesChanged = moved;
    info->nextEventTimeDefined = fmu_next_event(CORE(c), &info->nextEventTime);
    return fmu2_tell(c, failed);
}

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c)
{
    return fmu2_tell(c, fmu_enter(CORE(c), FMU_CONTINUOUS));
}

fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean kept, fmi2Boolean *event,
                                       fmi2Boolean *end)
{
    (void)kept;
    *event = *end = fmi2False;
    return fmu2_tell(c, fmu_completed_step(CORE(c)));
}

fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time)
{
    fmu_set_time(CORE(c), time);
    return fmi2OK;
}

fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t nx)
{
    return fmu2_tell(c, fmu_set_states(CORE(c), x, nx));
}

fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real derivatives[], size_t nx)
{
    return fmu2_tell(c, fmu_get_rates(CORE(c), derivatives, nx));
}

fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real indicators[], size_t ni)
{
    return fmu2_tell(c, fmu_get_indicators(CORE(c), indicators, ni));
}

fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t nx)
{
    return fmu2_tell(c, fmu_get_states(CORE(c), x, nx));
}

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real nominals[], size_t nx)
{
    (void)c;
    fmu_get_nominals(nominals, nx);
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
    (void)kept;
    fmu2 *const f = c;
    const fmi2Status status = fmu2_tell(c, fmu_step(CORE(c), time, step));
    const char *const told = status == fmi2OK ? fmu_warning(&f->core) : NULL;
    if (told && f->call.logger)
        f->call.logger(f->call.componentEnvironment, f->name, fmi2Warning, "logStatusWarning", "%s",
                       told);
    return status;
}

static void room2(const fmu2 *f, fmi2FMUstate *state)
{
    if (!*state)
        *state = f->call.allocateMemory(1, sizeof(fmu_saved));
}

static fmi2Status save2(fmu2 *f, const void *from, size_t size, fmi2FMUstate *state)
{
    if (size == sizeof(fmu_saved))
        room2(f, state);
    return fmu2_tell(f, fmu_copy(*state, from, size));
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    room2(c, state);
    return fmu2_tell(c, fmu_save(CORE(c), *state));
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state)
{
    fmu_load(CORE(c), state);
    return fmi2OK;
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    if (state && *state) {
        ((fmu2 *)c)->call.freeMemory(*state);
        *state = NULL;
    }
    return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size)
{
    (void)c, (void)state;
    *size = sizeof(fmu_saved);
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size)
{
    return fmu2_tell(c, fmu_copy(bytes, state, size));
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size,
                                   fmi2FMUstate *state)
{
    return save2(c, bytes, size, state);
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
    *value = CORE(c)->at.time;
    return fmi2OK;
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value)
{
    if (kind != fmi2Terminated)
        return fmu2_tell(c, "fmi2GetBooleanStatus: only whether it terminated is known");
    *value = CORE(c)->at.phase == FMU_ENDED;
    return fmi2OK;
}
