/* Runs side by side: as one is over the next begins; steps that more of them take go first. */
#include <math.h>
#include <string.h>

#include "lanes_steps.h"

/* What lies between samples, where they lie evenly, else 0. */
static double lanes_even_gap(int samples, const double *times)
{
    const double gap = (times[samples - 1] - times[0]) / (samples - 1);
    for (int i = 1; i < samples; i++)
        if (!(fabs(times[i] - times[0] - i * gap) <= BG_EVENLY * gap))
            return 0.0;
    return gap;
}

static int lanes_free_lane(const bg_lanes_group *group)
{
    for (int l = 0; l < BG_LANES; l++)
        if (!group->run[l])
            return l;
    return -1;
}

/* Inputs of a lane's run have no series there: it goes on by itself. */
static void lanes_unseat(bg_lanes_group *group, int lane)
{
    bg_lanes_leave(group->run[lane], BG_STEPS);
    group->run[lane] = NULL;
}

/* A run to a lane of the steps it waits for; to explicit ones where others are not for it. */
static void lanes_seat(bg_lanes *a, bg_lane_run *one)
{
    int lane;
    if (one->by == LANE_EXPONENTIAL && (lane = lanes_free_lane(&a->exponential.of)) >= 0) {
        if (!bg_lanes_start(a, one))
            one->by = LANE_EXPLICIT;
        else if (!bg_lanes_glide_in(a, lane, one))
            lanes_unseat(&a->exponential.of, lane);
    }
    if (a->job && one->by == LANE_EXPLICIT && (lane = lanes_free_lane(&a->explicit_steps.of)) >= 0
        && !bg_lanes_walk_in(a, lane, one))
        lanes_unseat(&a->explicit_steps.of, lane);
}

/* Every run that waits to a lane; where one is over the next. How many are under way. */
static int lanes_fill(bg_lanes *a)
{
    int under_way = 0;
    for (int k = 0; k < LANE_RUNS; k++) {
        bg_lane_run *const one = a->run + k;
        while (one->by == LANE_NONE && a->next < a->count) {
            one->seated = 0;
            bg_lanes_begin(one, a->next++);
        }
        if (one->by != LANE_NONE && !one->seated)
            lanes_seat(a, one);
        under_way += one->by != LANE_NONE;
    }
    return under_way;
}

static int lanes_seated(const bg_lanes_group *group)
{
    int count = 0;
    for (int l = 0; l < BG_LANES; l++)
        count += group->run[l] != NULL;
    return count;
}

static void lanes_ready(bg_lanes *a, int samples, const double *times, double rtol, double atol)
{
    memset(a, 0, sizeof *a);
    a->samples = samples;
    a->times = times;
    a->explicit_steps.rtol = a->exponential.rtol = rtol;
    a->explicit_steps.atol = a->exponential.atol = atol;
    a->exponential.gap = lanes_even_gap(samples, times);
    bg_lanes_ahead(a->exponential.ahead);
    for (int k = 0; k < LANE_RUNS; k++)
        a->run[k].all = a;
}

static void lanes_go(bg_lanes *a)
{
    while (lanes_fill(a) > 0)
        if (lanes_seated(&a->exponential.of) >= lanes_seated(&a->explicit_steps.of))
            bg_lanes_glide(a);
        else
            bg_lanes_walk(a);
}

/* Explicit steps of a run by itself, as lanes are no help to it there. */
static void lanes_walk_alone(bg_lane_run *one)
{
    bg_located *const c = one->room->run;
    int status = BG_OK, ended = 0;
    while (status == BG_OK && !ended && one->by == LANE_EXPLICIT && c->run.at.t < c->stretch.stop
           && c->stretch.method == BG_DOP853) {
        status = bg_solver_step(c, c->stretch.stop);
        if (status == BG_OK)
            status = bg_located_pass(c, &ended);
        if (status == BG_OK && !ended)
            status = bg_located_go_on(c);
        one->waits -= one->waits > 0;
        one->by = bg_lanes_kind(one);
    }
    const int on = one->by == LANE_EXPONENTIAL && c->stretch.method == BG_DOP853;
    if (status != BG_OK || ended || !on || c->run.at.t >= c->stretch.stop)
        bg_lanes_take_on(one, ended, status);
}

static void lanes_go_alone(bg_lanes *a, bg_lane_run *one)
{
    while (one->by != LANE_NONE) {
        if (one->by == LANE_EXPLICIT)
            lanes_walk_alone(one);
        else if (one->seated)
            bg_lanes_glide(a);
        else
            lanes_seat(a, one);
    }
}

void lanes_batch(bg_lanes *a, located_room *rooms, const batch_job *job, const located_runs *runs)
{
    lanes_ready(a, job->samples, job->times, rooms->rtol, rooms->atol);
    for (int k = 0; k < LANE_RUNS; k++)
        a->run[k].room = rooms + k;
    a->job = job;
    a->runs = runs;
    a->count = runs->runs;
    lanes_go(a);
}

int lanes_rows_run(bg_lanes *a, located_room *room, const double *parameters,
                   const bg_signals *signals, bg_request *asked, bg_rows *rows)
{
    bg_lane_run *const one = a->run;
    bg_located *const c = room->run;
    if (asked->method != BG_AUTO)
        return bg_rows_run(c, room->model, parameters, signals, asked, rows);
    int status = bg_model_init(room->model, parameters);
    lanes_ready(a, asked->samples, asked->times, asked->rtol, asked->atol);
    one->room = room;
    bg_rows_ask(asked, rows);
    if (status == BG_OK) {
        bg_lanes_begin_alone(one, signals, asked);
        lanes_go_alone(a, one);
        status = a->status;
        asked->count = c->run.log.count;
        asked->time = c->run.at.t;
    }
    if (status != BG_OK && status != BG_EVENTS && status != BG_UNTAKEN && !rows->handed)
        return bg_rows_run(c, room->model, parameters, signals, asked, rows);
    return status == BG_OK && rows->failed ? BG_UNTAKEN : status;
}

unsigned long lanes_size(void)
{
    return sizeof(bg_lanes);
}

int lanes_rooms(void)
{
    return LANE_RUNS;
}
