/* What delays have read, as polynomials, one part after the other. */
#include "model_memory.h"

#include <math.h>
#include <string.h>

#include "model_signals.h"
#include "run_status.h"
#include "tuning.h"

const double *bg_past_places(void)
{
    /* Cosines of k pi/7. */
    static const double places[BG_PAST_VALUES] = {
        -1.0, -0.90096886790241913, -0.62348980185873353, -0.22252093395631440,
        0.22252093395631440, 0.62348980185873353, 0.90096886790241913, 1.0,
    };
    return places;
}

void bg_memory_begin(bg_memory *m, double t)
{
    bg_remembered *const is = &m->is;
    is->begun = 1;
    is->first = is->count = is->first_break = is->breaks = 0;
    is->since = is->until = is->stretch = t;
    is->following = is->back = INFINITY;
    memset(is->size, 0, sizeof is->size);
}

static bg_past *part(const bg_memory *m, int k)
{
    return (bg_past *)m->parts + (m->is.first + k) % BG_MEMORY;
}

static double break_at(const bg_memory *m, int k)
{
    return m->breaks[(m->is.first_break + k) % BG_MEMORY];
}

/* How many of `count` times, increasing, are no later than t once they are `late`. */
static int reached(const bg_memory *m, double (*time)(const bg_memory *, int), int count,
                   double late, double t)
{
    int low = 0, high = count;
    for (int turn = 0; turn < 32 && low < high; turn++) {
        const int middle = low + (high - low) / 2;
        if (time(m, middle) + late <= t)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static double begin_of(const bg_memory *m, int k)
{
    return part(m, k)->begin;
}

void bg_memory_back(bg_memory *m, double t)
{
    bg_remembered *const is = &m->is;
    if (t < is->since)
        t = is->since;
    for (int k = 0; k < BG_MEMORY && is->count > 0 && !(begin_of(m, is->count - 1) < t); k++)
        is->count--;
    for (int k = 0; k < BG_MEMORY && is->breaks > 0 && break_at(m, is->breaks - 1) >= t; k++)
        is->breaks--;
    is->until = t;
}

void bg_memory_pass(bg_memory *m, double t)
{
    bg_remembered *const is = &m->is;
    is->stretch = is->since;
    is->following = INFINITY;
    for (int i = 0; i < BG_DELAYS; i++) {
        const int count = reached(m, break_at, is->breaks, is->late[i], bg_reached(t));
        if (count > 0)
            is->stretch = fmax(is->stretch, break_at(m, count - 1) + is->late[i]);
        if (count < is->breaks)
            is->following = fmin(is->following, break_at(m, count) + is->late[i]);
    }
}

double bg_memory_shortest(const bg_memory *m)
{
    double shortest = INFINITY;
    for (int i = 0; i < BG_DELAYS; i++)
        shortest = fmin(shortest, m->is.late[i]);
    return shortest;
}

/* A polynomial of a part at a time, and its slope. */
static double part_value(const bg_past *of, int delay, double t, double *slope)
{
    const double half = 0.5 * (of->end - of->begin), x = (t - of->begin) / half - 1.0;
    double value = 0.0, rise = 0.0;
    for (int k = of->count - 1; k >= 0; k--) {
        rise = rise * x + value;
        value = value * x + of->powers[delay][k];
    }
    *slope = rise / half;
    return value;
}

/* The part that a delay gives at t, -1 for the one before all: what begins at a break beyond the
 * stretch has not begun, however close it is. */
static int part_given(const bg_memory *m, double late, double t)
{
    const double stretch = bg_reached(m->is.stretch);
    const int breaks = reached(m, break_at, m->is.breaks, late, stretch);
    const int begun = reached(m, begin_of, m->is.count, late, bg_reached(fmax(t, m->is.stretch)));
    if (breaks == m->is.breaks)
        return begun - 1;
    const double next = break_at(m, breaks);
    return begun > 0 && begin_of(m, begun - 1) >= next
        ? reached(m, begin_of, m->is.count, 0.0, next) - 2 : begun - 1;
}

void bg_memory_at(const bg_memory *m, double t, double *values, double *slopes)
{
    for (int i = 0; i < BG_DELAYS; i++) {
        const int k = m->is.begun ? part_given(m, m->is.late[i], t) : -1;
        slopes[i] = 0.0;
        values[i] = m->is.start[i];
        if (k >= 0)
            values[i] = part_value(part(m, k), i, t - m->is.late[i], slopes + i);
    }
}

/* From values at places to powers of the place: Newton's polynomial, written out. */
static void write_out(int count, const double *places, double *values, double *powers)
{
    for (int order = 1; order < count; order++)
        for (int k = count - 1; k >= order; k--)
            values[k] = (values[k] - values[k - 1]) / (places[k] - places[k - order]);
    memset(powers, 0, sizeof(double) * BG_PAST_VALUES);
    for (int k = count - 1; k >= 0; k--) {
        for (int j = count - 1; j > 0; j--)
            powers[j] = powers[j - 1] - places[k] * powers[j];
        powers[0] = values[k] - places[k] * powers[0];
    }
}

/* Value, slope and half the curvature at a place of a part, over parts that are `h` long. */
static void rises(const bg_past *of, int delay, double place, double h, double rise[3])
{
    const double *const c = of->powers[delay], ratio = 2.0 * h / (of->end - of->begin);
    rise[0] = rise[1] = rise[2] = 0.0;
    for (int k = of->count - 1; k >= 0; k--) {
        rise[2] = rise[2] * place + rise[1];
        rise[1] = rise[1] * place + rise[0];
        rise[0] = rise[0] * place + c[k];
    }
    rise[1] *= ratio;
    rise[2] *= ratio * ratio;
}

/* Whether a delay's latest part does not go on with the one before. What a step that crosses the
 * seam would err by is compared with what is read; differences over short parts are rounding. */
static int breaks_off(const bg_memory *m, int delay)
{
    const bg_past *const now = part(m, m->is.count - 1);
    double after[3], before[3] = {m->is.start[delay], 0.0, 0.0}, shortest = now->end - now->begin;
    double h = fmax(shortest, BG_SEAM_REACH * bg_memory_shortest(m)), rounding = BG_SEAM_ROUNDING;
    if (m->is.count > 1) {
        const bg_past *const last = part(m, m->is.count - 2);
        const double length = now->begin - last->begin;
        h = fmax(h, length);
        shortest = fmin(shortest, length);
        rises(last, delay, 2.0 * length / (last->end - last->begin) - 1.0, h, before);
    }
    rises(now, delay, -1.0, h, after);
    for (int k = 0; k < 3; k++, rounding *= h / shortest)
        if (fabs(after[k] - before[k]) > (BG_SEAM + rounding) * m->is.size[delay])
            return 1;
    return 0;
}

/* Drops the oldest part, if nothing can ask for it any more; and breaks before it. */
static int make_room(bg_memory *m)
{
    bg_remembered *const is = &m->is;
    double longest = 0.0;
    for (int i = 0; i < BG_DELAYS; i++)
        longest = fmax(longest, is->late[i]);
    if (is->count < BG_MEMORY)
        return BG_OK;
    if (!(bg_reached(begin_of(m, 1) + longest) < fmin(is->until, is->back)))
        return BG_FORGETS;
    is->first = (is->first + 1) % BG_MEMORY;
    is->count--;
    for (int k = 0; k < BG_MEMORY && is->breaks > 0 && break_at(m, 0) < begin_of(m, 0); k++) {
        is->first_break = (is->first_break + 1) % BG_MEMORY;
        is->breaks--;
    }
    return BG_OK;
}

int bg_memory_take(bg_memory *m, double end, int count, const double *places,
                   double (*values)[BG_PAST_VALUES], int turns)
{
    bg_remembered *const is = &m->is;
    if (!(end > is->until))
        return BG_OK;
    const int status = make_room(m);
    if (status)
        return status;
    bg_past *const to = part(m, is->count++);
    to->begin = is->until;
    to->end = end;
    to->count = count;
    for (int i = 0; i < BG_DELAYS; i++) {
        for (int k = 0; k < count; k++)
            is->size[i] = fmax(is->size[i], fabs(values[i][k]));
        write_out(count, places, values[i], to->powers[i]);
    }
    int broken = 0;
    for (int i = 0; i < BG_DELAYS; i++)
        broken |= (turns || is->count == 1) && breaks_off(m, i);
    if (broken)
        m->breaks[(is->first_break + is->breaks++) % BG_MEMORY] = is->until;
    is->until = end;
    return BG_OK;
}
