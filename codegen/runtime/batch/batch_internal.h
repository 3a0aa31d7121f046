/* What the files of the batch share. */
#ifndef BATCH_INTERNAL_H
#define BATCH_INTERNAL_H

#include "batch.h"
#include "batch_model.h"
#include "exact_internal.h"
#include "port_sight.h"

enum {
    /* rows that are followed: triggers, thirds of their changes in a step, then signals */
    BATCH_OWN = 2 * EX_T,
    BATCH_POWERS = 4 /* two to the power of 0 .. 3 is the stride */
};

/* One mode and generator in steps of one length. */
typedef struct {
    double (*power)[EX_Z][EX_Z]; /* exp(M h) to the powers of 1, 2, 4, .., by columns */
    double (*row)[EX_Z];         /* of what is followed, over the state */
    batch_lanes (*lane)[EX_Z];   /* the same 1, 2, 3, .. steps later */
} batch_table;

/* Leaps of one stretch: `beyond` is the state less the origin, `step` what 1, 2, 4, .. steps add. */
typedef struct {
    const batch_room *room;
    const ex_stretch *stretch;
    batch_table table;
    double origin[EX_ROW], beyond[EX_Z], step[BATCH_POWERS][EX_Z];
    long long done, total;
} batch_leaps;

/* batch_mode.c: works out the engine's record of a mode, in place of that which was asked for longest
 * ago where there is no more room; a status. */
int batch_supply(void *room, const int *mode);

/* What an affine map over fewer inputs has in a column of the engine's maps; -1 for none. */
static inline int batch_column_of(int j)
{
    if (j < EX_N)
        return j;
    if (j == EX_L - 1)
        return BG_MAP_COLUMNS - 1;
    const int rate = j >= EX_N + EX_W, input = (j - EX_N) % EX_W;
    return input < BG_EXTERNAL ? EX_N + rate * BG_EXTERNAL + input : -1;
}

/* batch_mode_switches.c: what keeps switches, and where friction slips forwards what they do as they
 * come to hold; gaps and restitutions of stops. */
void batch_fill_stops(ex_model *record, bg_model *m);
void batch_fill_switches(ex_mode *made, const double *map, bg_model *m, const int *mode);

/* batch_fastest.c: the largest magnitude of an eigenvalue, nearly, and one over the scales that balance
 * the rates, which are scaled so. */
double batch_fastest(double (*own)[EX_N], double *weight);

/* batch_signal.c: signals in the present stretch as rows over its state, with their constant parts;
 * one sample of all, of a stretch's state, and of the state at the end of a run. */
void batch_show(const ex_context *c, const batch_room *room, const batch_table *table);
void batch_sample(const batch_room *room, const batch_table *table, const double *z, int at);
void batch_sample_last(ex_context *c, const batch_room *room);

/* Where the readers of a mode begin: rows of signals and factors over (s, w, w', 1). */
static inline double (*batch_readers(const batch_room *room, const ex_mode *mode))[EX_L]
{
    return room->readers + (mode - room->mode) * (room->job->signals + room->job->factors);
}

/* batch_signal.c: a row over the state of the present stretch; its constant part. */
double batch_over_state(const ex_context *c, const double *reader, double *row);

/* batch_integral.c: adds to the totals what products make from t, where the state is z, to `end`. */
void batch_integrate(const ex_context *c, const batch_room *room, double t, const double *z,
                     double end);

/* batch_table.c: the table of an entry, and what it holds for steps of h. */
batch_table batch_table_of(const batch_room *room, const ex_context *c);
void batch_prepare(ex_context *c, const batch_room *room, const batch_table *table, double h);

/* batch_leap.c: from a state on; steps that are certain to be without an event, signals written. */
void batch_begin_leaps(batch_leaps *l, const double *z, long long total);
void batch_leap(batch_leaps *l, int at);

/* batch_advance.c: to `stop` or the first event. */
int batch_advance(ex_context *c, double stop);

#endif
