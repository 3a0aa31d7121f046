/* FMI 3.0: what belongs to model exchange or to co-simulation alone, and the saved states. */
#include <stdlib.h>

#include "fmi3Functions.h"
#include "fmu3.h"

fmi3Status fmi3EnterEventMode(fmi3Instance c)
{
    return fmu3_tell(c, fmu_enter(CORE(c), FMU_EVENT));
}

fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance c)
{
    return fmu3_tell(c, fmu_refresh(CORE(c)));
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean *again, fmi3Boolean *end,
                                    fmi3Boolean *nominals, fmi3Boolean *values,
                                    fmi3Boolean *planned, fmi3Float64 *time)
{
    int moved = 0;
    const fmu_error failed = fmu_update(CORE(c), &moved);
    *again = *end = *nominals = fmi3False;
    *values = moved != 0;
    *planned = fmu_next_event(CORE(c), time) != 0;
    return fmu3_tell(c, failed);
}

fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance c)
{
    return fmu3_tell(c, fmu_enter(CORE(c), FMU_CONTINUOUS));
}

fmi3Status fmi3CompletedIntegratorStep(fmi3Instance c, fmi3Boolean kept, fmi3Boolean *event,
                                       fmi3Boolean *end)
{
    (void)kept;
    *event = *end = fmi3False;
    return fmu3_tell(c, fmu_completed_step(CORE(c)));
}

fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64 time)
{
    fmu_set_time(CORE(c), time);
    return fmi3OK;
}

fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64 x[], size_t nx)
{
    return fmu3_tell(c, fmu_set_states(CORE(c), x, nx));
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64 derivatives[], size_t nx)
{
    return fmu3_tell(c, fmu_get_rates(CORE(c), derivatives, nx));
}

fmi3Status fmi3GetEventIndicators(fmi3Instance c, fmi3Float64 indicators[], size_t ni)
{
    return fmu3_tell(c, fmu_get_indicators(CORE(c), indicators, ni));
}

fmi3Status fmi3GetContinuousStates(fmi3Instance c, fmi3Float64 x[], size_t nx)
{
    return fmu3_tell(c, fmu_get_states(CORE(c), x, nx));
}

fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance c, fmi3Float64 nominals[], size_t nx)
{
    (void)c;
    fmu_get_nominals(nominals, nx);
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance c, size_t *count)
{
    (void)c;
    *count = FMU_INDICATORS;
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance c, size_t *count)
{
    (void)c;
    *count = FMU_STATES;
    return fmi3OK;
}

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 time, fmi3Float64 step, fmi3Boolean kept,
                      fmi3Boolean *event, fmi3Boolean *end, fmi3Boolean *early, fmi3Float64 *last)
{
    const fmu_error failed = fmu_step(CORE(c), time, step);
    (void)kept;
    *event = *end = *early = fmi3False;
    *last = CORE(c)->at.time;
    fmu3 *const f = c;
    const char *const told = failed ? NULL : fmu_warning(&f->core);
    if (told && f->log)
        f->log(f->environment, fmi3Warning, "logStatusWarning", told);
    return fmu3_tell(c, failed);
}

static void room3(fmi3FMUState *state)
{
    if (!*state)
        *state = malloc(sizeof(fmu_saved));
}

static fmi3Status save3(fmu3 *f, const void *from, size_t size, fmi3FMUState *state)
{
    if (size == sizeof(fmu_saved))
        room3(state);
    return fmu3_tell(f, fmu_copy(*state, from, size));
}

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *state)
{
    room3(state);
    return fmu3_tell(c, fmu_save(CORE(c), *state));
}

fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state)
{
    fmu_load(CORE(c), state);
    return fmi3OK;
}

fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *state)
{
    (void)c;
    if (state) {
        free(*state);
        *state = NULL;
    }
    return fmi3OK;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState state, size_t *size)
{
    (void)c, (void)state;
    *size = sizeof(fmu_saved);
    return fmi3OK;
}

fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[], size_t size)
{
    return fmu3_tell(c, fmu_copy(bytes, state, size));
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte bytes[], size_t size,
                                   fmi3FMUState *state)
{
    return save3(c, bytes, size, state);
}
