/* External inputs: what the importer gives, and the sources inside. */
#include <float.h>
#include <math.h>

#include "fmu_common.h"
#include "run_pace.h"

/* Values and rates at t; what the importer gives goes on from the instance's time with its slope. */
void fmu_externals(const fmu_instance *f, int segment, double t, double *w, double *dw)
{
    bg_signals_at(&fmu_signals, segment, t, w, dw);
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

/* The signs of the expressions of time alone: whether they are above zero. */
static void signs_at(bg_values *now, double t, int *above)
{
    double values[BG_ROOM(FMU_TIMED)] = {0};
    now->t = t;
    fmu_timed_values(now, values);
    for (int i = 0; i < FMU_TIMED; i++)
        above[i] = values[i] > 0.0;
}

/* The first instant after a, no later than b, at which one of these signs is another. */
static double change_of(bg_values *now, int which, double a, double b, int before)
{
    int above[BG_ROOM(FMU_TIMED)];
    for (;;) {
        const double middle = a + 0.5 * (b - a);
        if (!(middle > a && middle < b))
            return b;
        signs_at(now, middle, above);
        if (above[which] == before)
            a = middle;
        else
            b = middle;
    }
}

/* The first change of such a sign from a to b, or b; what an event at a has changed is past. */
static double first_change(const fmu_instance *f, double a, double b)
{
    const double past = fmax(BG_NARROW * (b - a), 8 * DBL_EPSILON * fabs(a));
    int before[BG_ROOM(FMU_TIMED)], above[BG_ROOM(FMU_TIMED)];
    bg_values now = f->model.now;
    double from = a + past, found = b;
    signs_at(&now, from, before);
    for (int k = 1; k <= BG_CHECKS && from < b && found == b; k++) {
        const double to = k == BG_CHECKS ? b : a + k * (b - a) / BG_CHECKS;
        signs_at(&now, to, above);
        for (int i = 0; i < FMU_TIMED; i++)
            if (above[i] != before[i])
                found = fmin(found, change_of(&now, i, from, to, before[i]));
        from = to;
    }
    return found;
}

int fmu_next_look(const fmu_instance *f, double t, double *time)
{
    const double never = 1099511627776.0; /* 2^40 s: nothing happens */
    const double most = FMU_TIMED ? bg_longest_step(t - f->at.began) : never;
    const double ahead = fmu_resolution(f, t, most);
    if (!(ahead < never && t + ahead > t))
        return 0;
    *time = FMU_TIMED ? first_change(f, t, t + ahead) : t + ahead;
    return 1;
}

int fmu_next_event(const fmu_instance *f, double *time)
{
    double look = 0.0;
    const int breaks = fmu_next_break(f, time), looks = fmu_next_look(f, f->at.time, &look);
    if (looks && (!breaks || look < *time))
        *time = look;
    return breaks || looks;
}
