/* What the files of the batch share. */
#ifndef BATCH_INTERNAL_H
#define BATCH_INTERNAL_H

#include "batch.h"
#include "batch_model.h"
#include "bg_internal.h"

enum {
    BATCH_COLUMNS = BG_N + 2 * BATCH_EXTERNAL + 1,
    /* where the parts of an affine map begin */
    BATCH_AT_U = BATCH_STATES + BATCH_LAW_STATES,
    BATCH_AT_Y = BATCH_AT_U + 2 * BATCH_INPUTS,
    BATCH_AT_RATE = BATCH_AT_Y + BATCH_READINGS,
    BATCH_AT_CAP = BATCH_AT_RATE + BG_N,
    BATCH_ROWS = BATCH_AT_CAP + BG_K,
    /* rows that are followed: triggers, thirds of their changes in a step, then signals */
    BATCH_OWN = 2 * BG_T,
    BATCH_POWERS = 4 /* two to the power of 0 .. 3 is the stride */
};

/* One mode and generator in steps of one length. */
typedef struct {
    double (*power)[BG_Z][BG_Z]; /* exp(M h) to the powers of 1, 2, 4, .., by columns */
    double (*row)[BG_Z];         /* of what is followed, over the state */
    batch_lanes (*lane)[BG_Z];   /* the same 1, 2, 3, .. steps later */
} batch_table;

/* Leaps of one stretch: `beyond` is the state less the origin, `step` what 1, 2, 4, .. steps add. */
typedef struct {
    const batch_room *room;
    const bg_stretch *stretch;
    batch_table table;
    double origin[BG_ROW], beyond[BG_Z], step[BATCH_POWERS][BG_Z];
    long long done, total;
} batch_leaps;

/* batch_mode.c: the engine's records of a model, and of one of its modes; a status. */
void batch_magnitudes(bg_model *record, const batch_numbers *numbers);
int batch_supply(batch_room *room, const batch_numbers *numbers, int number);

/* batch_signal.c: signals in the present stretch as rows over its state, with their constant parts;
 * one sample of all, of a stretch's state, and of the state at the end of a run. */
void batch_show(const bg_context *c, const batch_room *room, const batch_table *table);
void batch_sample(const batch_room *room, const batch_table *table, const double *z, int at);
void batch_sample_last(bg_context *c, const batch_room *room);

/* Where the readers of a mode begin: rows of signals and factors over (s, w, w', 1). */
static inline double (*batch_readers(const batch_room *room, int place))[BG_L]
{
    return room->readers + place * (room->job->signals + room->job->factors);
}

/* batch_signal.c: a row over the state of the present stretch; its constant part. */
double batch_over_state(const bg_context *c, const double *reader, double *row);

/* batch_integral.c: adds to the totals what products make from t, where the state is z, to `end`. */
void batch_integrate(const bg_context *c, const batch_room *room, double t, const double *z,
                     double end);

/* batch_table.c: the table of an entry, and what it holds for steps of h. */
batch_table batch_table_of(const batch_room *room, const bg_context *c);
void batch_prepare(bg_context *c, const batch_room *room, const batch_table *table, double h);

/* batch_leap.c: from a state on; steps that are certain to be without an event, signals written. */
void batch_begin_leaps(batch_leaps *l, const double *z, long long total);
void batch_leap(batch_leaps *l, int at);

/* batch_advance.c: to `stop` or the first event. */
int batch_advance(bg_context *c, int *at, double stop);

#endif
