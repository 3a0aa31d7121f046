/* What is kept of a run: numbers from its samples and events. */
#include "batch_internal.h"

#include <math.h>

static const batch_reader *reader_of(const batch_room *room, const batch_job *job, int sample,
                                     int signal)
{
    return room->readers + room->place[room->modes[sample]] * job->signals + signal;
}

/* The external inputs and their rates at every sample. */
static void find_given(batch_room *room, const batch_job *job, const bg_inputs *inputs)
{
    int segment = bg_segment(inputs, job->times[0]);
    double g[BG_G];
    for (int i = 0; i < job->samples; i++) {
        const double t = job->times[i];
        double *const w = room->given + 2 * BG_W * i;
        while (segment + 1 < inputs->segments && inputs->breaks[segment] <= t)
            segment++;
        bg_slots(inputs, segment, t, g);
        bg_given(inputs, segment, g, w, w + BG_W);
    }
}

static int needs_given(const batch_room *room, const batch_job *job)
{
    int driven = 0;
    for (int k = 0; k < room->made * job->signals; k++)
        driven |= room->readers[k].driven;
    return driven;
}

/* One signal at every sample. */
static void read_signal(batch_room *room, const batch_job *job, int signal)
{
    for (int i = 0; i < job->samples; i++) {
        const batch_reader *const reader = reader_of(room, job, i, signal);
        const double *const s = room->rows[i], *const w = room->given + 2 * BG_W * i;
        if (reader->column >= 0) {
            room->values[i] = s[reader->column];
            continue;
        }
        double sum = reader->row[BG_L - 1];
        for (int j = 0; j < BG_N; j++)
            sum += reader->row[j] * s[j];
        for (int j = 0; j < 2 * BG_W && reader->driven; j++)
            sum += reader->row[BG_N + j] * w[j];
        room->values[i] = sum;
    }
}

static double integral(const batch_job *job, const double *values)
{
    double sum = 0.0;
    for (int i = 1; i < job->samples; i++)
        sum += (job->times[i] - job->times[i - 1]) * (values[i] + values[i - 1]);
    return sum / 2;
}

static double extreme(const batch_job *job, const double *values, int what)
{
    double high = values[0], low = values[0];
    for (int i = 1; i < job->samples; i++) {
        high = bg_greater(values[i], high);
        low = bg_lesser(values[i], low);
    }
    if (what == BATCH_PEAK)
        return bg_greater(fabs(high), fabs(low));
    return what == BATCH_LARGEST ? high : low;
}

static double of_events(const bg_task *task, const batch_measure *measure)
{
    int count = 0;
    for (int i = 0; i < task->count; i++) {
        if (task->events[i].port != measure->port || task->events[i].kind != measure->kind)
            continue;
        if (measure->what == BATCH_FIRST)
            return task->events[i].time;
        count++;
    }
    return measure->what == BATCH_FIRST ? NAN : count;
}

static void keep(const batch_job *job, const double *values, const batch_measure *measure,
                 double *results)
{
    double *const found = results + measure->at;
    if (measure->what == BATCH_FINAL)
        *found = values[job->samples - 1];
    else if (measure->what == BATCH_INTEGRAL)
        *found = integral(job, values);
    else if (measure->what == BATCH_SAMPLES)
        for (int i = 0; i < job->samples; i++)
            found[i] = values[i];
    else
        *found = extreme(job, values, measure->what);
}

void batch_reduce(batch_room *room, const batch_job *job, const bg_inputs *inputs,
                  const bg_task *task, double *results)
{
    if (needs_given(room, job))
        find_given(room, job, inputs);
    for (int signal = 0; signal < job->signals; signal++) {
        read_signal(room, job, signal);
        for (int k = 0; k < job->measures; k++)
            if (job->measure[k].what < BATCH_FIRST && job->measure[k].signal == signal)
                keep(job, room->values, job->measure + k, results);
    }
    for (int k = 0; k < job->measures; k++)
        if (job->measure[k].what >= BATCH_FIRST)
            results[job->measure[k].at] = of_events(task, job->measure + k);
}
