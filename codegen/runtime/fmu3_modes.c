/* FMI 3.0: what belongs to model exchange or to co-simulation alone, and the saved states. */
#include <stdlib.h>
#include <string.h>

#include "fmi3Functions.h"
#include "fmu3.h"

fmi3Status fmi3EnterEventMode(fmi3Instance c)
{
    fmu3 *const f = c;
    if (!f->core.at.exchange)
        return fmu3_tell(f, "fmi3EnterEventMode: co-simulation has no event mode");
    f->core.at.phase = FMU_EVENT;
    return fmi3OK;
}

fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance c)
{
    fmu3 *const f = c;
    return fmu3_tell(f, fmu_refresh(&f->core));
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean *again, fmi3Boolean *end,
                                    fmi3Boolean *nominals, fmi3Boolean *values,
                                    fmi3Boolean *planned, fmi3Float64 *time)
{
    fmu3 *const f = c;
    int moved = 0;
    const fmu_error failed = fmu_event(&f->core, &moved);
    *again = *end = *nominals = fmi3False;
    *values = moved != 0;
    *planned = fmu_next_break(&f->core, time) != 0;
    return fmu3_tell(f, failed);
}

fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance c)
{
    ((fmu3 *)c)->core.at.phase = FMU_CONTINUOUS;
    return fmi3OK;
}

fmi3Status fmi3CompletedIntegratorStep(fmi3Instance c, fmi3Boolean kept, fmi3Boolean *event,
                                       fmi3Boolean *end)
{
    (void)c, (void)kept;
    *event = *end = fmi3False;
    return fmi3OK;
}

fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64 time)
{
    fmu_set_time(&((fmu3 *)c)->core, time);
    return fmi3OK;
}

fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64 x[], size_t nx)
{
    fmu3 *const f = c;
    return fmu3_tell(f, nx == FMU_STATES ? fmu_set_states(&f->core, x) : "wrong number of states");
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64 derivatives[], size_t nx)
{
    fmu3 *const f = c;
    const fmu_error failed = nx == FMU_STATES ? fmu_refresh(&f->core) : "wrong number of states";
    if (!failed)
        memcpy(derivatives, f->core.shot.rate, sizeof(double) * nx);
    return fmu3_tell(f, failed);
}

fmi3Status fmi3GetEventIndicators(fmi3Instance c, fmi3Float64 indicators[], size_t ni)
{
    fmu3 *const f = c;
    return fmu3_tell(f, ni == FMU_INDICATORS ? fmu_indicators(&f->core, indicators)
                                             : "wrong number of event indicators");
}

fmi3Status fmi3GetContinuousStates(fmi3Instance c, fmi3Float64 x[], size_t nx)
{
    fmu3 *const f = c;
    const fmu_error failed = nx == FMU_STATES ? fmu_refresh(&f->core) : "wrong number of states";
    if (!failed)
        memcpy(x, f->core.at.s, sizeof(double) * nx);
    return fmu3_tell(f, failed);
}

fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance c, fmi3Float64 nominals[], size_t nx)
{
    (void)c;
    for (size_t i = 0; i < nx; i++)
        nominals[i] = 1.0;
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
    fmu3 *const f = c;
    fmu_error failed;
    (void)kept;
    *event = *end = *early = fmi3False;
    failed = f->core.at.phase == FMU_STEPPING ? fmu_advance(&f->core, time, step)
                                              : "fmi3DoStep: not initialized for co-simulation";
    *last = f->core.at.time;
    return fmu3_tell(f, failed);
}

static fmi3Status save(fmu3 *f, const void *from, fmi3FMUState *state)
{
    if (!*state)
        *state = malloc(sizeof(fmu_memory));
    if (!*state)
        return fmu3_tell(f, "no memory for the state");
    memcpy(*state, from, sizeof(fmu_memory));
    return fmi3OK;
}

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *state)
{
    return save(c, &((fmu3 *)c)->core.at, state);
}

fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state)
{
    fmu_restore(&((fmu3 *)c)->core, state);
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
    *size = sizeof(fmu_memory);
    return fmi3OK;
}

fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[], size_t size)
{
    if (size != sizeof(fmu_memory))
        return fmu3_tell(c, "fmi3SerializeFMUState: wrong size");
    memcpy(bytes, state, size);
    return fmi3OK;
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte bytes[], size_t size,
                                   fmi3FMUState *state)
{
    if (size != sizeof(fmu_memory))
        return fmu3_tell(c, "fmi3DeserializeFMUState: wrong size");
    return save(c, bytes, state);
}
