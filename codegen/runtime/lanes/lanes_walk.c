/* Explicit steps of all lanes, with step control, samples and the first look for events. */
#include <string.h>

#include "lanes_steps.h"

int bg_lanes_walk_in(bg_lanes *a, int lane, bg_lane_run *one)
{
    bg_lanes_explicit *const e = &a->explicit_steps;
    const bg_located *const c = one->room->run;
    bg_lanes_load(&e->of, lane, one);
    for (int k = 0; k < BG_SIZE; k++) {
        e->y[k][lane] = c->solver.y[k];
        e->f[k][lane] = c->solver.f[k];
    }
    return bg_lanes_follow(&e->of, lane, c->solver.t);
}

/* Its run leaves a lane. */
static bg_lane_run *walk_out(bg_lanes_explicit *e, int lane)
{
    bg_lane_run *const one = e->of.run[lane];
    one->seated = 0;
    e->of.run[lane] = NULL;
    return one;
}

/* Where a lane's step is tried: its length; whether the series of inputs go so far. */
static int walk_try_step(bg_lanes_explicit *a, int lane)
{
    bg_lane_run *const one = a->of.run[lane];
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
    return bg_lanes_follow(&a->of, lane, end);
}

/* Whether the step was good, `taken`; if not, the next try is shorter. A status. */
static int walk_judge(bg_lanes_explicit *a, int lane, int *taken)
{
    bg_lane_run *const one = a->of.run[lane];
    bg_solver *const s = &one->room->run->solver;
    const double h = a->h[lane], error = bg_explicit_judge(s, a->fifth[lane], a->third[lane], h);
    *taken = error < 1.0;
    if (*taken) {
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

/* Whether nothing can happen in a lane's step, so that all it passes is samples. */
static int walk_is_plain(bg_lanes_explicit *a, int lane)
{
    const bg_lane_run *const one = a->of.run[lane];
    bg_located *const c = one->room->run;
    double in[LANE_WATCHED], last[LANE_WATCHED];
    if (c->asked->smooth)
        return 0;
    bg_lanes_watched(one, &a->of.own, lane, (const bg_lane *)a->middle, in);
    bg_lanes_watched(one, &a->of.own, lane, (const bg_lane *)a->end, last);
    if (!bg_finite(K, in) || !bg_finite(K, last) || !bg_passes(&c->watch.of, K, in, last)
        || !bg_passes(&c->corners.of, BG_CORNERS, in + K, last + K))
        return 0;
    bg_lanes_note(one, last);
    return 1;
}

/* The next sample of a lane's step, if there is one in it. */
static int walk_has_sample(const bg_lane_run *one)
{
    const bg_located *const c = one->room->run;
    return c->next < c->asked->samples && c->asked->times[c->next] < c->solver.t;
}

/* Whether all that is followed are states, which come first among everything at an instant. */
static int walk_follows_states(const batch_job *job)
{
    int all = 1;
    for (int s = 0; s < job->signals; s++)
        all &= job->signal[s] >= BG_AT_x && job->signal[s] < ALL;
    return all;
}

/* The samples in the steps of lanes in which nothing happens. */
static void walk_sample(bg_lanes_explicit *a, const batch_job *job, const int *plain,
                        int *status)
{
    bg_lane s[BG_SIZE];
    for (;;) {
        int any = 0, has[BG_LANES];
        for (int l = 0; l < BG_LANES; l++) {
            const bg_lane_run *const one = a->of.run[l];
            has[l] = plain[l] && status[l] == BG_OK && walk_has_sample(one);
            a->of.at.t[l] =
                has[l] ? one->room->run->asked->times[one->room->run->next] : a->t_old[l];
            any |= has[l];
        }
        if (!any)
            return;
        bg_lanes_between(a, s);
        if (job && !walk_follows_states(job)) {
            bg_lanes_inputs(&a->of);
            bg_lanes_look(&a->of.own, &a->of.at, s, a->shot);
        } else {
            memcpy(a->shot, s, sizeof s);
        }
        for (int l = 0; l < BG_LANES; l++)
            if (has[l])
                status[l] = bg_lanes_keep(a->of.run[l], l, (const bg_lane *)s,
                                          (const bg_lane *)a->of.at.w, (const bg_lane *)a->shot);
    }
}

/* Puts a lane's latest step into its run's solver, with all between its ends. */
static void walk_unload(const bg_lanes_explicit *a, int lane)
{
    bg_solver *const s = &a->of.run[lane]->room->run->solver;
    for (int k = 0; k < BG_SIZE; k++) {
        s->y_old[k] = a->y_old[k][lane];
        s->y[k] = a->y[k][lane];
        s->f_old[k] = a->stage[0][k][lane];
        s->f[k] = a->stage[LANE_LAST][k][lane];
        for (int i = 0; i < BG_EXPLICIT_STAGES; i++)
            s->stage[i][k] = a->stage[i][k][lane];
        for (int i = 0; i < 7; i++)
            s->interpolation[i][k] = a->interpolation[i][k][lane];
    }
    s->dense = 1;
}

/* A run whose step has passed stays in its lane, if it goes on by explicit steps. */
static void walk_stay(bg_lanes_explicit *e, int lane)
{
    bg_lane_run *const one = e->of.run[lane];
    bg_solver *const s = &one->room->run->solver;
    one->waits -= one->waits > 0;
    one->by = bg_lanes_kind(one);
    if (one->by == LANE_EXPLICIT)
        return;
    for (int k = 0; k < BG_SIZE; k++) {
        s->y[k] = e->y[k][lane];
        s->f[k] = e->f[k][lane];
    }
    (void)walk_out(e, lane);
}

/* After a step, of whose samples there is a status: where its run is, and how it goes on; in the
 * lane if it may. */
static void walk_pass(bg_lanes_explicit *e, int lane, int plain, int status)
{
    bg_located *const c = e->of.run[lane]->room->run;
    double s[BG_SIZE];
    int ended = 0;
    if (plain) {
        for (int k = 0; k < BG_SIZE; k++)
            s[k] = e->y[k][lane];
        bg_located_reach(c, c->solver.t, s);
        if (status == BG_OK && c->asked->passed)
            status = c->asked->passed(c->asked->to, c);
    } else {
        walk_unload(e, lane);
        status = bg_located_pass(c, &ended);
    }
    if (status == BG_OK && !ended)
        status = bg_located_go_on(c);
    if (!ended && status == BG_OK && c->stretch.method == BG_DOP853
        && c->run.at.t < c->stretch.stop) {
        walk_stay(e, lane);
        return;
    }
    bg_lanes_take_on(walk_out(e, lane), ended, status);
}

/* Each lane's next try of a step; whose inputs have no series goes on by itself. */
static void walk_try_all(bg_lanes_explicit *e)
{
    for (int l = 0; l < BG_LANES; l++)
        if (e->of.run[l] && !walk_try_step(e, l))
            bg_lanes_leave(walk_out(e, l), BG_STEPS);
}

/* Which lanes have taken their step: whether any. */
static int walk_judge_all(bg_lanes_explicit *e, int *taken)
{
    int any = 0;
    for (int l = 0; l < BG_LANES; l++) {
        taken[l] = 0;
        if (e->of.run[l] && walk_judge(e, l, taken + l) != BG_OK)
            bg_lanes_leave(walk_out(e, l), BG_STEPS);
        any |= taken[l];
    }
    return any;
}

void bg_lanes_walk(bg_lanes *a)
{
    bg_lanes_explicit *const e = &a->explicit_steps;
    int plain[BG_LANES] = {0}, taken[BG_LANES], status[BG_LANES] = {0};
    walk_try_all(e);
    bg_lanes_attempt(e);
    if (!walk_judge_all(e, taken))
        return;
    bg_lanes_dense(e);
    for (int l = 0; l < BG_LANES; l++)
        e->of.at.t[l] = e->t_old[l] + 0.5 * e->h[l];
    bg_lanes_between(e, e->tried);
    bg_lanes_inputs(&e->of);
    bg_lanes_look(&e->of.own, &e->of.at, e->tried, e->middle);
    for (int l = 0; l < BG_LANES; l++)
        plain[l] = taken[l] && walk_is_plain(e, l);
    walk_sample(e, a->job, plain, status);
    for (int l = 0; l < BG_LANES; l++)
        if (taken[l])
            walk_pass(e, l, plain[l], status[l]);
}
