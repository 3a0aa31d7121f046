/* Co-simulation in steps of fixed length that end at breakpoints, instants of tasks and communication
 * points: for real time, as each takes the same work. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "fmu_common.h"

/* What went wrong in an internal step of h from t. */
static fmu_error told(fmu_instance *f, int status, double t, double h)
{
    if (status != BG_UNSTABLE)
        return fmu_message(f, status);
    snprintf(f->text, sizeof f->text,
             "at t = %.9g an internal step of %.6g s is beyond the stability of its method at the "
             "model's fastest rates; the longest stable one is %.4g s there: set "
             "fixed_internal_step below it",
             t, h, f->model.fastest.step);
    return f->text;
}

/* Equal steps from t to stop, none longer than `longest`. */
static fmu_error stride(fmu_instance *f, double t, double stop, double longest)
{
    const double count = fmax(1.0, ceil((stop - t) / longest * (1 - BG_WHOLE_STEPS)));
    const double h = (stop - t) / count;
    for (double k = 0; k < count; k++) {
        double rates[BG_ROOM(W)];
        int status;
        for (int i = 0; i < 3; i++)
            fmu_externals(f, &f->at.span, t + (k + 0.5 * i) * h, f->steps + i * W, rates);
        status = bg_model_step(&f->model, t + k * h, h, f->at.s, f->steps);
        if (!bg_is_taken(status))
            return told(f, status, t + k * h, h);
        f->warned = status != BG_OK ? status : f->warned;
    }
    return NULL;
}

/* From t to stop in internal steps, shorter ones where known sources do much in one. */
static fmu_error walk_on(fmu_instance *f, double t, double stop)
{
    fmu_error failed = NULL;
    while (!failed && t < stop) {
        const double ahead = fmu_resolution(f, t, stop - t), next = t + ahead;
        const double until = next < stop && next > t ? next : stop;
        failed = stride(f, t, until, fmin(f->at.step, ahead));
        t = until;
    }
    return failed;
}

/* From t to the end, breakpoint by breakpoint. */
static fmu_error walk_pieces(fmu_instance *f, double t, double end)
{
    fmu_error failed = NULL;
    while (!failed && t < end) {
        double stop = end;
        fmu_pass(f, t);
        f->at.ticked = fmax(f->at.ticked, t); /* the model tells which are done */
        if (fmu_next_break(f, &stop) && !(bg_reached(stop) < end))
            stop = end;
        failed = walk_on(f, t, stop);
        t = stop;
    }
    return failed;
}

/* Sticking as it is at the end of a step, so that outputs show it. */
static int settle_end(fmu_instance *f, double t, double h)
{
    for (int i = 0; i < 3; i++)
        fmu_externals(f, &f->at.span, t + 0.5 * i * h, f->steps + i * W, f->dw);
    return bg_model_settle(&f->model, t, h, f->at.s, f->steps);
}

const char *fmu_warning(const fmu_instance *f)
{
    return f->warned == BG_OK ? NULL : bg_model_message(f->warned);
}

fmu_error fmu_fixed(fmu_instance *f, double t, double end)
{
    f->warned = BG_OK;
    memcpy(f->model.mode, f->at.mode, sizeof f->at.mode);
    f->model.ticked = f->at.ticked;
    fmu_error failed = walk_pieces(f, t, end);
    fmu_pass(f, end);
    if (!failed) {
        const int status = settle_end(f, end, f->at.step);
        failed = bg_is_taken(status) ? NULL : fmu_message(f, status);
    }
    memcpy(f->at.mode, f->model.mode, sizeof f->at.mode);
    f->at.stepped = f->model.started;
    f->at.ticked = fmax(end, f->model.ticked);
    f->at.fastest = f->model.fastest;
    return failed;
}
