/* FMI 3.0: the functions of model exchange and co-simulation alike. */
#include <stdlib.h>
#include <string.h>

#include "fmi3Functions.h"
#include "fmu3.h"

static const fmu_error SCALARS = "all of these variables are scalars";

fmi3Status fmu3_tell(fmu3 *f, fmu_error failed)
{
    if (!failed)
        return fmi3OK;
    if (f->log)
        f->log(f->environment, fmi3Error, "logStatusError", failed);
    return fmi3Error;
}

const char *fmi3GetVersion(void)
{
    return fmi3Version;
}

fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t count,
                               const fmi3String categories[])
{
    (void)c, (void)on, (void)count, (void)categories;
    return fmi3OK;
}

static fmi3Instance make(fmi3String token, int exchange, fmi3InstanceEnvironment environment,
                         fmi3LogMessageCallback log)
{
    fmu3 *f;
    if (!token || strcmp(token, FMU_TOKEN) != 0)
        return NULL;
    f = calloc(1, sizeof *f);
    if (!f)
        return NULL;
    f->environment = environment;
    f->log = log;
    fmu_reset(&f->core, exchange);
    return f;
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources,
                                          fmi3Boolean visible, fmi3Boolean logging,
                                          fmi3InstanceEnvironment environment,
                                          fmi3LogMessageCallback log)
{
    (void)name, (void)resources, (void)visible, (void)logging;
    return make(token, 1, environment, log);
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources,
                                         fmi3Boolean visible, fmi3Boolean logging,
                                         fmi3Boolean events, fmi3Boolean early,
                                         const fmi3ValueReference intermediate[], size_t count,
                                         fmi3InstanceEnvironment environment,
                                         fmi3LogMessageCallback log,
                                         fmi3IntermediateUpdateCallback update)
{
    (void)name, (void)resources, (void)visible, (void)logging, (void)events, (void)early;
    (void)intermediate, (void)count, (void)update;
    return make(token, 0, environment, log);
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token,
                                               fmi3String resources, fmi3Boolean visible,
                                               fmi3Boolean logging,
                                               fmi3InstanceEnvironment environment,
                                               fmi3LogMessageCallback log,
                                               fmi3ClockUpdateCallback update,
                                               fmi3LockPreemptionCallback lock,
                                               fmi3UnlockPreemptionCallback unlock)
{
    (void)name, (void)token, (void)resources, (void)visible, (void)logging, (void)environment;
    (void)log, (void)update, (void)lock, (void)unlock;
    return NULL;
}

void fmi3FreeInstance(fmi3Instance c)
{
    free(c);
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean limited, fmi3Float64 tolerance,
                                       fmi3Float64 start, fmi3Boolean ends, fmi3Float64 stop)
{
    (void)ends, (void)stop;
    CORE(c)->at.tolerance = limited ? tolerance : 0.0;
    return fmu3_tell(c, fmu_begin(CORE(c), start));
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance c)
{
    fmu3 *const f = c;
    const fmi3Status status = fmu3_tell(f, fmu_finish(&f->core));
    const char *const told = status == fmi3OK ? fmu_completed(&f->core) : NULL;
    if (told && f->log)
        f->log(f->environment, fmi3Warning, "logStatusWarning", told);
    return status;
}

fmi3Status fmi3Terminate(fmi3Instance c)
{
    fmu_end(CORE(c));
    return fmi3OK;
}

fmi3Status fmi3Reset(fmi3Instance c)
{
    fmu_reset(CORE(c), CORE(c)->at.exchange);
    return fmi3OK;
}

fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr,
                          fmi3Float64 values[], size_t count)
{
    return fmu3_tell(c, fmu_get_all(CORE(c), vr, nvr, values, count));
}

fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr,
                          const fmi3Float64 values[], size_t count)
{
    return fmu3_tell(c, fmu_set_all(CORE(c), vr, nvr, values, count));
}

/* The only integers are friction modes and switches. */
fmi3Status fmi3GetInt32(fmi3Instance c, const fmi3ValueReference vr[], size_t nvr,
                        fmi3Int32 values[], size_t count)
{
    if (count != nvr)
        return fmu3_tell(c, SCALARS);
    return fmu3_tell(c, fmu_get_modes(CORE(c), vr, nvr, values));
}

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance c, const fmi3ValueReference unknowns[],
                                        size_t rows, const fmi3ValueReference knowns[],
                                        size_t columns, const fmi3Float64 seed[], size_t seeds,
                                        fmi3Float64 result[], size_t results)
{
    if (seeds != columns || results != rows)
        return fmu3_tell(c, SCALARS);
    return fmu3_tell(c, fmu_derive(CORE(c), unknowns, rows, knowns, columns, seed, result));
}
