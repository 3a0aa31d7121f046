/* What a unit's calls do, for FMI 2 and 3 alike: which is allowed when, and arrays of values. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "fmu_common.h"

static int initialized(const fmu_instance *f)
{
    return f->at.phase == FMU_EVENT || f->at.phase == FMU_CONTINUOUS;
}

fmu_error fmu_begin(fmu_instance *f, double start)
{
    if (f->at.phase != FMU_MADE)
        return "initialization begins once, after instantiation";
    f->at.phase = FMU_INITIALIZING;
    fmu_set_time(f, start);
    f->at.began = start;
    f->at.ticked = nextafter(start, -INFINITY);
    fmu_pass(f, start);
    return NULL;
}

fmu_error fmu_finish(fmu_instance *f)
{
    return f->at.phase == FMU_INITIALIZING ? fmu_initialize(f) : "not in initialization mode";
}

const char *fmu_completed(fmu_instance *f)
{
    size_t used = 0;
    for (int i = 0; i < FMU_STATES && used < sizeof f->text; i++)
        if (f->completed[i] != 0.0)
            used += (size_t)snprintf(f->text + used, sizeof f->text - used, "%s %s = %.9g",
                                     used ? "," : "states that were not set follow what switches "
                                     "hold:", bg_state_names[i], f->at.start[i] + f->completed[i]);
    return used ? f->text : NULL;
}

fmu_error fmu_enter(fmu_instance *f, int phase)
{
    if (!f->at.exchange)
        return "co-simulation has neither event mode nor continuous time mode";
    if (!initialized(f))
        return "event mode and continuous time mode come after initialization";
    f->at.phase = phase;
    return NULL;
}

fmu_error fmu_update(fmu_instance *f, int *states_changed)
{
    *states_changed = 0;
    return f->at.phase == FMU_EVENT ? fmu_event(f, states_changed) : "not in event mode";
}

fmu_error fmu_completed_step(fmu_instance *f)
{
    fmu_error failed = NULL;
    if (BG_DELAYS && f->at.phase == FMU_CONTINUOUS)
        failed = fmu_read_late(f);
    return failed || !BG_DELAYS || f->at.phase != FMU_CONTINUOUS ? failed : fmu_go_on_late(f, 0);
}

fmu_error fmu_step(fmu_instance *f, double time, double step)
{
    return f->at.phase == FMU_STEPPING ? fmu_advance(f, time, step)
                                       : "not initialized for co-simulation";
}

void fmu_end(fmu_instance *f)
{
    f->at.phase = FMU_ENDED;
}

static const char *const as_many = "there must be as many values as the variables have";

/* Whether a variable is an array: it is got and set whole. */
static int is_array(unsigned reference)
{
    return reference < FMU_VARIABLES && fmu_size(reference) > 1;
}

fmu_error fmu_get_all(fmu_instance *f, const unsigned *references, size_t count, double *values,
                      size_t room)
{
    fmu_error failed = room == fmu_sizes(references, count) ? NULL : as_many;
    for (size_t i = 0; i < count && !failed; i++) {
        if (is_array(references[i]))
            fmu_get_table(f, references[i], values);
        else
            failed = fmu_get(f, references[i], values);
        values += is_array(references[i]) ? fmu_size(references[i]) : 1;
    }
    return failed;
}

fmu_error fmu_set_all(fmu_instance *f, const unsigned *references, size_t count,
                      const double *values, size_t given)
{
    fmu_error failed = given == fmu_sizes(references, count) ? NULL : as_many;
    for (size_t i = 0; i < count && !failed; i++) {
        failed = is_array(references[i]) ? fmu_set_table(f, references[i], values)
                                         : fmu_set(f, references[i], *values);
        values += is_array(references[i]) ? fmu_size(references[i]) : 1;
    }
    return failed;
}

fmu_error fmu_get_modes(fmu_instance *f, const unsigned *references, size_t count, int *values)
{
    fmu_error failed = NULL;
    for (size_t i = 0; i < count && !failed; i++) {
        double found = 0.0;
        failed = references[i] < FMU_VARIABLES && fmu_variables[references[i]].kind >= FMU_MODE
            ? fmu_get(f, references[i], &found) : "this variable is no integer";
        values[i] = (int)found;
    }
    return failed;
}

fmu_error fmu_get_states(fmu_instance *f, double *states, size_t count)
{
    const fmu_error failed = count == FMU_STATES ? fmu_refresh(f) : "wrong number of states";
    if (!failed)
        memcpy(states, f->at.s, sizeof(double) * count);
    return failed;
}

fmu_error fmu_get_rates(fmu_instance *f, double *rates, size_t count)
{
    const fmu_error failed = count == FMU_STATES ? fmu_refresh(f) : "wrong number of states";
    if (!failed)
        memcpy(rates, f->located.view.shot.rate, sizeof(double) * count);
    return failed;
}

fmu_error fmu_get_indicators(fmu_instance *f, double *indicators, size_t count)
{
    return count == FMU_INDICATORS ? fmu_indicators(f, indicators)
                                   : "wrong number of event indicators";
}

/* Nothing is known of how large a state gets. */
void fmu_get_nominals(double *nominals, size_t count)
{
    for (size_t i = 0; i < count; i++)
        nominals[i] = 1.0;
}

fmu_error fmu_copy(void *to, const void *from, size_t size)
{
    if (size != sizeof(fmu_saved))
        return "this is no state of the unit: its size is another";
    if (!to)
        return "no memory for the state";
    memcpy(to, from, size);
    return NULL;
}
