/* Runs in lanes: each takes the next run as it is done with one. */
#include <string.h>

#include "lanes.h"

/* What lanes work on. */
typedef struct {
    bg_lanes *lanes;
    const batch_job *job;
    const located_runs *runs;
} lanes_work;

/* What is done with a run: where it could not go on in its lane it is done anew by itself. */
static void lane_leave(const lanes_work *of, bg_lane_run *one, int status)
{
    if (status == BG_OK)
        status = located_reduce(one->room, of->runs, one->run, &one->asked);
    if (status != BG_OK)
        status = located_alone(one->room, of->job, of->runs, one->run);
    of->runs->status[one->run] = status;
    one->run = -1;
}

/* Begins the next run in a lane, if there is one. */
static int lane_begin(const lanes_work *of, int lane)
{
    bg_lanes *const a = of->lanes;
    bg_lane_run *const one = a->lane + lane;
    double constants[BG_ROOM(BG_LANE_CONSTANTS)];
    if (a->next == of->runs->runs)
        return BG_OK;
    one->run = a->next++;
    one->turns = 0.0;
    int status = located_begin(one->room, of->job, of->runs, one->run, &one->asked);
    if (status == BG_OK)
        status = bg_located_begin(one->room->run, one->room->model, of->runs->inputs[one->run],
                                  &one->asked);
    bg_lanes_prepare(one->room->model, constants);
    for (int k = 0; k < BG_LANE_CONSTANTS; k++)
        a->own.constants[k][lane] = constants[k];
    bg_lanes_join(a, lane);
    return status;
}

/* The stretch to the next corner, where there is one; whether it has set off. */
static int lane_follow(bg_located *c, int *ended, int *status)
{
    double first = 0.0;
    int more = 0;
    if (BG_CORNERS)
        *status = bg_corners_follow(c, ended, &first, &more);
    if (*status != BG_OK || !more)
        return 0;
    *status = bg_located_set_off(c, c->corners.stop, first);
    return *status == BG_OK;
}

/* From where a run is in its stretch, `ended` or not, as far as it cannot go by steps in the lane.
 * Whether it goes on so. */
static int lane_go(bg_lanes *a, int lane, int ended, int *status)
{
    bg_located *const c = a->lane[lane].room->run;
    do {
        if (!ended)
            *status = bg_located_rest(c, 0, &ended);
        if (*status == BG_OK && !ended && c->run.at.t < c->stretch.stop) {
            if (bg_lanes_load(a, lane))
                return 1;
            *status = bg_located_rest(c, 1, &ended);
        }
    } while (*status == BG_OK && lane_follow(c, &ended, status));
    return 0;
}

/* From a turn to the stretch that follows; `done`: at the run's end. Whether it goes on in the
 * lane. */
static int lane_turn(bg_lanes *a, int lane, int *status, int *done)
{
    bg_lane_run *const one = a->lane + lane;
    bg_located *const c = one->room->run;
    double stop;
    /* Breakpoints lie ahead one after the other: a turn that ends at one gets somewhere. */
    one->turns += c->run.at.t < c->run.at.following;
    const double most = 16.0 * c->run.log.capacity + 1000.0;
    *status = one->turns < most ? bg_located_turn(c, &stop) : BG_EVENTS;
    *done = *status == BG_OK && c->run.at.t >= c->run.end;
    if (*status == BG_OK && !*done && BG_CORNERS)
        *status = bg_corners_set_off(c, stop);
    if (*status != BG_OK || *done)
        return 0;
    *status = bg_located_set_off(c, stop, 0.0);
    return *status == BG_OK && lane_go(a, lane, 0, status);
}

/* Takes a lane on until it goes by steps, or no run is left. */
static void lane_take_on(const lanes_work *of, int lane, int status)
{
    bg_lane_run *const one = of->lanes->lane + lane;
    for (;;) {
        int done = 0;
        if (one->run < 0)
            status = lane_begin(of, lane);
        if (one->run < 0 || (status == BG_OK && lane_turn(of->lanes, lane, &status, &done)))
            return;
        if (done) {
            bg_located *const c = one->room->run;
            status = bg_located_end(c);
            one->asked.count = c->run.log.count;
        }
        if (done || status != BG_OK)
            lane_leave(of, one, status);
    }
}

/* Where a lane's step is tried: its length; whether the series of inputs go so far. */
static int lane_try(bg_lanes *a, int lane)
{
    bg_lane_run *const one = a->lane + lane;
    bg_solver *const s = &one->room->run->solver;
    double h = a->h[lane];
    if (!one->tries++) {
        h = fmin(fmax(s->next, bg_explicit_least(s)), s->longest);
        s->t_old = s->t;
        one->grow = GROW;
        for (int k = 0; k < BG_SIZE; k++)
            a->y_old[k][lane] = a->y[k][lane];
    }
    const double end = fmin(s->t_old + h, one->room->run->stretch.stop);
    a->t_old[lane] = s->t_old;
    a->t[lane] = end;
    a->h[lane] = end - s->t_old;
    return bg_lanes_follow(a, lane, end);
}

/* Whether the step was good; if not, the next try is shorter. A status. */
static int lane_judge(bg_lanes *a, int lane)
{
    bg_lane_run *const one = a->lane + lane;
    bg_solver *const s = &one->room->run->solver;
    const double h = a->h[lane], error = bg_explicit_judge(s, a->fifth[lane], a->third[lane], h);
    one->taken = error < 1.0;
    if (one->taken) {
        bg_explicit_take(s, a->t[lane], h, error, one->grow);
        one->tries = 0;
        for (int k = 0; k < BG_SIZE; k++)
            a->f[k][lane] = a->stage[LANE_LAST][k][lane];
        return BG_OK;
    }
    a->h[lane] = h * bg_explicit_shorter(error);
    one->grow = 1.0;
    return a->h[lane] < bg_explicit_least(s) ? BG_STEPS : BG_OK;
}

/* What corners hang on at an instant, as far from zero as on this side. */
static void lane_corners(const bg_lanes *a, int lane, const bg_lane *shot, double *values)
{
    double hung[2 * BG_ROOM(BG_CORNERS)];
    for (int k = 0; k < 2 * BG_CORNERS; k++)
        hung[k] = shot[LANE_CORNERS + k][lane];
    bg_corners_away(&a->lane[lane].room->model->now, hung);
    memcpy(values, hung, sizeof(double) * BG_CORNERS);
}

/* Whether nothing can happen in a lane's step, so that all it passes is samples. */
static int lane_is_plain(bg_lanes *a, int lane)
{
    bg_located *const c = a->lane[lane].room->run;
    double middle[BG_ROOM(K)], end[BG_ROOM(K)];
    double in[BG_ROOM(BG_CORNERS)], last[BG_ROOM(BG_CORNERS)];
    if (c->asked->smooth)
        return 0;
    bg_lanes_triggers(&a->own, lane, a->middle, middle);
    bg_lanes_triggers(&a->own, lane, a->end, end);
    lane_corners(a, lane, a->middle, in);
    lane_corners(a, lane, a->end, last);
    if (!bg_finite(K, middle) || !bg_finite(K, end)
        || !bg_passes(&c->watch.of, K, middle, end)
        || !bg_passes(&c->corners.of, BG_CORNERS, in, last))
        return 0;
    bg_note_pass(&c->watch.of, K, end);
    bg_note_pass(&c->corners.of, BG_CORNERS, last);
    return 1;
}

/* Keeps what is followed of the sample at the lane's time. */
static void lane_keep(const bg_lanes *a, const batch_job *job, int lane)
{
    located_room *const room = a->lane[lane].room;
    const int sample = room->run->next++;
    for (int s = 0; s < job->signals; s++) {
        const int place = job->signal[s];
        room->values[s * job->samples + sample] =
            place < 0 ? a->at.w[-1 - place][lane] : a->shot[place][lane];
    }
}

/* The next sample of a lane's step, if there is one in it. */
static int lane_has_sample(const bg_lane_run *one, const int *plain, int lane)
{
    const bg_located *const c = one->room->run;
    return plain[lane] && c->next < c->asked->samples && c->asked->times[c->next] < c->solver.t;
}

/* Whether all that is followed are states, which come first among everything at an instant. */
static int lane_follows_states(const batch_job *job)
{
    int all = 1;
    for (int s = 0; s < job->signals; s++)
        all &= job->signal[s] >= BG_AT_x && job->signal[s] < ALL;
    return all;
}

/* The samples in the steps of lanes in which nothing happens. */
static void lanes_sample(bg_lanes *a, const batch_job *job, const int *plain)
{
    bg_lane s[BG_SIZE];
    for (;;) {
        int any = 0, has[BG_LANES];
        for (int l = 0; l < BG_LANES; l++) {
            const bg_lane_run *const one = a->lane + l;
            has[l] = plain[l] && lane_has_sample(one, plain, l);
            a->at.t[l] = has[l] ? one->room->run->asked->times[one->room->run->next] : a->t_old[l];
            any |= has[l];
        }
        if (!any)
            return;
        bg_lanes_between(a, s);
        if (job->signals > 0 && !lane_follows_states(job))
            bg_lanes_shoot(a, s, a->shot);
        else
            memcpy(a->shot, s, sizeof s);
        for (int l = 0; l < BG_LANES; l++)
            if (has[l])
                lane_keep(a, job, l);
    }
}

/* After a step: where its run is, and how it goes on; in the lane if it may. */
static void lane_pass(const lanes_work *of, int lane, int plain)
{
    bg_lanes *const a = of->lanes;
    bg_located *const c = a->lane[lane].room->run;
    double s[BG_SIZE];
    int status = BG_OK, ended = 0;
    if (plain) {
        for (int k = 0; k < BG_SIZE; k++)
            s[k] = a->y[k][lane];
        bg_located_reach(c, c->solver.t, s);
    } else {
        bg_lanes_unload(a, lane);
        status = bg_located_pass(c, &ended);
    }
    if (status == BG_OK && !ended)
        status = bg_located_go_on(c);
    if (!ended && status == BG_OK && c->stretch.method == BG_DOP853
        && c->run.at.t < c->stretch.stop)
        return;
    if (status == BG_OK && lane_go(a, lane, ended, &status))
        return;
    if (status != BG_OK)
        lane_leave(of, a->lane + lane, status);
    lane_take_on(of, lane, BG_OK);
}

/* One try of a step in every lane, and what follows. */
static void lanes_step(const lanes_work *of)
{
    bg_lanes *const a = of->lanes;
    int plain[BG_LANES] = {0}, any = 0;
    for (int l = 0; l < BG_LANES; l++)
        while (a->lane[l].run >= 0 && !lane_try(a, l)) {
            lane_leave(of, a->lane + l, BG_STEPS);
            lane_take_on(of, l, BG_OK);
        }
    bg_lanes_attempt(a);
    for (int l = 0; l < BG_LANES; l++) {
        bg_lane_run *const one = a->lane + l;
        one->taken = 0;
        if (one->run >= 0 && lane_judge(a, l) != BG_OK) {
            lane_leave(of, one, BG_STEPS);
            lane_take_on(of, l, BG_OK);
        }
        any |= one->taken;
    }
    if (!any)
        return;
    bg_lanes_dense(a);
    for (int l = 0; l < BG_LANES; l++)
        a->at.t[l] = a->t_old[l] + 0.5 * a->h[l];
    bg_lanes_between(a, a->tried);
    bg_lanes_shoot(a, a->tried, a->middle);
    for (int l = 0; l < BG_LANES; l++)
        plain[l] = a->lane[l].taken && lane_is_plain(a, l);
    lanes_sample(a, of->job, plain);
    for (int l = 0; l < BG_LANES; l++)
        if (a->lane[l].taken)
            lane_pass(of, l, plain[l]);
}

void lanes_batch(bg_lanes *a, located_room *rooms, const batch_job *job, const located_runs *runs)
{
    const lanes_work of = {a, job, runs};
    int left = 1;
    memset(a, 0, sizeof *a);
    a->rtol = rooms->rtol;
    a->atol = rooms->atol;
    for (int l = 0; l < BG_LANES; l++) {
        a->lane[l].room = rooms + l;
        a->lane[l].run = -1;
        lane_take_on(&of, l, BG_OK);
    }
    while (left) {
        left = 0;
        for (int l = 0; l < BG_LANES; l++)
            left |= a->lane[l].run >= 0;
        if (left)
            lanes_step(&of);
    }
}

unsigned long lanes_size(void)
{
    return sizeof(bg_lanes);
}
