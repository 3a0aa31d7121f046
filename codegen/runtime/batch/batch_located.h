/* Many event-located runs of one model, each with its own numbers, reduced to measures. Nothing is
 * allocated and nothing is global: the caller owns a room for each thread. */
#ifndef BATCH_LOCATED_H
#define BATCH_LOCATED_H

#include "batch_measure.h"
#include "model_located.h"

/* What each run has of its own; `results` has places for each as the job tells, `moved` one for each
 * state, law states last: what a start that was completed gained. */
typedef struct {
    int runs;
    const double *parameters, *states;
    const bg_signals *const *inputs;
    double *results, *moved;
    int *status;
} located_runs;

/* Where runs are done, one at a time, and how. `values`: the signals times the samples; `totals`: of
 * the products; `corners`: whether those of laws are events. */
typedef struct {
    bg_model *model;
    bg_located *run;
    const batch_job *job;
    bg_event *events;
    double *values, *totals, rtol, atol;
    int capacity, method, corners;
} located_room;

/* The parts of a run: what it is asked, and its model; its measures, once it is done. All of it. Each
 * gives a status. */
int located_begin(located_room *room, const batch_job *job, const located_runs *runs, int run,
                  bg_request *asked);
int located_reduce(const located_room *room, const located_runs *runs, int run,
                   const bg_request *asked);
int located_alone(located_room *room, const batch_job *job, const located_runs *runs, int run);

/* Does every run; a status for each, nonzero where it has to be done another way. */
void located_batch(located_room *room, const batch_job *job, const located_runs *runs);

#endif
