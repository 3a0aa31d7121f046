/* Many runs, one after the other: bind parameters, run, reduce. */
#include "batch_internal.h"

#include <string.h>

void batch_sizes(unsigned long *sizes)
{
    const unsigned long row = BG_Z * (1 + BATCH_STRIDE);
    sizes[0] = (unsigned long)sizeof(batch_room);
    sizes[1] = batch_model_size();
    sizes[2] = BATCH_POWERS * BG_Z * BG_Z + BATCH_OWN * row;
    sizes[3] = row;
    sizes[4] = BG_ENTRIES;
}

/* The integrated vector at the start; a status. */
static int start_of(const batch_room *room, const bg_inputs *inputs, const double *states,
                    double *s)
{
    const double t = room->job->times[0];
    const int segment = bg_segment(inputs, t);
    double g[BG_G], w[2 * BG_W];
    bg_slots(inputs, segment, t, g);
    bg_given(inputs, segment, g, w, w + BG_W);
    return batch_model_start(room->model, t, states, w, s) ? BATCH_REFUSED : BG_OK;
}

/* Binds parameters. The modes that the run before needed are worked out at once; a status. */
static int bind(batch_room *room, const double *parameters, batch_numbers *numbers)
{
    const int expected = room->made;
    int likely[BATCH_MODES];
    memcpy(likely, room->number, sizeof likely);
    room->made = 0;
    if (batch_model_begin(room->model, parameters, numbers))
        return BATCH_REFUSED;
    batch_magnitudes(&room->record, numbers);
    bg_forget(room->context);
    for (int k = 0; k < expected; k++)
        batch_supply(room, numbers, likely[k]);
    return BG_OK;
}

/* One run, modes supplied as it asks for them, which begins it again; a status. */
static int run(batch_room *room, const batch_numbers *numbers, const bg_inputs *inputs,
               const double *states, double *results)
{
    double start[BG_N];
    bg_task task = {
        .times = room->job->times, .samples = room->job->samples, .grid = room->job->grid,
        .start = start, .events = room->events, .capacity = room->capacity,
    };
    int status = start_of(room, inputs, states, start);
    if (status)
        return status;
    status = BG_MISSING;
    while (status == BG_MISSING) {
        for (int k = 0; k < room->job->products; k++)
            room->totals[k] = 0.0;
        status = bg_run_by(room->context, &room->record, inputs, &task, batch_advance, room);
        if (status == BG_MISSING && batch_supply(room, numbers, task.where))
            return BG_UNSUPPORTED;
    }
    if (status)
        return status;
    batch_sample_last(room->context, room);
    return batch_reduce(room->job, room->values, room->pitch, room->totals, task.events, task.count,
                        results)
               ? BG_OK
               : BG_UNUSABLE;
}

void batch_run(batch_room *room, const batch_job *job, const batch_runs *runs)
{
    const double *bound = 0;
    batch_numbers numbers;
    int refused = 0;
    room->job = job;
    for (int k = 0; k < runs->runs; k++) {
        const double *const own = runs->parameters + (long)k * BATCH_PARAMETERS;
        if (!bound || memcmp(bound, own, sizeof(double) * BATCH_PARAMETERS) != 0)
            refused = bind(room, own, &numbers);
        bound = own;
        runs->status[k] = refused ? refused
                                  : run(room, &numbers, runs->inputs[k], runs->states + k * BG_N,
                                        runs->results + (long)k * job->width);
    }
}
