/* Many runs of one model, each with its own numbers, reduced to measures.
 *
 * config.h has the sizes of the engine beside those of the model.
 *
 * Nothing is allocated and nothing is global: the caller owns a room for each thread. */
#ifndef BATCH_H
#define BATCH_H

#include "exact.h"

#include "batch_measure.h"

enum {
    BATCH_STRIDE = 8, /* so many steps are taken from one state */
    BATCH_SQUARES = 4
};

/* What each run has of its own; `results` has `width` places for each, `moved` one for each state:
 * what a start that was completed gained. */
typedef struct {
    int runs;
    const double *parameters, *states;
    const ex_inputs *const *inputs;
    double *results, *moved;
    int *status;
} batch_runs;

typedef double batch_lanes[BATCH_STRIDE];

/* Where runs are done, one at a time. The caller gives what is pointed to: `readers` for EX_MODES
 * times the signals, over (s, w, w', 1); `tables` as `batch_sizes` tells; `values` for the signals
 * times `pitch`, which is BATCH_STRIDE more than the samples; `levels` for the
 * signals; `constants` for 4 EX_K and the signals; `totals` for the products; and `squares` for
 * BATCH_SQUARES times (EX_Z + 1)^2, if there are products. Readers are of signals and factors.
 * The modes that were asked for last are kept: the record points to `known`, `keys` and `used`. */
typedef struct {
    ex_context *context;
    void *model;
    const batch_job *job;
    bg_event *events;
    double (*readers)[EX_L];
    double *tables, *values, *levels, *totals, *squares;
    batch_lanes *constants;
    int capacity, pitch;
    ex_model record;
    unsigned long long used[EX_MODES];
    ex_key keys[EX_MODES];
    const ex_mode *known[EX_MODES];
    ex_mode mode[EX_MODES];
} batch_room;

/* The sizes of a room and an instance of the model, in bytes; those of a table, in doubles, without
 * signals and of each signal, and how many tables there are. */
void batch_sizes(unsigned long *sizes);

/* Does every run; a status for each. */
void batch_run(batch_room *room, const batch_job *job, const batch_runs *runs);

#endif
