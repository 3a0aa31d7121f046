/* An instance: its variables by value reference, and its values brought up to date when asked for. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "fmu_common.h"
#include "model_left.h"

fmu_error fmu_message(fmu_instance *f, int status)
{
    if (status == BG_OK)
        return NULL;
    return bg_left_text(&f->model, status, f->text, sizeof f->text) ? f->text
                                                                     : bg_model_message(status);
}

/* Sources inside and what the importer gives, for the view. An importer's integrator looks past a
 * time event and keeps nothing of it: a level that comes down to zero there goes on smoothly, and is
 * not refused for being below. */
static int externals_at(const void *self, double t, double *w, double *dw)
{
    const fmu_instance *const f = self;
    double following;
    fmu_externals(f, &f->at.span, t, w, dw);
    return !(f->at.exchange && fmu_next_break(f, &following) && t > following);
}

/* What a known source does below what is nothing is rounding: nothing is ruled by it. */
static void see_nothing(bg_peaks *peaks)
{
    for (int i = 0; i < BG_STATES; i++)
        peaks->x[i] = BG_NOTHING_THERE / BG_ROUNDING;
    for (int i = 0; i < BG_INPUTS; i++)
        peaks->u[i] = BG_NOTHING_THERE / BG_ROUNDING;
}

void fmu_reset(fmu_instance *f, int exchange)
{
    memset(f, 0, sizeof *f);
    see_nothing(&f->at.peaks);
    f->at.exchange = exchange;
    f->at.span = bg_signals_span(&fmu_signals, f->at.time);
    bg_model_parameters(f->at.parameters);
    bg_tables_init(&f->own);
    memcpy(f->at.start, fmu_starts, sizeof(double) * FMU_STATES);
    memcpy(f->at.given, fmu_inputs, sizeof(double) * BG_EXTERNAL);
    memcpy(f->at.named, fmu_named, sizeof(int) * FMU_STATES);
    memcpy(f->at.mode, fmu_first, sizeof(int) * BG_FRICTION);
    f->stale = f->changed = 1;
}

/* What the view looks at. */
static void look_here(fmu_instance *f)
{
    bg_view *const v = &f->located.view;
    v->model = &f->model;
    v->peaks = &f->at.peaks;
    v->self = f;
    v->given = externals_at;
}

/* Parameters that were set take effect. */
fmu_error fmu_apply(fmu_instance *f)
{
    fmu_error failed;
    int status;
    look_here(f);
    if (!f->changed)
        return NULL;
    failed = fmu_fit_tables(f);
    if (failed)
        return failed;
    const bg_remembered remembered = f->model.memory.is;
    status = bg_model_init_with(&f->model, f->at.parameters, &f->own);
    if (BG_DELAYS)
        bg_model_remember(&f->model, &remembered);
    memcpy(f->model.mode, f->at.mode, sizeof f->model.mode);
    memcpy(f->model.seen, f->at.seen, sizeof f->model.seen);
    f->model.started = f->at.stepped;
    f->model.fastest = f->at.fastest;
    f->changed = status != BG_OK;
    f->located.view.measured = 0;
    return fmu_message(f, status);
}

/* The same of a start; of a stop that begins beyond its bound, which one. */
static fmu_error message_of_start(fmu_instance *f, int status)
{
    if (status != BG_BEYOND)
        return fmu_message(f, status);
    snprintf(f->text, sizeof f->text, "stop %.120s: %s", bg_friction_names[f->model.where],
             bg_model_message(status));
    return f->text;
}

/* The vector and the mode at the start values, which those that were not set follow. */
static fmu_error start(fmu_instance *f)
{
    double before[BG_SIZE];
    int mode[BG_ROOM(BG_FRICTION)];
    memcpy(mode, fmu_first, sizeof(int) * BG_FRICTION);
    int status = bg_model_vector(&f->model, f->at.time, f->at.start, f->w, f->at.s);
    memcpy(before, f->at.s, sizeof before);
    if (status == BG_OK)
        status = bg_complete(&f->model, f->at.time, f->w, f->at.named, mode, f->at.s);
    if (status != BG_OK || f->frozen)
        return message_of_start(f, status);
    for (int i = 0; i < FMU_STATES; i++)
        f->completed[i] = f->at.s[i] - before[i];
    memcpy(f->at.mode, mode, sizeof(int) * BG_FRICTION);
    f->at.decided = 0;
    return fmu_decide(f);
}

/* Every value at the instance's time, in its mode; before the start of a run the mode is looked for. */
fmu_error fmu_refresh(fmu_instance *f)
{
    fmu_error failed = NULL;
    if (!f->stale)
        return NULL;
    failed = fmu_apply(f);
    if (failed)
        return failed;
    fmu_externals(f, &f->at.span, f->at.time, f->w, f->dw);
    if (f->at.phase <= FMU_INITIALIZING)
        failed = start(f);
    if (!failed)
        failed = fmu_look(f);
    if (!failed && FMU_SWITCHES)
        fmu_switch_values(&f->model.now, f->switches);
    f->stale = failed != NULL;
    return failed;
}

fmu_error fmu_look(fmu_instance *f)
{
    return fmu_message(f, bg_view_look(&f->located.view, f->at.time, f->at.s, f->at.mode));
}

static double state_of(const fmu_instance *f, int at)
{
    return at < BG_STATES ? f->located.view.shot.x[at] : f->located.view.shot.z[at - BG_STATES];
}

fmu_error fmu_get(fmu_instance *f, unsigned reference, double *value)
{
    double indicators[BG_ROOM(FMU_INDICATORS)];
    const fmu_variable *v = &fmu_variables[reference];
    fmu_error failed = NULL;
    if (reference >= FMU_VARIABLES)
        return "unknown value reference";
    if (fmu_size(reference) > 1)
        return "this variable is an array";
    if (v->kind > FMU_SLOPE)
        failed = fmu_refresh(f);
    if (failed)
        return failed;
    switch (v->kind) {
    case FMU_TIME: *value = f->at.time; break;
    case FMU_PARAMETER: *value = f->at.parameters[v->index]; break;
    case FMU_TABLE_VALUE: fmu_get_table(f, reference, value); break;
    case FMU_INTERNAL_STEP: *value = f->at.step; break;
    case FMU_INPUT: *value = f->at.given[v->index]; break;
    case FMU_SLOPE: *value = f->at.slopes[v->index]; break;
    case FMU_STATE: *value = state_of(f, v->index); break;
    case FMU_VECTOR: *value = f->at.s[v->index]; break;
    case FMU_RATE: *value = f->located.view.shot.rate[v->index]; break;
    case FMU_READING: *value = f->located.view.shot.y[v->index]; break;
    case FMU_GIVEN: *value = f->located.view.shot.u[v->index]; break;
    case FMU_SOURCE: *value = f->w[v->index]; break;
    case FMU_INDICATOR:
        fmu_indicators_of(f, &f->located.view.shot, indicators);
        *value = indicators[v->index];
        break;
    case FMU_SWITCH: *value = bg_model_switched(v->index, f->at.mode[v->index]); break;
    case FMU_SLIDES: *value = bg_slides(f->at.mode + v->index); break;
    default: *value = f->at.mode[v->index];
    }
    return NULL;
}

fmu_error fmu_tunable(const fmu_instance *f)
{
    const int tuning = f->at.phase == FMU_EVENT || f->at.phase == FMU_STEPPING;
    return f->at.phase <= FMU_INITIALIZING || (tuning && !FMU_MOVED)
        ? NULL : "this parameter cannot be changed now";
}

static fmu_error set_parameter(fmu_instance *f, int index, double value)
{
    const fmu_error failed = fmu_tunable(f);
    if (failed)
        return failed;
    f->changed |= f->at.parameters[index] != value;
    f->at.parameters[index] = value;
    return NULL;
}

fmu_error fmu_set(fmu_instance *f, unsigned reference, double value)
{
    const fmu_variable *v = &fmu_variables[reference];
    if (reference >= FMU_VARIABLES)
        return "unknown value reference";
    if (fmu_size(reference) > 1)
        return "this variable is an array";
    if (v->kind == FMU_TABLE_VALUE)
        return fmu_set_table(f, reference, &value);
    if (!isfinite(value))
        return "a value is not finite";
    f->stale = 1;
    switch (v->kind) {
    case FMU_PARAMETER: return set_parameter(f, v->index, value);
    case FMU_INPUT: f->at.given[v->index] = value; return NULL;
    case FMU_SLOPE: f->at.slopes[v->index] = value; return NULL;
    case FMU_STATE:
        if (f->at.phase > FMU_INITIALIZING)
            return "a start value can only be set before the start";
        f->at.start[v->index] = value;
        f->at.named[v->index] = 1;
        return NULL;
    case FMU_INTERNAL_STEP:
        if (f->at.phase > FMU_INITIALIZING || value < 0)
            return "fixed_internal_step must be set before the start: 0, or a length [s]";
        f->at.step = value;
        return NULL;
    default: return "this variable cannot be set";
    }
}

fmu_error fmu_set_states(fmu_instance *f, const double *states, size_t count)
{
    if (count != FMU_STATES)
        return "wrong number of states";
    for (int i = 0; i < FMU_STATES; i++)
        if (!isfinite(states[i]))
            return "a state is not finite";
    if (f->at.phase <= FMU_INITIALIZING)
        return "states can only be set after the start";
    memcpy(f->at.s, states, sizeof(double) * FMU_STATES);
    f->stale = 1;
    return NULL;
}

void fmu_set_time(fmu_instance *f, double time)
{
    f->stale |= f->at.time != time;
    f->at.time = time;
}

void fmu_restore(fmu_instance *f, const fmu_memory *from)
{
    f->at = *from;
    f->stale = f->changed = 1;
}
