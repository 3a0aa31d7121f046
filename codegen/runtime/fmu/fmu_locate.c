/* Co-simulation as runs of their own: events located, steps that keep a tolerance. */
#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "fmu_common.h"
#include "model_left.h"

/* External inputs in the segment that the run is in. */
static int inputs_there(const void *self, double t, double *w, double *dw)
{
    const fmu_instance *const f = self;
    fmu_externals(f, &f->located.run.span, t, w, dw);
    return 1;
}

/* Known sources are looked at often enough, and where one changes its sign. */
static double look_by(const void *self, double t, double stop)
{
    double look;
    return fmu_next_look(self, t, &look) && look < stop ? look : stop;
}

/* Steps are to keep less than what the importer wants of the whole. */
static void ask_for(const fmu_instance *f, bg_request *asked)
{
    const double told = fmax(BG_KEPT_CLOSER * f->at.tolerance, 100 * DBL_EPSILON);
    asked->rtol = f->at.tolerance > 0 ? fmin(told, BG_KEPT_CLOSER) : BG_RTOL;
    asked->atol = asked->rtol * (BG_ATOL / BG_RTOL);
    asked->method = BG_AUTO;
    asked->capacity = INT_MAX;
}

static fmu_error told_at(fmu_instance *f, int status)
{
    if (bg_left_text(&f->model, status, f->text, sizeof f->text))
        return f->text;
    snprintf(f->text, sizeof f->text, "at t = %.9g: %s", f->located.run.at.t,
             bg_model_message(status));
    return f->text;
}

fmu_error fmu_locate(fmu_instance *f, double t, double end)
{
    bg_located *const c = &f->located;
    bg_request asked = {0};
    int first[BG_MOST_PORTS] = {0};
    /* A breakpoint a rounding after t counts as reached, as instants of tasks do. */
    const double begin = fmax(t, bg_signals_span(&fmu_signals, bg_reached(t)).begin);
    const double from = fmax(begin, f->at.ticked), to = fmu_run_end(from, end);
    if (!(from < to))
        return NULL;
    ask_for(f, &asked);
    memcpy(first, f->at.mode, sizeof(int) * K);
    memcpy(c->s, f->at.s, sizeof c->s);
    bg_located_set_out(c, &f->model, &fmu_signals, &asked, from, to, first);
    c->run.began = f->at.began;
    c->run.goes_on = f->at.decided;
    c->run.done = f->at.ticked;
    c->stiff = BG_STIFF_STEP / (to - from);
    c->ahead = look_by;
    c->view.peaks = &f->at.peaks;
    c->view.self = f;
    c->view.given = inputs_there;
    const int status = bg_located_go(c);
    memcpy(f->at.s, c->s, sizeof f->at.s);
    memcpy(f->at.mode, c->run.mode, sizeof(int) * K);
    f->at.ticked = fmax(to, end);
    fmu_apply(f);
    return status == BG_OK ? NULL : told_at(f, status);
}
