/* Events inside one step of an integrator: where a slip or a margin falls through zero. */
#include <math.h>

#include "located_internal.h"

/* The triggers of the latest look; a port that sticks lets go where inputs move it, too. */
static void triggers_now(const bg_located *c, double *values)
{
    int sticking = 0;
    double guards[BG_ROOM(BG_GUARDS)] = {0};
    bg_hold *held = NULL;
    if (BG_GUARDS)
        bg_guards(&c->model->now, guards);
    for (int i = 0; i < K; i++) {
        const double effort = c->view.shot.u[bg_friction_inputs[i]];
        const double slip = c->view.shot.y[bg_friction_readings[i]];
        values[i] = c->run.mode[i] ? c->run.mode[i] * slip : c->view.shot.caps[i] - fabs(effort);
        if (bg_switches[i].kind != BG_RUBS)
            values[i] = bg_stay(bg_switches + i, c->run.mode[i], slip, effort, guards);
        if (bg_is_apart(bg_switches + i, c->run.mode[i]))
            values[i] = guards[bg_switches[i].guard];
        if (bg_hangs(bg_switches + i) && c->run.mode[i])
            values[i] = c->run.mode[i] * guards[bg_switches[i].guard];
        sticking |= c->run.mode[i] == 0;
    }
    if (!sticking || bg_hold_of(c->model, c->run.mode, &held) != BG_OK || held->ruled == 0)
        return;
    for (int i = 0; i < K; i++) {
        const double rest = c->view.shot.caps[i] + 4 * c->watch.of.limit[i];
        if (c->run.mode[i] == 0 && bg_switches[i].kind == BG_RUBS)
            values[i] = fmin(values[i], rest * bg_room(held, i, &c->view.shot, c->watch.near));
    }
}

/* The triggers inside the latest step. */
static int triggers_at(void *located, double t, double *values)
{
    bg_located *const c = located;
    double s[BG_SIZE];
    int status = bg_solver_dense(c, t, s);
    if (status == BG_OK)
        status = bg_view_look(&c->view, t, s, c->run.mode);
    triggers_now(c, values);
    return status;
}

int bg_watch_begin(bg_located *c)
{
    bg_port ports[BG_ROOM(K)];
    const int status = K > 0 ? bg_view_look(&c->view, c->run.at.t, c->s, c->run.mode) : BG_OK;
    if (status != BG_OK || K == 0)
        return status;
    bg_view_ports(&c->view, c->run.mode, c->run.at.time, ports);
    c->watch.of.blind = c->run.at.t + bg_moment(c->run.at.time);
    for (int i = 0; i < K; i++) {
        c->watch.of.limit[i] = c->run.mode[i] ? ports[i].near_slip : ports[i].near_effort;
        if (bg_switches[i].kind != BG_RUBS)
            c->watch.of.limit[i] = ports[i].near_stay;
        if (bg_is_apart(bg_switches + i, c->run.mode[i])
            || (bg_hangs(bg_switches + i) && c->run.mode[i]))
            c->watch.of.limit[i] = ports[i].near_gap;
        c->watch.near[i] = BG_LEFT * ports[i].near_slip;
        c->watch.of.armed[i] = 0;
    }
    triggers_now(c, c->watch.of.before);
    return BG_OK;
}

int bg_watch_step(bg_located *c, double *time, int *ports)
{
    const bg_triggers of = {c, triggers_at, K, c->together};
    *time = INFINITY;
    if (K == 0)
        return BG_OK;
    return bg_first_fall(&c->watch.of, &of, c->solver.t_old, c->solver.t, time, ports);
}
