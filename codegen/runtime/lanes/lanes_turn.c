/* Of a run what is no step: how it begins, what is decided between stretches, and its end. */
#include <math.h>

#include "lanes_steps.h"

void bg_lanes_leave(bg_lane_run *one, int status)
{
    bg_lanes *const a = one->all;
    one->by = LANE_NONE;
    a->status = status;
    if (!a->job)
        return;
    if (status == BG_OK)
        status = located_reduce(one->room, a->runs, one->run, &one->own);
    if (status != BG_OK)
        status = located_alone(one->room, a->job, a->runs, one->run);
    a->runs->status[one->run] = status;
}

/* A stretch has set off: exponential steps have not been too coarse in it. */
static void turn_set_off(bg_lane_run *one)
{
    one->waits = 0;
    one->finer = 1;
    one->after = -INFINITY;
    one->patience = LANE_PATIENCE;
}

/* The stretch to the next corner, where there is one; whether it has set off. */
static int turn_follow(bg_lane_run *one, int *ended, int *status)
{
    bg_located *const c = one->room->run;
    double first = 0.0;
    int more = 0;
    if (BG_CORNERS)
        *status = bg_corners_follow(c, ended, &first, &more);
    if (*status != BG_OK || !more)
        return 0;
    *status = bg_located_set_off(c, c->corners.stop, first);
    turn_set_off(one);
    return *status == BG_OK;
}

/* From where a run is in its stretch, `ended` or not, as far as it cannot go by steps of lanes.
 * Whether it goes on so. */
static int turn_go(bg_lane_run *one, int ended, int *status)
{
    bg_located *const c = one->room->run;
    do {
        if (!ended)
            *status = bg_located_rest(c, 0, &ended);
        if (*status == BG_OK && !ended && c->run.at.t < c->stretch.stop) {
            if (bg_lanes_may(one)) {
                one->by = bg_lanes_kind(one);
                one->tries = 0;
                if (one->all->job)
                    c->turns.patience = BG_PATIENCE * BG_LANES; /* a step costs so much less */
                return 1;
            }
            *status = bg_located_rest(c, 1, &ended);
        }
    } while (*status == BG_OK && turn_follow(one, &ended, status));
    return 0;
}

/* From a turn to the stretch that follows; `done`: at the run's end. Whether it goes on by steps
 * of lanes. */
static int turn_once(bg_lane_run *one, int *status, int *done)
{
    bg_located *const c = one->room->run;
    double stop;
    /* Breakpoints lie ahead one after the other: a turn that ends at one gets somewhere. */
    one->turns += c->run.at.t < c->run.at.following;
    const int more = one->turns < bg_most_turns(&c->run.log);
    *status = more ? bg_located_turn(c, &stop) : BG_EVENTS;
    *done = *status == BG_OK && c->run.at.t >= c->run.end;
    if (*status == BG_OK && !*done && BG_CORNERS)
        *status = bg_corners_set_off(c, stop);
    if (*status != BG_OK || *done)
        return 0;
    *status = bg_located_set_off(c, stop, 0.0);
    turn_set_off(one);
    return *status == BG_OK && turn_go(one, 0, status);
}

/* From a turn on until it goes by steps of lanes or is over. */
static void turn_on(bg_lane_run *one, int status)
{
    bg_located *const c = one->room->run;
    int done = 0;
    while (status == BG_OK && !done)
        if (turn_once(one, &status, &done))
            return;
    if (done) {
        status = bg_located_end(c);
        c->asked->count = c->run.log.count;
    }
    bg_lanes_leave(one, status);
}

void bg_lanes_take_on(bg_lane_run *one, int ended, int status)
{
    if (status != BG_OK || !turn_go(one, ended, &status))
        turn_on(one, status);
}

void bg_lanes_begin_alone(bg_lane_run *one, const bg_signals *signals, bg_request *asked)
{
    one->turns = 0.0;
    const int status = bg_located_begin(one->room->run, one->room->model, signals, asked);
    bg_lanes_prepare(one->room->model, one->constants);
    bg_lanes_join(one);
    turn_on(one, status);
}

void bg_lanes_begin(bg_lane_run *one, int run)
{
    const bg_lanes *const a = one->all;
    one->run = run;
    const int status = located_begin(one->room, a->job, a->runs, run, &one->own);
    if (status == BG_OK)
        bg_lanes_begin_alone(one, a->runs->inputs[run], &one->own);
    else
        bg_lanes_leave(one, status);
}
