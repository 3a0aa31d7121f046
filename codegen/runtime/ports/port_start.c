/* How a run begins: stops apart, other switches off unless they are told, and states that were not
 * named completed by what these hold. */
#include <math.h>
#include <stddef.h>

#include "model_internal.h"
#include "port_rounding.h"

void bg_all_off(int *mode)
{
    for (int i = 0; i < K; i++)
        mode[i] = bg_switches[i].kind == BG_RUBS ? 1
            : bg_switches[i].kind == BG_STOPS    ? !bg_switches[i].on
                                                 : bg_switches[i].on;
}

/* A status: BG_BEYOND where a stop, which `m->where` tells, is beyond its bound. */
static int check_gaps(bg_model *m, double t, const double *s)
{
    double guards[BG_ROOM(BG_GUARDS)] = {0};
    const double spacing = nextafter(fabs(t), INFINITY) - fabs(t);
    if (!BG_STOPPING)
        return BG_OK;
    bg_guards(&m->now, guards);
    for (int i = 0; i < K; i++) {
        const bg_switch *const one = bg_switches + i;
        if (one->kind != BG_STOPS)
            continue;
        const double gap = guards[one->guard], place = s[one->place];
        const double rate = m->shot.rate[one->place], seen = m->seen[one->place];
        m->where = i;
        if (gap < -bg_gap_rounding(one, gap, place, rate, seen, spacing))
            return BG_BEYOND;
    }
    m->where = -1;
    return BG_OK;
}

/* Switches whose conditions say so at `m->now` change over; no transition is taken before a run. */
static void as_told(bg_model *m, int *mode)
{
    double guards[BG_ROOM(BG_GUARDS)] = {0};
    if (BG_GUARDS)
        bg_guards(&m->now, guards);
    for (int i = 0; i < K; i++)
        if (bg_switches[i].kind == BG_TOLD && !bg_switches[i].machine
            && bg_stay(bg_switches + i, mode[i], 0, 0, guards) < 0)
            mode[i] = !mode[i];
}

/* The slips that free states can make up for, by how these weigh. */
static void make_up(const bg_hold *held, const double *weight, const double *slips, double *s)
{
    double square[PORTS * PORTS], inverse[PORTS * PORTS], right[PORTS], way[PORTS] = {0};
    int pivots[PORTS], rows[PORTS], count = 0;
    for (int k = 0; k < held->kept; k++) {
        double own = 0.0;
        for (int i = 0; i < N; i++)
            own += held->slip_x[k * N + i] * weight[i] * held->slip_x[k * N + i];
        if (own > 0.0) {
            right[count] = slips[k];
            rows[count++] = k;
        }
    }
    for (int a = 0; a < count; a++)
        for (int b = 0; b < count; b++) {
            square[a * count + b] = 0.0;
            for (int i = 0; i < N; i++)
                square[a * count + b] += held->slip_x[rows[a] * N + i] * weight[i]
                    * held->slip_x[rows[b] * N + i];
        }
    if (count == 0 || !bg_inverse(count, square, pivots, inverse))
        return;
    bg_multiply_add(count, count, inverse, right, way);
    for (int a = 0; a < count; a++)
        for (int i = 0; i < N; i++)
            s[i] -= weight[i] * held->slip_x[rows[a] * N + i] * way[a];
}

int bg_complete(bg_model *m, double t, const double *w, const int *named, int *mode, double *s)
{
    int loose[BG_ROOM(K)], holding[BG_ROOM(K)], any = 0;
    double slips[PORTS], weight[BG_ROOM(N)];
    bg_hold *held = NULL;
    if (!BG_SWITCHES)
        return BG_OK;
    for (int i = 0; i < K; i++)
        loose[i] = 1;
    int status = bg_evaluate(m, t, s, w, NULL, loose, 1, &m->shot);
    if (status == BG_OK)
        status = check_gaps(m, t, s);
    if (status != BG_OK)
        return status;
    as_told(m, mode);
    for (int i = 0; i < K; i++) {
        holding[i] = bg_switches[i].kind == BG_RUBS ? 1 : mode[i];
        any |= holding[i] == 0;
    }
    if (any)
        status = bg_hold_of(m, holding, &held);
    if (status != BG_OK || !held)
        return BG_OK; /* whoever decides the mode tells */
    bg_held_slips(held, &m->shot, slips);
    /* One over the own inertia of each state that is free. */
    for (int i = 0; i < N; i++)
        weight[i] = named[i] ? 0.0 : m->numbers.scale[i] * m->numbers.scale[i];
    make_up(held, weight, slips, s);
    return BG_OK;
}
