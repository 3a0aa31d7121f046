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
    BATCH_ROWS = BATCH_AT_CAP + BG_K
};

/* batch_mode.c: the engine's records of a model, and of one of its modes; a status. */
void batch_magnitudes(bg_model *record, const batch_numbers *numbers);
int batch_supply(batch_room *room, const batch_job *job, const batch_numbers *numbers, int number);

/* batch_measure.c: what is kept of a run that is done. */
void batch_reduce(batch_room *room, const batch_job *job, const bg_inputs *inputs,
                  const bg_task *task, double *results);

#endif
