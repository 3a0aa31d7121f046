/* Where what is positive through a stretch first falls to zero inside a step: by points and roots.
 * As codegen/numbers/falling.py. */
#include <math.h>
#include <string.h>

#include "located_internal.h"

enum { POINTS = BG_CHECKS + 2 };

/* What a search for a root asks: trigger `which` less `level` inside the latest step. */
typedef struct {
    bg_falling *f;
    const bg_triggers *of;
    int which, status;
    double level;
} root_search;

static double above(void *self, double t)
{
    root_search *const asked = self;
    double values[BG_WATCHED] = {0};
    const int status = asked->of->at(asked->of->self, t, values);
    if (status != BG_OK)
        asked->status = status;
    return values[asked->which] - asked->level;
}

/* Where trigger falls through the level between a and b, where it is above it and below. */
static double crossing(root_search *asked, double a, double b, double level)
{
    double found = b;
    asked->level = level;
    if (above(asked, a) <= 0)
        return a;
    if (above(asked, b) < 0)
        bg_root(above, asked, a, b, &found);
    return found;
}

/* Where a trigger that begins at zero falls well below it between a and b; where it has been up and
 * down again before that, where it came through zero. */
static double hop(root_search *asked, double a, double b, double limit)
{
    const double low = crossing(asked, a, b, -2 * limit), half = 0.5 * (a + low);
    asked->level = 0.0;
    return above(asked, half) > limit ? crossing(asked, half, low, 0.0) : low;
}

/* Where trigger `i` falls through zero between two points: 1, if it does. Until it is armed only a
 * fall well below zero counts, after a moment in which nothing does. */
static int trigger_fall(root_search *asked, double t_a, double t_b, double a, double b,
                        double *root)
{
    bg_falling *const f = asked->f;
    const int i = asked->which;
    const double limit = f->limit[i];
    if (!f->armed[i] && fmax(a, b) > limit) {
        f->armed[i] = 1;
        if (a <= limit)
            return 0;
    }
    if (f->armed[i]) {
        if (b > 0)
            return 0;
        *root = crossing(asked, t_a, t_b, 0.0);
        return 1;
    }
    if (b >= -2 * limit || t_b <= f->blind)
        return 0;
    *root = fmax(hop(asked, t_a, t_b, limit), f->blind);
    return 1;
}

/* The first of two roots between points k and k + 1, where a trigger dips below zero and comes
 * back. */
static int dip(root_search *asked, const double *times, const double *values, int k, double *root)
{
    double lowest;
    asked->level = 0.0;
    if (!bg_dip(above, asked, POINTS, times, values, k, &lowest))
        return 0;
    *root = crossing(asked, times[k], lowest, 0.0);
    return 1;
}

/* Whether chords could leave zero or less anywhere between points at equal distances: one drawn on
 * falls by no more than the largest change between two points, and twice that as it bends. */
static int may_dip(const double *values)
{
    double least = values[0], most = 0.0;
    for (int k = 1; k < POINTS; k++) {
        const double change = fabs(values[k] - values[k - 1]);
        least = values[k] < least ? values[k] : least;
        most = change > most ? change : most;
    }
    return least <= 3 * most;
}

/* The first time in a step at which a trigger falls through zero, seen or hidden in a dip. What is
 * rising from zero, after its own event, has not come from above. */
static int first_fall(root_search *asked, const double *times, double values[POINTS][BG_WATCHED],
                      double *root)
{
    const bg_falling *const f = asked->f;
    const int i = asked->which;
    double own[POINTS];
    for (int k = 0; k < POINTS; k++)
        own[k] = values[k][i];
    const int near = may_dip(own);
    for (int k = 0; k + 1 < POINTS; k++) {
        const int risen = f->armed[i] || own[k] > f->limit[i];
        if (trigger_fall(asked, times[k], times[k + 1], own[k], own[k + 1], root)
            || (near && risen && dip(asked, times, own, k, root)))
            return 1;
    }
    return 0;
}

int bg_passes(const bg_falling *f, int count, const double *middle, const double *end)
{
    int pass = 1;
    for (int i = 0; i < count; i++) {
        const double first = f->before[i];
        const double most = fmax(fabs(middle[i] - first), fabs(end[i] - middle[i]));
        pass &= isinf(end[i]) || fmin(fmin(first, middle[i]), end[i]) > BG_CLEAR * most;
    }
    return pass;
}

void bg_note_pass(bg_falling *f, int count, const double *end)
{
    for (int i = 0; i < count; i++) {
        f->before[i] = end[i];
        f->armed[i] |= end[i] > f->limit[i];
    }
}

/* The triggers at points after the first. */
static int look_at_all(const bg_triggers *of, const double *times, double (*values)[BG_WATCHED])
{
    const bg_together *const with = of->together;
    int status = BG_OK;
    if (with && with->triggers(with->self, POINTS - 1, times, values))
        return BG_OK;
    for (int k = 0; k < POINTS - 1 && status == BG_OK; k++)
        status = of->at(of->self, times[k], values[k]);
    return status;
}

int bg_first_fall(bg_falling *f, const bg_triggers *of, double begin, double end, double *time,
                  int *which)
{
    double times[POINTS], values[POINTS][BG_WATCHED], roots[BG_WATCHED];
    root_search asked = {f, of, 0, BG_OK, 0.0};
    *time = INFINITY;
    memcpy(values[0], f->before, sizeof values[0]);
    for (int k = 0; k < POINTS; k++)
        times[k] = k == POINTS - 1 ? end : begin + k * (end - begin) / (POINTS - 1);
    const int status = look_at_all(of, times + 1, values + 1);
    if (status != BG_OK)
        return status;
    memcpy(f->before, values[POINTS - 1], sizeof values[0]);
    for (int i = 0; i < of->count; i++) {
        asked.which = i;
        roots[i] = INFINITY;
        first_fall(&asked, times, values, roots + i);
        *time = fmin(*time, roots[i]);
    }
    for (int i = 0; i < of->count; i++)
        which[i] = roots[i] < INFINITY
            && roots[i] <= *time + BG_TOGETHER * fmax(fabs(*time), end - begin);
    return asked.status;
}
