/* Events inside one step of an integrator: where a slip or a margin falls through zero. */
#include <math.h>
#include <string.h>

#include "located_internal.h"

enum { POINTS = BG_CHECKS + 2 };

/* What a search for a root asks: trigger `port` less `level` inside the latest step. */
typedef struct {
    bg_located *c;
    int port, status;
    double level;
} root_search;

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
        const double rest = c->view.shot.caps[i] + 4 * c->watch.limit[i];
        if (c->run.mode[i] == 0 && bg_switches[i].kind == BG_RUBS)
            values[i] = fmin(values[i], rest * bg_room(held, i, &c->view.shot, c->watch.near));
    }
}

/* The triggers inside the latest step. */
static int triggers_at(bg_located *c, double t, double *values)
{
    double s[BG_SIZE];
    int status = bg_solver_dense(c, t, s);
    if (status == BG_OK)
        status = bg_view_look(&c->view, t, s, c->run.mode);
    triggers_now(c, values);
    return status;
}

static double above(void *self, double t)
{
    root_search *const asked = self;
    double values[PORTS] = {0};
    const int status = triggers_at(asked->c, t, values);
    if (status != BG_OK)
        asked->status = status;
    return values[asked->port] - asked->level;
}

/* Where trigger falls through the level between a and b, where it is above it and below. */
static double crossing(root_search *asked, double a, double b, double level)
{
    double found = b;
    asked->level = level;
    if (above(asked, a) <= 0)
        return a;
    if (above(asked, b) < 0)
        bg_root(above, asked, a, b, &found);
    return found;
}

/* Where a trigger that begins at zero falls well below it between a and b; where it has been up and
 * down again before that, where it came through zero. */
static double hop(root_search *asked, double a, double b, double limit)
{
    const double low = crossing(asked, a, b, -2 * limit), half = 0.5 * (a + low);
    asked->level = 0.0;
    return above(asked, half) > limit ? crossing(asked, half, low, 0.0) : low;
}

/* Where trigger `i` falls through zero between two points: 1, if it does. Until it is armed only a
 * fall well below zero counts, after a moment in which nothing does. */
static int trigger_fall(root_search *asked, double t_a, double t_b, double a, double b,
                        double *root)
{
    bg_watch *const watch = &asked->c->watch;
    const int i = asked->port;
    const double limit = watch->limit[i];
    if (!watch->armed[i] && fmax(a, b) > limit) {
        watch->armed[i] = 1;
        if (a <= limit)
            return 0;
    }
    if (watch->armed[i]) {
        if (b > 0)
            return 0;
        *root = crossing(asked, t_a, t_b, 0.0);
        return 1;
    }
    if (b >= -2 * limit || t_b <= watch->blind)
        return 0;
    *root = fmax(hop(asked, t_a, t_b, limit), watch->blind);
    return 1;
}

/* The first of two roots between points k and k + 1, where a trigger dips below zero and comes
 * back. */
static int dip(root_search *asked, const double *times, const double *values, int k, double *root)
{
    double lowest;
    asked->level = 0.0;
    if (!bg_dip(above, asked, POINTS, times, values, k, &lowest))
        return 0;
    *root = crossing(asked, times[k], lowest, 0.0);
    return 1;
}

/* The first time in a step at which a trigger falls through zero, seen or hidden in a dip. What is
 * rising from zero, after its own event, has not come from above. */
static int first_fall(root_search *asked, const double *times, double values[POINTS][PORTS],
                      double *root)
{
    const bg_watch *const watch = &asked->c->watch;
    const int i = asked->port;
    double own[POINTS];
    for (int k = 0; k < POINTS; k++)
        own[k] = values[k][i];
    for (int k = 0; k + 1 < POINTS; k++) {
        const int risen = watch->armed[i] || own[k] > watch->limit[i];
        if (trigger_fall(asked, times[k], times[k + 1], own[k], own[k + 1], root)
            || (risen && dip(asked, times, own, k, root)))
            return 1;
    }
    return 0;
}

int bg_watch_begin(bg_located *c)
{
    bg_port ports[BG_ROOM(K)];
    const int status = K > 0 ? bg_view_look(&c->view, c->run.at.t, c->s, c->run.mode) : BG_OK;
    if (status != BG_OK || K == 0)
        return status;
    bg_view_ports(&c->view, c->run.mode, c->run.at.time, ports);
    c->watch.blind = c->run.at.t + bg_moment(c->run.at.time);
    for (int i = 0; i < K; i++) {
        c->watch.limit[i] = c->run.mode[i] ? ports[i].near_slip : ports[i].near_effort;
        if (bg_switches[i].kind != BG_RUBS)
            c->watch.limit[i] = ports[i].near_stay;
        if (bg_is_apart(bg_switches + i, c->run.mode[i])
            || (bg_hangs(bg_switches + i) && c->run.mode[i]))
            c->watch.limit[i] = ports[i].near_gap;
        c->watch.near[i] = BG_LEFT * ports[i].near_slip;
        c->watch.armed[i] = 0;
    }
    triggers_now(c, c->watch.before);
    return BG_OK;
}

int bg_watch_step(bg_located *c, int *found, double *time, int *ports)
{
    const double begin = c->solver.t_old, end = c->solver.t;
    double times[POINTS], values[POINTS][PORTS], roots[PORTS];
    root_search asked = {c, 0, BG_OK, 0.0};
    *found = 0;
    *time = INFINITY;
    if (K == 0)
        return BG_OK;
    memcpy(values[0], c->watch.before, sizeof values[0]);
    times[0] = begin;
    for (int k = 1; k < POINTS; k++) {
        times[k] = k == POINTS - 1 ? end : begin + k * (end - begin) / (POINTS - 1);
        const int status = triggers_at(c, times[k], values[k]);
        if (status != BG_OK)
            return status;
    }
    memcpy(c->watch.before, values[POINTS - 1], sizeof values[0]);
    for (int i = 0; i < K; i++) {
        asked.port = i;
        roots[i] = INFINITY;
        if (first_fall(&asked, times, values, roots + i))
            *found = 1;
        *time = fmin(*time, roots[i]);
    }
    for (int i = 0; i < K; i++)
        ports[i] = *found && roots[i] <= *time + BG_TOGETHER * fmax(fabs(*time), end - begin);
    return asked.status;
}
