/* Many event-located runs, one after the other: init, run, reduce. */
#include "batch_located.h"

#include "batch_doubt.h"
#include "batch_gauss.h"
#include "located_internal.h"

/* A signal by its place, see batch_measure.h. */
static double value_of(int place, const double *w, const bg_snapshot *shot)
{
    if (place < 0)
        return w[-1 - place];
#define AMONG(part, count) \
    if (place < BG_AT_##part + (count)) \
        return shot->part[place - BG_AT_##part];
    BG_PARTS(AMONG)
#undef AMONG
    return NAN;
}

static void keep_signals(void *to, int sample, const double *w, const int *mode,
                   const bg_snapshot *shot)
{
    const located_room *const room = to;
    const batch_job *const job = room->job;
    (void)mode;
    for (int s = 0; s < job->signals; s++)
        room->values[s * job->samples + sample] = value_of(job->signal[s], w, shot);
}

/* Adds to the totals what products make of a part of the latest step. */
static int smooth(void *to, void *run, double begin, double end)
{
    const located_room *const room = to;
    const batch_job *const job = room->job;
    bg_located *const c = run;
    for (int node = 0; node < BATCH_NODES && end > begin; node++) {
        const double t = begin + batch_nodes[node] * (end - begin);
        double s[BG_SIZE], w[BG_ROOM(BG_EXTERNAL)], dw[BG_ROOM(BG_EXTERNAL)];
        int status = bg_solver_dense(c, t, s);
        if (status == BG_OK)
            status = bg_view_look(&c->view, t, s, c->run.mode);
        if (status != BG_OK)
            return status;
        bg_signals_at(c->signals, &c->run.span, t, w, dw);
        for (int k = 0; k < job->products; k++) {
            const batch_product *const two = job->product + k;
            const int *const place = job->signal + job->signals;
            const double one = value_of(place[two->one], w, &c->view.shot);
            const double other = two->other < 0 ? 1.0 : value_of(place[two->other], w, &c->view.shot);
            room->totals[k] += batch_weights[node] * (end - begin) * one * other;
        }
    }
    return BG_OK;
}

int located_begin(located_room *room, const batch_job *job, const located_runs *runs, int run,
                  bg_request *asked)
{
    room->job = job;
    *asked = (bg_request){
        .times = job->times, .states = runs->states + (long)run * (N + OWN),
        .samples = job->samples, .method = room->method,
        .rtol = room->rtol, .atol = room->atol, .to = room, .record = keep_signals,
        .events = room->events, .capacity = room->capacity, .smooth = job->products ? smooth : 0,
        .first = job->first, .named = job->named, .moved = runs->moved + (long)run * (N + OWN),
        .corners = room->corners,
    };
    for (int k = 0; k < job->products; k++)
        room->totals[k] = 0.0;
    const int status = bg_model_init(room->model, runs->parameters + (long)run * BG_PARAMETERS);
    return status == BG_OK && !BG_VARYING && batch_doubtful(room->model) ? BG_SINGULAR : status;
}

int located_reduce(const located_room *room, const located_runs *runs, int run,
                   const bg_request *asked)
{
    const batch_job *const job = room->job;
    double *const results = runs->results + (long)run * job->width;
    return batch_reduce(job, room->values, job->samples, room->totals, asked->events, asked->count,
                        results)
               ? BG_OK
               : BG_NOT_FINITE;
}

int located_alone(located_room *room, const batch_job *job, const located_runs *runs, int run)
{
    bg_request asked;
    int status = located_begin(room, job, runs, run, &asked);
    if (status == BG_OK)
        status = bg_model_run(room->run, room->model, runs->inputs[run], &asked);
    return status == BG_OK ? located_reduce(room, runs, run, &asked) : status;
}

void located_batch(located_room *room, const batch_job *job, const located_runs *runs)
{
    for (int k = 0; k < runs->runs; k++)
        runs->status[k] = located_alone(room, job, runs, k);
}
