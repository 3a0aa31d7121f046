/* What is kept of each of many runs: numbers from its samples and events. */
#ifndef BATCH_MEASURE_H
#define BATCH_MEASURE_H

#include "bg_events.h"

enum batch_what {
    BATCH_PEAK, BATCH_LARGEST, BATCH_SMALLEST, BATCH_FINAL, BATCH_INTEGRAL, BATCH_SAMPLES,
    BATCH_FIRST, BATCH_COUNT
};

/* What to keep of a run, from place `at` of its results: of a signal, or of events. */
typedef struct {
    int what, signal, port, kind, at;
} batch_measure;

/* What runs share. `signal`: which ones are followed, by their place in x, z, u, u' (none is), y, or
 * -1 - j for the external input j. `grid`: the distance of the samples if all are alike, else 0. A run's
 * results have `width` places. */
typedef struct {
    const double *times;
    double grid;
    int samples, width, signals, measures;
    const int *signal;
    const batch_measure *measure;
} batch_job;

/* A run's measures. `values`: each followed signal at every sample, `pitch` after the one before.
 * Whether all are finite, but for times of what never happened. */
int batch_reduce(const batch_job *job, const double *values, int pitch, const bg_event *events,
                 int count, double *results);

#endif
