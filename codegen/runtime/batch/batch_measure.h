/* What is kept of each of many runs: numbers from its samples and events, and integrals. */
#ifndef BATCH_MEASURE_H
#define BATCH_MEASURE_H

#include "port_events.h"

enum batch_what {
    BATCH_PEAK, BATCH_LARGEST, BATCH_SMALLEST, BATCH_START, BATCH_FINAL, BATCH_SAMPLES, BATCH_TOTAL,
    BATCH_FIRST_EVENT, BATCH_EVENT_COUNT
};

/* What to keep of a run, from place `at` of its results: of a signal, a product or events. */
typedef struct {
    int what, signal, port, kind, at;
} batch_measure;

/* Two factors, by their order, whose product is integrated through a run; -1 for one alone. */
typedef struct {
    int one, other;
} batch_product;

/* What runs share. `signal`: which ones are followed, then the factors of products, by their place in
 * x, z, u, u' (none is), y, or -1 - j for the external input j. `grid`: the distance of the samples if
 * all are alike, else 0. A run's results have `width` places. */
typedef struct {
    const double *times;
    const int *first, *named; /* a mode for each port before a run; whether each state is named */
    double grid;
    int samples, width, signals, factors, products, measures;
    const int *signal;
    const batch_product *product;
    const batch_measure *measure;
} batch_job;

/* A run's measures. `values`: each followed signal at every sample, `pitch` after the one before;
 * `totals`: the integrals of the products. Whether all are finite, but for times of what never
 * happened. */
int batch_reduce(const batch_job *job, const double *values, int pitch, const double *totals,
                 const bg_event *events, int count, double *results);

#endif
