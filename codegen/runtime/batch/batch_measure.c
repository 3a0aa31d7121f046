/* What is kept of a run: numbers from its samples and events, and integrals. */
#include "batch_measure.h"

#include <math.h>

#include "run_extremes.h"

enum { LANES = 8 };

/* In lanes, which do not wait for each other. */
static double extreme(const batch_job *job, const double *values, int what)
{
    double high[LANES], low[LANES];
    int i = 0;
    for (int r = 0; r < LANES; r++)
        high[r] = low[r] = values[0];
    for (; i + LANES <= job->samples; i += LANES)
        for (int r = 0; r < LANES; r++) {
            high[r] = bg_greater(values[i + r], high[r]);
            low[r] = bg_lesser(values[i + r], low[r]);
        }
    for (; i < job->samples; i++) {
        high[0] = bg_greater(values[i], high[0]);
        low[0] = bg_lesser(values[i], low[0]);
    }
    for (int r = 1; r < LANES; r++) {
        high[0] = bg_greater(high[r], high[0]);
        low[0] = bg_lesser(low[r], low[0]);
    }
    if (what == BATCH_PEAK)
        return bg_greater(fabs(high[0]), fabs(low[0]));
    return what == BATCH_LARGEST ? high[0] : low[0];
}

static double of_events(const bg_event *events, int count, const batch_measure *measure)
{
    int found = 0;
    for (int i = 0; i < count; i++) {
        if (events[i].port != measure->port || events[i].kind != measure->kind)
            continue;
        if (measure->what == BATCH_FIRST_EVENT)
            return events[i].time;
        found++;
    }
    return measure->what == BATCH_FIRST_EVENT ? (double)NAN : (double)found;
}

static void keep_measure(const batch_job *job, const double *values, const batch_measure *measure,
                 double *results)
{
    double *const found = results + measure->at;
    if (measure->what == BATCH_FINAL)
        *found = values[job->samples - 1];
    else if (measure->what == BATCH_START)
        *found = values[0];
    else if (measure->what == BATCH_SAMPLES)
        for (int i = 0; i < job->samples; i++)
            found[i] = values[i];
    else
        *found = extreme(job, values, measure->what);
}

/* Whether what a measure has found is finite; what never happened has no time. */
static int is_finite(const batch_job *job, const batch_measure *measure, const double *found)
{
    const int length = measure->what == BATCH_SAMPLES ? job->samples : 1;
    int all = 1;
    for (int i = 0; i < length; i++)
        all &= isfinite(found[i]) || measure->what == BATCH_FIRST_EVENT;
    return all;
}

int batch_reduce(const batch_job *job, const double *values, int pitch, const double *totals,
                 const bg_event *events, int count, double *results)
{
    int all = 1;
    for (int k = 0; k < job->measures; k++) {
        const batch_measure *const measure = job->measure + k;
        if (measure->what >= BATCH_FIRST_EVENT)
            results[measure->at] = of_events(events, count, measure);
        else if (measure->what == BATCH_TOTAL)
            results[measure->at] = totals[measure->signal];
        else
            keep_measure(job, values + (long)measure->signal * pitch, measure, results);
        all &= is_finite(job, measure, results + measure->at);
    }
    return all;
}
