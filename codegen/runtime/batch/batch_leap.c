/* Steps of one length, eight at a time from one state, of which only what is followed is computed:
 * triggers with their slopes, signals, and the state at the end. The test is that of exact_leap.c. */
#include "batch_internal.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { STRIDE = BATCH_STRIDE };

/* What is followed now, and in 1, 2, .. steps: triggers, then thirds of their changes in a step. */
typedef struct {
    double now[BATCH_OWN > 0 ? BATCH_OWN : 1];
    batch_lanes then[BATCH_OWN > 0 ? BATCH_OWN : 1];
} trail;

/* to = add + P z, by columns; in two sums that don't wait for each other. */
static inline void moved_by(const double (*restrict P)[EX_Z], const double *restrict add,
                          const double *restrict z, double *restrict to)
{
#pragma GCC unroll 1
    for (int i = 0; i < EX_Z; i++) {
        double sum = add[i], other = 0.0;
#pragma GCC unroll 32
        for (int j = 0; j < EX_Z / 2; j++)
            sum += P[j][i] * z[j];
#pragma GCC unroll 32
        for (int j = EX_Z / 2; j < EX_Z; j++)
            other += P[j][i] * z[j];
        to[i] = sum + other;
    }
}

/* `count` steps of the state, fewer than twice the stride. */
static inline void step_by(batch_leaps *l, int count)
{
    for (int i = BATCH_POWERS - 1; i >= 0; i--)
        if (count >> i & 1) {
            double next[EX_Z];
            moved_by((const double(*)[EX_Z])l->table.power[i], l->step[i], l->beyond, next);
            memcpy(l->beyond, next, sizeof next);
        }
}

static double at_origin(const batch_leaps *l, int row)
{
    if (row < BATCH_OWN)
        return l->origin[EX_Z + row];
    double sum = l->room->levels[row - BATCH_OWN];
    for (int j = 0; j < EX_Z; j++)
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
        for (int j = 0; j < EX_Z; j++)
            for (int r = 0; r < STRIDE; r++)
                to[r] += l->table.row[i][j] * add[j][r];
    }
}

void batch_begin_leaps(batch_leaps *l, const double *z, long long total)
{
    const ex_entry *const e = l->stretch->entry;
    const double none[EX_Z] = {0};
    double rate[EX_Z], add[EX_Z][STRIDE], sum[EX_Z];
    memcpy(l->origin, z, sizeof rate);
    ex_fill(l->stretch, l->origin);
    moved_by((const double(*)[EX_Z])e->M, l->stretch->b, z, rate);
    moved_by((const double(*)[EX_Z])e->gather, none, rate, sum);
    for (int r = 0; r < STRIDE; r++) {
        double next[EX_Z];
        for (int i = 0; i < BATCH_POWERS; i++)
            if (r + 1 == 1 << i)
                memcpy(l->step[i], sum, sizeof sum);
        for (int j = 0; j < EX_Z; j++)
            add[j][r] = sum[j];
        moved_by((const double(*)[EX_Z])l->table.power[0], l->step[0], sum, next);
        memcpy(sum, next, sizeof sum);
    }
    fill_constants(l, add);
    memset(l->beyond, 0, sizeof l->beyond);
    l->done = 0;
    l->total = total;
}

/* A row in 1, 2, .. steps. */
static inline void reach(batch_lanes *restrict lane, const double *restrict constant,
                         const double *restrict z, double *restrict to)
{
#pragma GCC unroll 1
    for (int r = 0; r < STRIDE; r++) {
        double sum = constant[r];
#pragma GCC unroll 32
        for (int j = 0; j < EX_Z; j++)
            sum += lane[j][r] * z[j];
        to[r] = sum;
    }
}

/* Whether a step is certain: all Bernstein coefficients of its triggers are above the slack. */
static int is_certain(const trail *at, const int *caps, const double *slack, int r)
{
    for (int i = 0; i < EX_T; i++) {
        const int cap = caps[i], third = EX_T + i;
        const double begin = r ? at->then[i][r - 1] : at->now[i], end = at->then[i][r];
        const double leaves = r ? at->then[third][r - 1] : at->now[third];
        const double inner = cap ? end : bg_lesser(begin + leaves, end - at->then[third][r]);
        if (!(bg_lesser(bg_lesser(begin, end), inner) > slack[i]))
            return 0;
    }
    return 1;
}

/* How many steps from here are certain. All are where every trigger is farther from its slack than
 * a third of its change; only otherwise steps are looked at one by one. */
static inline int how_certain(batch_leaps *l, trail *at, const double *slack)
{
    const int *const caps = l->stretch->entry->cap;
    double least[STRIDE], first = DBL_MAX;
    int sure = 0;
    for (int r = 0; r < STRIDE; r++)
        least[r] = DBL_MAX;
    for (int i = 0; i < EX_T; i++) {
        const int cap = caps[i], third = EX_T + i;
        reach(l->table.lane[i], l->room->constants[i], l->beyond, at->then[i]);
        if (!cap)
            reach(l->table.lane[third], l->room->constants[third], l->beyond, at->then[third]);
        first = bg_lesser(first, at->now[i] - fabs(at->now[third]) - slack[i]);
#pragma GCC unroll 1
        for (int r = 0; r < STRIDE; r++) {
            const double sized = at->then[i][r] - fabs(at->then[third][r]) - slack[i];
            least[r] = bg_lesser(least[r], sized);
        }
    }
    for (int r = 0; r < STRIDE / 2; r++)
        least[r] = bg_lesser(least[r], least[r + STRIDE / 2]);
    for (int r = 0; r < STRIDE / 2; r++)
        first = bg_lesser(first, least[r]);
    if (first > 0)
        return STRIDE;
    while (sure < STRIDE && is_certain(at, caps, slack, sure))
        sure++;
    return sure;
}

/* Samples among the steps from `done` on; sample `at` is where leaps began. */
static inline void write_signals(const batch_leaps *l, int at)
{
    const batch_room *const room = l->room;
    const long long parts = l->stretch->entry->parts;
    for (int s = 0; s < room->job->signals; s++) {
        double *const to = room->values + s * room->pitch + at;
        batch_lanes *const lane = l->table.lane[BATCH_OWN + s];
        const double *const constant = room->constants[BATCH_OWN + s];
        double found[STRIDE];
        if (parts == 1) {
            reach(lane, constant, l->beyond, to + l->done + 1);
            continue;
        }
        reach(lane, constant, l->beyond, found);
        for (long long k = parts - l->done % parts; k <= STRIDE; k += parts)
            if (l->done + k <= l->total)
                to[(l->done + k) / parts] = found[k - 1];
    }
}

/* The state itself, and the bounds that hold from here. */
static void renew(const batch_leaps *l, double *slack)
{
    double z[EX_Z];
    for (int j = 0; j < EX_Z; j++)
        z[j] = l->origin[j] + l->beyond[j];
    ex_uncertainty(l->stretch, z, slack);
}

void batch_leap(batch_leaps *l, int at)
{
    trail found;
    double slack[EX_TRIGGERS] = {0};
    memset(&found, 0, sizeof found);
    for (int i = 0; i < BATCH_OWN; i++) {
        found.now[i] = l->origin[EX_Z + i];
        for (int j = 0; j < EX_Z; j++)
            found.now[i] += l->table.row[i][j] * l->beyond[j];
    }
    for (long long walked = 0; l->done < l->total; walked += STRIDE) {
        const long long left = l->total - l->done;
        const int ahead = left < STRIDE ? (int)left : STRIDE;
        if (walked % EX_RENEWAL == 0 && EX_K)
            renew(l, slack);
        const int certainly = EX_K ? how_certain(l, &found, slack) : STRIDE;
        const int sure = certainly < ahead ? certainly : ahead;
        write_signals(l, at);
        step_by(l, sure);
        l->done += sure;
        if (certainly < ahead)
            return;
        for (int i = 0; i < BATCH_OWN; i++)
            found.now[i] = found.then[i][STRIDE - 1];
    }
}
