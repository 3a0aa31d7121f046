/* Many runs, one after the other: bind parameters, run, reduce. */
#include "batch_internal.h"

#include <string.h>

void batch_sizes(unsigned long *sizes)
{
    sizes[0] = (unsigned long)sizeof(batch_room);
    sizes[1] = (unsigned long)sizeof(batch_reader);
    sizes[2] = batch_model_size();
}

/* The integrated vector at the start; a status. */
static int start_of(const batch_room *room, const batch_job *job, const bg_inputs *inputs,
                    const double *states, double *s)
{
    const double t = job->times[0];
    const int segment = bg_segment(inputs, t);
    double g[BG_G], w[2 * BG_W];
    bg_slots(inputs, segment, t, g);
    bg_given(inputs, segment, g, w, w + BG_W);
    return batch_model_start(room->model, t, states, w, s) ? BATCH_REFUSED : BG_OK;
}

/* One run, modes supplied as it asks for them, which begins it again: those of the run before
 * first; a status. */
static int one(batch_room *room, const batch_job *job, const batch_numbers *numbers,
               const bg_inputs *inputs, bg_task *task)
{
    const int expected = room->made;
    int status = BG_MISSING, likely[BATCH_MODES];
    memcpy(likely, room->number, sizeof likely);
    room->made = 0;
    for (int k = 0; k < expected; k++)
        batch_supply(room, job, numbers, likely[k]);
    while (status == BG_MISSING) {
        status = bg_run(room->context, &room->record, inputs, task);
        if (status == BG_MISSING && batch_supply(room, job, numbers, task->where))
            return BG_UNSUPPORTED;
    }
    return status;
}

static int run(batch_room *room, const batch_job *job, const batch_runs *runs, int k)
{
    const bg_inputs *const inputs = runs->inputs[k];
    batch_numbers numbers;
    double start[BG_N];
    bg_task task = {0};
    if (batch_model_begin(room->model, runs->parameters + k * BATCH_PARAMETERS, &numbers))
        return BATCH_REFUSED;
    batch_magnitudes(&room->record, &numbers);
    bg_forget(room->context);
    int status = start_of(room, job, inputs, runs->states + k * BG_N, start);
    task.times = job->times;
    task.samples = job->samples;
    task.grid = job->grid;
    task.start = start;
    task.rows = room->rows;
    task.modes = room->modes;
    task.events = room->events;
    task.capacity = room->capacity;
    if (status == BG_OK)
        status = one(room, job, &numbers, inputs, &task);
    if (status == BG_OK)
        batch_reduce(room, job, inputs, &task, runs->results + (long)k * job->width);
    return status;
}

void batch_run(batch_room *room, const batch_job *job, const batch_runs *runs)
{
    for (int k = 0; k < runs->runs; k++)
        runs->status[k] = run(room, job, runs, k);
}
