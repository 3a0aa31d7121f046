/* Many runs, one after the other: bind parameters, run, reduce. */
#include "batch_internal.h"

#include <string.h>

void batch_sizes(unsigned long *sizes)
{
    const unsigned long row = EX_Z * (1 + BATCH_STRIDE);
    sizes[0] = (unsigned long)sizeof(batch_room);
    sizes[1] = (unsigned long)sizeof(batch_instance);
    sizes[2] = BATCH_POWERS * EX_Z * EX_Z + BATCH_OWN * row;
    sizes[3] = row;
    sizes[4] = EX_ENTRIES;
}

/* The integrated vector at the start, what it gained as it was completed, and the mode before it;
 * a status. */
static int start_of(const batch_room *room, const ex_inputs *inputs, const double *states,
                    int *mode, double *s, double *moved)
{
    const double t = room->job->times[0];
    double g[EX_G], w[2 * EX_W];
    bg_span span;
    if (ex_span(inputs, t, &span))
        return BG_NOT_AFFINE;
    ex_slots(inputs, span.segment, t, g);
    ex_given(inputs, span.segment, g, w, w + EX_W);
    batch_instance *const own = room->model;
    for (int i = 0; i < EX_K; i++)
        mode[i] = room->job->first[i];
    if (bg_model_vector(&own->m, t, states, w, s))
        return BG_REFUSED;
    for (int i = 0; i < EX_N; i++)
        moved[i] = -s[i];
    const int status = bg_complete(&own->m, t, w, room->job->named, mode, s);
    for (int i = 0; i < EX_N; i++)
        moved[i] += s[i];
    return status ? BG_REFUSED : BG_OK;
}

/* Binds parameters; a status. */
static int bind(batch_room *room, const double *parameters)
{
    batch_instance *const own = room->model;
    ex_model *const record = &room->record;
    if (batch_model_begin(own, parameters))
        return BG_REFUSED;
    memset(record, 0, sizeof *record);
    record->keys = room->keys;
    record->modes = room->known;
    record->used = room->used;
    record->supply = batch_supply;
    record->self = room;
    bg_measure(&own->m.numbers, &(bg_magnitudes){record->F[0], record->D[0], record->FP[0],
                                                 record->FQ[0], record->P[0], record->Q[0],
                                                 record->inertia});
    memcpy(record->coupled, bg_beside, sizeof(int) * EX_K);
    memcpy(record->own, bg_friction_inputs, sizeof(int) * EX_K);
    record->switched = BG_SWITCHES > 0;
    record->hung = BG_HUNG;
    memcpy(record->switches, bg_switches, sizeof *bg_switches * EX_K);
    memcpy(record->resets, bg_resets, sizeof *bg_resets * BG_RESETS);
    memcpy(record->clocks, bg_clocks, sizeof *bg_clocks * BG_CLOCKS);
    batch_fill_stops(record, &own->m);
    ex_forget(room->context);
    return BG_OK;
}

/* One run, modes worked out as it asks for them; a status. */
static int run(batch_room *room, const ex_inputs *inputs, const double *states, double *results,
               double *moved)
{
    double start[EX_N];
    int first[BG_MOST_PORTS] = {0};
    ex_task task = {
        .times = room->job->times, .samples = room->job->samples, .grid = room->job->grid,
        .start = start, .events = room->events, .capacity = room->capacity, .first = first,
    };
    int status = start_of(room, inputs, states, first, start, moved);
    if (status)
        return status;
    for (int k = 0; k < room->job->products; k++)
        room->totals[k] = 0.0;
    status = ex_run_by(room->context, &room->record, inputs, &task, batch_advance, room);
    if (status)
        return status == BG_MISSING ? BG_NOT_AFFINE : status;
    batch_sample_last(room->context, room);
    return batch_reduce(room->job, room->values, room->pitch, room->totals, task.events, task.count,
                        results)
               ? BG_OK
               : BG_NOT_FINITE;
}

void batch_run(batch_room *room, const batch_job *job, const batch_runs *runs)
{
    const double *bound = 0;
    int refused = 0;
    room->job = job;
    for (int k = 0; k < runs->runs; k++) {
        const double *const own = runs->parameters + (long)k * BG_PARAMETERS;
        if (!bound || memcmp(bound, own, sizeof(double) * BG_PARAMETERS) != 0)
            refused = bind(room, own);
        bound = own;
        runs->status[k] = refused ? refused
                                  : run(room, runs->inputs[k], runs->states + k * EX_N,
                                        runs->results + (long)k * job->width,
                                        runs->moved + (long)k * EX_N);
    }
}
