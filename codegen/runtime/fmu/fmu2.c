/* FMI 2.0: the functions of model exchange and co-simulation alike. */
#include <string.h>

#include "fmi2Functions.h"
#include "fmu2.h"

fmi2Status fmu2_tell(fmu2 *f, fmu_error failed)
{
    if (!failed)
        return fmi2OK;
    if (f->call.logger)
        f->call.logger(f->call.componentEnvironment, f->name, fmi2Error, "logStatusError", "%s",
                       failed);
    return fmi2Error;
}

const char *fmi2GetTypesPlatform(void)
{
    return fmi2TypesPlatform;
}

const char *fmi2GetVersion(void)
{
    return fmi2Version;
}

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t count,
                               const fmi2String categories[])
{
    (void)c, (void)on, (void)count, (void)categories;
    return fmi2OK;
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible,
                              fmi2Boolean logging)
{
    fmu2 *f;
    (void)resources, (void)visible, (void)logging;
    if (!functions || !functions->allocateMemory || !functions->freeMemory || !guid
        || strcmp(guid, FMU_TOKEN) != 0)
        return NULL;
    f = functions->allocateMemory(1, sizeof *f);
    if (!f)
        return NULL;
    memset(f, 0, sizeof *f);
    f->call = *functions;
    f->name = functions->allocateMemory(name ? strlen(name) + 1 : 1, 1);
    if (!f->name) {
        functions->freeMemory(f);
        return NULL;
    }
    strcpy(f->name, name ? name : "");
    fmu_reset(&f->core, type == fmi2ModelExchange);
    return f;
}

void fmi2FreeInstance(fmi2Component c)
{
    fmu2 *const f = c;
    if (!f)
        return;
    f->call.freeMemory(f->name);
    f->call.freeMemory(f);
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean limited, fmi2Real tolerance,
                               fmi2Real start, fmi2Boolean ends, fmi2Real stop)
{
    fmu2 *const f = c;
    (void)ends, (void)stop;
    if (f->core.at.phase != FMU_MADE)
        return fmu2_tell(f, "an experiment is set up after instantiation");
    f->core.at.tolerance = limited ? tolerance : 0.0;
    fmu_set_time(&f->core, start);
    return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    return fmu2_tell(c, fmu_begin(CORE(c), CORE(c)->at.time));
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    fmu2 *const f = c;
    const fmi2Status status = fmu2_tell(f, fmu_finish(&f->core));
    const char *const told = status == fmi2OK ? fmu_completed(&f->core) : NULL;
    if (told && f->call.logger)
        f->call.logger(f->call.componentEnvironment, f->name, fmi2Warning, "logStatusWarning", "%s",
                       told);
    return status;
}

fmi2Status fmi2Terminate(fmi2Component c)
{
    fmu_end(CORE(c));
    return fmi2OK;
}

fmi2Status fmi2Reset(fmi2Component c)
{
    fmu_reset(CORE(c), CORE(c)->at.exchange);
    return fmi2OK;
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Real value[])
{
    return fmu2_tell(c, fmu_get_all(CORE(c), vr, nvr, value, nvr));
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                       const fmi2Real value[])
{
    return fmu2_tell(c, fmu_set_all(CORE(c), vr, nvr, value, nvr));
}

/* The only integers are friction modes and switches. */
fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                          fmi2Integer value[])
{
    return fmu2_tell(c, fmu_get_modes(CORE(c), vr, nvr, value));
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknowns[],
                                        size_t rows, const fmi2ValueReference knowns[],
                                        size_t columns, const fmi2Real seed[], fmi2Real result[])
{
    return fmu2_tell(c, fmu_derive(CORE(c), unknowns, rows, knowns, columns, seed, result));
}
