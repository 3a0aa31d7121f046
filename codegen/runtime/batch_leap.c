/* Steps of one length, eight at a time from one state, of which only what is followed is computed:
 * triggers with their slopes, signals, and the state at the end. The test is that of bg_leap.c. */
#include "batch_internal.h"

#include <float.h>
#include <string.h>

enum { STRIDE = BATCH_STRIDE };

/* Triggers and thirds of their changes at the present state and the steps from there. */
typedef double trail[STRIDE + 1];

/* to += P z, by columns */
static inline void add_product(double (*P)[BG_Z], const double *z, double *to)
{
    for (int j = 0; j < BG_Z; j++)
        for (int i = 0; i < BG_Z; i++)
            to[i] += P[j][i] * z[j];
}

/* `count` steps of the state, fewer than twice the stride. */
static void walk(batch_leaps *l, int count)
{
    for (int i = 0; i < BATCH_POWERS; i++)
        if (count >> i & 1) {
            double next[BG_Z];
            memcpy(next, l->step[i], sizeof next);
            add_product(l->table.power[i], l->beyond, next);
            memcpy(l->beyond, next, sizeof next);
        }
}

static double at_origin(const batch_leaps *l, int row)
{
    if (row < BATCH_OWN)
        return l->origin[BG_Z + row];
    double sum = l->room->levels[row - BATCH_OWN];
    for (int j = 0; j < BG_Z; j++)
        sum += l->table.row[row][j] * l->origin[j];
    return sum;
}

/* What a row is in 1, 2, .. steps where the state is the origin: `add` of the state is added. */
static void fill_constants(const batch_leaps *l, double (*add)[STRIDE])
{
    for (int i = 0; i < BATCH_OWN + l->room->job->signals; i++) {
        const double start = at_origin(l, i);
        double *const to = l->room->constants[i];
        for (int r = 0; r < STRIDE; r++)
            to[r] = start;
        for (int j = 0; j < BG_Z; j++)
            for (int r = 0; r < STRIDE; r++)
                to[r] += l->table.row[i][j] * add[j][r];
    }
}

void batch_begin_leaps(batch_leaps *l, const double *z, int total)
{
    const bg_entry *const e = l->stretch->entry;
    double rate[BG_Z], add[BG_Z][STRIDE], sum[BG_Z] = {0};
    memcpy(l->origin, z, sizeof rate);
    bg_fill(l->stretch, l->origin);
    memcpy(rate, l->stretch->b, sizeof rate);
    add_product((double(*)[BG_Z])e->M, z, rate);
    add_product((double(*)[BG_Z])e->gather, rate, sum);
    for (int r = 0; r < STRIDE; r++) {
        double next[BG_Z];
        for (int i = 0; i < BATCH_POWERS; i++)
            if (r + 1 == 1 << i)
                memcpy(l->step[i], sum, sizeof sum);
        for (int j = 0; j < BG_Z; j++)
            add[j][r] = sum[j];
        memcpy(next, l->step[0], sizeof next);
        add_product(l->table.power[0], sum, next);
        memcpy(sum, next, sizeof sum);
    }
    fill_constants(l, add);
    memset(l->beyond, 0, sizeof l->beyond);
    l->done = 0;
    l->total = total;
}

/* A row in 1, 2, .. steps. */
static inline void reach(const batch_lanes *restrict lane, const double *restrict constant,
                         const double *restrict z, double *restrict to)
{
#pragma GCC unroll 1
    for (int r = 0; r < STRIDE; r++) {
        double sum = constant[r];
#pragma GCC unroll 32
        for (int j = 0; j < BG_Z; j++)
            sum += lane[j][r] * z[j];
        to[r] = sum;
    }
}

/* Lessens `least` to the least Bernstein coefficient of each step, less the slack. */
static inline void lessen(const double *restrict at, const double *restrict third, double slack,
                          double *restrict least)
{
    for (int r = 0; r < STRIDE; r++) {
        const double ends = bg_lesser(at[r], at[r + 1]);
        const double inner = bg_lesser(at[r] + third[r], at[r + 1] - third[r + 1]);
        least[r] = bg_lesser(least[r], bg_lesser(ends, inner) - slack);
    }
}

/* How many steps from here are certain. */
static inline int certain(batch_leaps *l, trail *at, const double *slack)
{
    static const trail level = {0};
    const unsigned caps = l->stretch->entry->caps;
    double least[STRIDE], folded[STRIDE];
    for (int r = 0; r < STRIDE; r++)
        least[r] = DBL_MAX;
    for (int i = 0; i < BG_T; i++) {
        const int cap = caps >> i & 1u, third = BG_T + i;
        reach(l->table.lane[i], l->room->constants[i], l->beyond, at[i] + 1);
        if (!cap)
            reach(l->table.lane[third], l->room->constants[third], l->beyond, at[third] + 1);
        lessen(at[i], cap ? level : at[third], slack[i], least);
    }
    memcpy(folded, least, sizeof folded);
    for (int n = STRIDE / 2; n > 0; n /= 2)
        for (int r = 0; r < n; r++)
            folded[r] = bg_lesser(folded[r], folded[r + n]);
    int sure = folded[0] > 0 ? STRIDE : 0;
    while (sure < STRIDE && least[sure] > 0)
        sure++;
    return sure;
}

/* Samples among the steps from `done` on; sample `at` is where leaps began. */
static inline void write_signals(const batch_leaps *l, int at)
{
    const batch_room *const room = l->room;
    const int parts = l->stretch->entry->parts;
    for (int s = 0; s < room->job->signals; s++) {
        double *const to = room->values + s * room->pitch + at;
        const batch_lanes *const lane = l->table.lane[BATCH_OWN + s];
        const double *const constant = room->constants[BATCH_OWN + s];
        double found[STRIDE];
        if (parts == 1) {
            reach(lane, constant, l->beyond, to + l->done + 1);
            continue;
        }
        reach(lane, constant, l->beyond, found);
        for (int k = parts - l->done % parts; k <= STRIDE; k += parts)
            if (l->done + k <= l->total)
                to[(l->done + k) / parts] = found[k - 1];
    }
}

/* The state itself, and the bounds that hold from here. */
static void renew(const batch_leaps *l, double *slack)
{
    double z[BG_Z];
    for (int j = 0; j < BG_Z; j++)
        z[j] = l->origin[j] + l->beyond[j];
    bg_uncertainty(l->stretch, z, slack);
}

void batch_leap(batch_leaps *l, int at)
{
    trail trails[BATCH_OWN > 0 ? BATCH_OWN : 1];
    double slack[BG_TRIGGERS] = {0};
    for (int i = 0; i < BATCH_OWN; i++) {
        trails[i][0] = l->origin[BG_Z + i];
        for (int j = 0; j < BG_Z; j++)
            trails[i][0] += l->table.row[i][j] * l->beyond[j];
    }
    for (int walked = 0; l->done < l->total; walked += STRIDE) {
        const int left = l->total - l->done, ahead = left < STRIDE ? left : STRIDE;
        if (walked % BG_RENEWAL == 0 && BG_K)
            renew(l, slack);
        const int found = BG_K ? certain(l, trails, slack) : STRIDE;
        const int sure = found < ahead ? found : ahead;
        write_signals(l, at);
        walk(l, sure);
        l->done += sure;
        if (found < ahead)
            return;
        for (int i = 0; i < BATCH_OWN; i++)
            trails[i][0] = trails[i][STRIDE];
    }
}
