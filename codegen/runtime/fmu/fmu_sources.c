/* External inputs: what the importer gives, and the sources inside. */
#include <float.h>
#include <math.h>

#include "fmu_common.h"
#include "located_internal.h"
#include "run_pace.h"

enum { MOMENTS = BG_CHECKS + 1 };

/* Values and rates at t; what the importer gives goes on from the instance's time with its slope. */
void fmu_externals(const fmu_instance *f, const bg_span *span, double t, double *w, double *dw)
{
    bg_signals_at(&fmu_signals, span, t, w, dw);
    for (int i = 0; i < BG_EXTERNAL; i++)
        if (!fmu_inside[i]) {
            const double change = f->at.slopes[i] * (t - f->at.time);
            const double size = fabs(f->at.given[i]) + fabs(change), slope = fabs(f->at.slopes[i]);
            w[i] = f->at.given[i] + change;
            if (change != 0.0 && fabs(w[i]) <= bg_cancelled(size, slope, fabs(t)))
                w[i] = 0.0;
            dw[i] = f->at.slopes[i];
        }
    if (BG_DELAYS)
        bg_model_recall(&f->model, t, w, dw);
}

void fmu_pass(fmu_instance *f, double t)
{
    f->at.span = bg_signals_span(&fmu_signals, bg_reached(t));
    if (BG_DELAYS)
        bg_pass_memory(&f->model, t, INFINITY, &f->at.span);
    f->stale = 1;
}

int fmu_next_break(const fmu_instance *f, double *time)
{
    const double following = fmin(f->at.span.following, fmu_next_tick(f));
    if (following == INFINITY)
        return 0;
    *time = following;
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

/* An expression of time alone, and whether it is above zero at first. */
typedef struct {
    bg_values *now;
    int which, above;
} timed_sign;

static void values_at(bg_values *now, double t, double *values)
{
    now->t = t;
    fmu_timed_values(now, values);
}

/* Positive where the expression is on the side where it was at first. */
static double kept(void *self, double t)
{
    const timed_sign *const sign = self;
    double values[BG_ROOM(FMU_TIMED)] = {0};
    values_at(sign->now, t, values);
    return sign->above ? values[sign->which] : -values[sign->which];
}

/* Whether that is the sign at first; of zero it is that of what is not above. */
static int is_same(const timed_sign *sign, double side)
{
    const double value = sign->above ? side : -side;
    return (value > 0.0) == sign->above;
}

static int is_kept(timed_sign *sign, double t)
{
    return is_same(sign, kept(sign, t));
}

/* The first instant after a, where the sign is kept, no later than b, at which it is another. */
static double change_between(timed_sign *sign, double a, double b)
{
    for (;;) {
        const double middle = a + 0.5 * (b - a);
        if (!(middle > a && middle < b))
            return b;
        if (is_kept(sign, middle))
            a = middle;
        else
            b = middle;
    }
}

/* The first change of a sign, which points show or a dip between two of them hides, or `found`. */
static double change_of(timed_sign *sign, const double *times, const double *sides, double found)
{
    const double clear = BG_ROUNDING * bg_largest(MOMENTS, sides);
    for (int k = 0; k + 1 < MOMENTS && times[k] < found; k++) {
        double lowest = times[k];
        if (!is_same(sign, sides[k + 1]))
            return change_between(sign, times[k], times[k + 1]);
        /* What rises from zero, after its own event, has not come from above. */
        if (fmin(sides[k], sides[k + 1]) > clear
            && bg_dip(kept, sign, MOMENTS, times, sides, k, &lowest) && !is_kept(sign, lowest))
            return change_between(sign, times[k], lowest);
    }
    return found;
}

/* The first change of such a sign from a to b, or b; what an event at a has changed is past. */
static double first_change(const fmu_instance *f, double a, double b)
{
    const double past = fmax(BG_NARROW * (b - a), 8 * DBL_EPSILON * fabs(a));
    double times[MOMENTS], values[MOMENTS][BG_ROOM(FMU_TIMED)] = {{0}}, sides[MOMENTS], found = b;
    bg_values now = f->model.now;
    for (int k = 0; k < MOMENTS; k++) {
        times[k] = k == 0 ? a + past : k + 1 == MOMENTS ? b : a + k * (b - a) / (MOMENTS - 1);
        values_at(&now, times[k], values[k]);
    }
    for (int i = 0; i < FMU_TIMED && times[0] < times[1]; i++) {
        timed_sign sign = {&now, i, values[0][i] > 0.0};
        for (int k = 0; k < MOMENTS; k++)
            sides[k] = sign.above ? values[k][i] : -values[k][i];
        found = fmin(found, change_of(&sign, times, sides, found));
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
