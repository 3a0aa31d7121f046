/* External inputs: what the importer gives, and the sources inside. */
#include <math.h>

#include "fmu_common.h"

/* Values and rates at t; what the importer gives goes on from the instance's time with its slope. */
void fmu_externals(const fmu_instance *f, double t, double *w, double *dw)
{
    bg_signals_at(&fmu_signals, f->at.segment, t, w, dw);
    for (int i = 0; i < BG_EXTERNAL; i++)
        if (!fmu_inside[i]) {
            const double change = f->at.slopes[i] * (t - f->at.time);
            const double size = fabs(f->at.given[i]) + fabs(change), slope = fabs(f->at.slopes[i]);
            w[i] = f->at.given[i] + change;
            if (change != 0.0 && fabs(w[i]) <= bg_cancelled(size, slope, fabs(t)))
                w[i] = 0.0;
            dw[i] = f->at.slopes[i];
        }
}

void fmu_pass(fmu_instance *f, double t)
{
    f->at.segment = bg_signals_segment(&fmu_signals, t);
    f->stale = 1;
}

int fmu_next_break(const fmu_instance *f, double *time)
{
    if (f->at.segment + 1 >= fmu_signals.segments)
        return 0;
    *time = fmu_signals.breaks[f->at.segment];
    return 1;
}

/* A part of `longest`, halved until known sources do little in it. */
double fmu_resolution(const fmu_instance *f, double t, double longest)
{
    double h = longest;
    for (int halvings = 0; halvings < 80 && !fmu_resolved(&f->model.now, t, h); halvings++)
        h *= 0.5;
    return h;
}

int fmu_next_event(const fmu_instance *f, double *time)
{
    const double never = 1099511627776.0, t = f->at.time; /* 2^40 s: nothing happens */
    const double ahead = fmu_resolution(f, t, never);
    const int breaks = fmu_next_break(f, time), looks = ahead < never && t + ahead > t;
    if (looks && (!breaks || t + ahead < *time))
        *time = t + ahead;
    return breaks || looks;
}
