/* The start of a step: which ports hold, from how they were. What ports give is solved for as over
 * a moment, in which values count before rates: one linear complementarity problem. */
#include <math.h>
#include <string.h>

#include "port_step.h"

static int is_rubbing(int port)
{
    return bg_switches[port].kind == BG_RUBS;
}

void bg_bound_switch(int port, int mode, int stays, bg_boxed *b)
{
    const bg_switch *const one = bg_switches + port;
    const int fixed = one->kind == BG_TOLD || (stays && one->kind == BG_STOPS);
    b->extra[port] = b->slack[port] = b->shared[port] = 0.0;
    b->slips[port] = BG_HUGE;
    b->way[port] = one->kind == BG_RUBS ? mode : !mode ? 0 : one->side < 0 ? -1 : 1;
    b->least[port] = fixed ? (mode ? 0.0 : -BG_HUGE) : one->side < 0 ? 0.0 : -BG_HUGE;
    b->most[port] = fixed ? (mode ? 0.0 : BG_HUGE) : one->side < 0 ? BG_HUGE : 0.0;
}

void bg_bound_friction(int port, double level, double cap, int rests, bg_boxed *b)
{
    b->most[port] = rests ? fmax(cap, level) : level;
    b->least[port] = -b->most[port];
    b->extra[port] = fmax(0.0, cap - b->most[port]);
    b->slack[port] = BG_BREAKAWAY * cap;
    b->slips[port] = level;
}

void bg_take_ways(const bg_boxed *b, int strict, int *mode)
{
    for (int i = 0; i < K; i++) {
        /* At its limit and still at rest it stays there. */
        const int still = !strict && fabs(b->slip[i]) <= b->near[i] + b->shared[i];
        const int rests = b->way[i] == 0 || still;
        if (is_rubbing(i))
            mode[i] = rests ? 0 : b->way[i];
        else if (b->least[i] != b->most[i])
            mode[i] = b->way[i] != 0;
    }
}

/* Slips below that count as zero: of friction the dead band, or their rounding. */
static double least_slip(const bg_model *m, int port, double terms)
{
    const double rounding = BG_STEP_ROUNDING * terms;
    return is_rubbing(port) ? fmax(m->band[port], rounding) : rounding;
}

/* The slip of a port a moment on; of one that holds what is more than a step's own error. */
static void find_slip(const step_search *c, const int *mode, int i, bg_boxed *b)
{
    const bg_model *const m = c->m;
    double terms, moves;
    const double slip = bg_slip(m, &m->shot, i, &terms), least = least_slip(m, i, terms);
    const double brief = BG_BRIEF * c->at.h;
    b->near[i] = BG_STEP_ROUNDING * terms;
    b->slip[i] = slip;
    if (mode[i] == 0 && fabs(slip) <= least) {
        b->slip[i] = 0.0;
    } else if (mode[i] == 0 && c->at.started && c->at.before[i] == 0) {
        bg_slip_rate(m, &m->shot, i, &moves);
        if (fabs(slip) <= least + BG_STEP_DRIFT * c->at.h * moves)
            b->slip[i] = 0.0;
    } else if (fabs(slip) <= least && !bg_beside[i]) {
        b->slip[i] = brief * bg_slip_rate(m, &m->shot, i, &moves);
        b->near[i] = brief * BG_STEP_ROUNDING * moves;
    }
}

/* What counts as no slip of ports that held, if they let go: what rates leave of it in a moment. */
static void find_near(const step_search *c, const int *mode, bg_boxed *b)
{
    for (int i = 0; i < K; i++) {
        double moves;
        if (mode[i] != 0 || b->slip[i] != 0.0)
            continue;
        bg_slip_rate(c->m, &c->m->shot, i, &moves);
        b->near[i] = BG_BRIEF * c->at.h * BG_STEP_ROUNDING * moves;
    }
}

/* The problem of a mode that has been looked at, in m->shot. `slack`: what makes up what holds. */
static void find_start(step_search *c, const int *mode, const double *slack, bg_boxed *b)
{
    bg_model *const m = c->m;
    double values[4 * PORTS] = {0};
    bg_friction_values(&m->now, values);
    for (int i = 0; i < K; i++) {
        const double cap = fmax(0.0, m->shot.caps[i]), rest = values[4 * i] * values[4 * i + 3];
        b->given[i] = m->shot.u[bg_friction_inputs[i]];
        bg_bound_switch(i, mode[i], bg_has(&c->barred, i), b);
        find_slip(c, mode, i, b);
        if (is_rubbing(i)) {
            const double slip = m->shot.y[bg_friction_readings[i]];
            const double level = mode[i] && b->slip[i] == slip ? fabs(b->given[i])
                                                               : fmax(0.0, rest);
            bg_bound_friction(i, level, cap, mode[i] == 0 || b->slip[i] != slip, b);
        } else {
            b->slack[i] = BG_STEP_ROUNDING * slack[i];
        }
    }
    bg_hang(m, c->at.h, b);
}

/* The magnitudes of what makes up what holds the ports. */
static void find_slack(step_search *c, double *slack)
{
    bg_model *const m = c->m;
    double terms[PORTS];
    bg_hold *held = NULL;
    int any = 0;
    for (int i = 0; i < K; i++) {
        slack[i] = bg_largest(M, m->shot.u);
        any |= m->mode[i] == 0;
    }
    if (!any || bg_hold_of(m, m->mode, &held) != BG_OK || held->ranks.moved)
        return;
    bg_effort_terms(held, m->shot.x, m->shot.u, m->shot.du, terms);
    for (int i = 0; i < held->count; i++)
        slack[held->ports[i]] = terms[i];
}

int bg_settle_ways(step_search *c, const bg_set *sent, int *stopped, int *changed)
{
    bg_model *const m = c->m;
    bg_boxed *const b = &m->work.box;
    double slack[PORTS];
    int mode[PORTS];
    find_slack(c, slack);
    memcpy(mode, m->mode, sizeof m->mode);
    for (int i = 0; i < K; i++)
        if (bg_has(sent, i))
            mode[i] = !mode[i];
    find_start(c, mode, slack, b);
    *changed = !bg_is_empty(sent) || bg_box_broken(K, b) > 0;
    if (!*changed)
        return BG_OK;
    for (int i = 0; i < K; i++)
        stopped[i] |= b->way[i] == 0 && b->slip[i] != 0.0;
    find_near(c, mode, b);
    bg_respond(m, BG_BRIEF * c->at.h, 0.0, &m->work.response);
    bg_yields(m, &m->work.response, m->work.yields, b->reversed);
    const int status = bg_box_solve(K, b, m->work.yields, m->work.system);
    bg_take_ways(b, 0, mode);
    /* Where that is what was looked at, and contradicted, ports are beyond their limits. */
    int same = 1;
    for (int i = 0; i < K; i++)
        same &= mode[i] == m->mode[i];
    if (same)
        bg_take_ways(b, 1, mode);
    memcpy(m->mode, mode, sizeof m->mode);
    return status;
}
