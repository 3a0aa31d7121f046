/* The mode of a step: switches by what they receive and give, by their conditions and impulses, in
 * a bounded number of ways; in each of these friction by its dead band. */
#include <math.h>
#include <string.h>

#include "port_step.h"
#include "port_ways.h"

/* Whether impulses are more than rounding and what a step leaves of slips that were held before. */
static int is_struck(const step_search *c, const bg_hold *held, const double *slips)
{
    double near[PORTS] = {0};
    for (int i = 0; i < held->count; i++) {
        double terms, moves;
        const int port = held->ports[i];
        bg_slip(c->m, &c->m->shot, port, &terms);
        bg_slip_rate(c->m, &c->m->shot, port, &moves);
        near[i] = BG_STEP_ROUNDING * terms;
        if (c->at.started && c->at.before[port] == 0)
            near[i] += BG_STEP_DRIFT * c->at.h * moves;
    }
    return bg_have_slips(held, slips, near);
}

int bg_strike_in_step(step_search *c, const int *mode, double *ways)
{
    double impulses[PORTS * PORTS], slips[PORTS], given[PORTS] = {0};
    bg_model *const m = c->m;
    bg_hold *held = NULL;
    int loose[BG_MOST_PORTS];
    /* Where rows turn as states jump, each strike leaves what is bent of its way. */
    for (int strikes = BG_VARYING ? BG_IMPACTS : 1; strikes > 0; strikes--) {
        for (int i = 0; i < BG_MOST_PORTS; i++)
            loose[i] = 1;
        int status = bg_look_slipping(m, &c->at, loose);
        if (status == BG_OK)
            status = bg_impulses(m, mode, &held, impulses);
        if (status || !held)
            return status;
        bg_held_slips(held, &m->shot, slips);
        if (!is_struck(c, held, slips))
            return BG_OK;
        bg_stop(m, mode, held, impulses, slips, c->s, given, ways);
        memcpy(c->tried, given, sizeof given);
    }
    return BG_OK;
}

/* Whether a one-sided switch changes over at once, by value or rate. */
static int turns_over(const step_search *c, int port, double slack)
{
    const bg_model *const m = c->m;
    const bg_switch *const one = bg_switches + port;
    double near, slow;
    const double slip = one->side * bg_slip(m, &m->shot, port, &near);
    const double rate = one->side * bg_slip_rate(m, &m->shot, port, &slow);
    if (m->mode[port] == 0)
        return one->side * m->shot.u[bg_friction_inputs[port]] > BG_STEP_ROUNDING * slack;
    if (slip < -BG_STEP_ROUNDING * near)
        return 1;
    return slip <= BG_STEP_ROUNDING * near && !bg_beside[port] && rate < -BG_STEP_ROUNDING * slow;
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

/* Switches whose conditions change them over: above zero, or at zero and above it in the step. */
static bg_set sent(step_search *c, const double *ways)
{
    bg_model *const m = c->m;
    double told[BG_ROOM(BG_GUARDS)] = {0}, near[BG_ROOM(BG_GUARDS)] = {0};
    bg_set found = {{0}}, tied = {{0}};
    bg_guards(&m->now, told);
    bg_told_terms(m, near);
    for (int i = 0; i < K; i++) {
        const int at = bg_condition(bg_switches + i, m->mode[i]);
        if (bg_switches[i].kind != BG_TOLD || ways[i] != 0.0)
            continue;
        if (told[at] > BG_STEP_ROUNDING * near[at])
            bg_add(&found, i);
        else if (fabs(told[at]) <= BG_STEP_ROUNDING * near[at])
            bg_add(&tied, i);
    }
    if (bg_is_empty(&tied))
        return found;
    for (int i = 0; i < BG_SIZE; i++)
        m->work.point[i] = c->s[i] + c->at.h * m->shot.rate[i];
    const bg_start later = {.t = c->at.t + c->at.h, .s = m->work.point, .w = c->at.w,
                            .dw = c->at.dw};
    if (bg_look(m, &later, m->mode) != BG_OK)
        return found;
    bg_guards(&m->now, told);
    for (int i = 0; i < K; i++) {
        const int at = bg_condition(bg_switches + i, m->mode[i]);
        if (bg_has(&tied, i) && told[at] > BG_STEP_ROUNDING * near[at])
            bg_add(&found, i);
    }
    return found;
}

/* The switches that change over at once: by impulse, value or rate, whichever decides. */
static bg_set contrary(step_search *c, const double *ways)
{
    double slack[PORTS];
    bg_set found = {{0}};
    find_slack(c, slack);
    for (int i = 0; i < K; i++) {
        const int kind = bg_switches[i].kind;
        const int sided = (kind == BG_ONE_SIDED || kind == BG_STOPS) && ways[i] == 0.0;
        if (bg_has(&c->barred, i))
            continue;
        if (ways[i] < 0.0 || (sided && turns_over(c, i, slack[i])))
            bg_add(&found, i);
    }
    if (BG_GUARDS) {
        const bg_set more = sent(c, ways); /* others, as these have no sides or impulses */
        found = bg_turned(found, &more);
    }
    return found;
}

static int try_in_step(void *self, const bg_set *held, int *holds, bg_set *broken)
{
    step_search *const c = self;
    bg_model *const m = c->m;
    double ways[PORTS] = {0};
    int rubbing = 0, status = BG_OK;
    memcpy(c->s, c->begun, sizeof c->begun);
    memset(c->tried, 0, sizeof c->tried);
    for (int i = 0; i < K; i++) {
        const int is_switch = bg_switches[i].kind != BG_RUBS;
        m->mode[i] = is_switch ? !bg_has(held, i) : c->at.before[i];
        if (bg_has(&c->barred, i))
            m->mode[i] = !bg_switches[i].on;
        rubbing |= !is_switch;
    }
    if (!bg_is_empty(held))
        status = bg_strike_in_step(c, m->mode, ways);
    if (status == BG_OK && rubbing)
        status = bg_stick(m, &c->at);
    if (status == BG_OK)
        status = bg_held(m, &c->at);
    if (status != BG_OK) {
        c->why = c->why ? c->why : status;
        return status == BG_NEEDS_SLOPE || status == BG_STRUCTURE ? status : BG_OK;
    }
    *broken = contrary(c, ways);
    *holds = bg_is_empty(broken);
    return BG_OK;
}

int bg_search_ways(step_search *c, const int *before)
{
    bg_set switches = {{0}}, guarded = {{0}}, first = {{0}};
    int holds;
    for (int i = 0; i < K; i++)
        if (bg_switches[i].kind != BG_RUBS && !bg_has(&c->barred, i)) {
            bg_add(&switches, i);
            if (bg_switches[i].kind == BG_TOLD)
                bg_add(&guarded, i);
            if (before[i] == 0)
                bg_add(&first, i);
        }
    const int status = bg_try_ways(K, &switches, &guarded, first, try_in_step, c, &holds);
    for (int i = 0; i < K && holds; i++)
        c->given[i] += c->tried[i];
    if (status == BG_OK && holds)
        return BG_OK;
    memcpy(c->s, c->begun, sizeof c->begun);
    return status ? status : c->why ? c->why : BG_UNDECIDED;
}

static int search_once(step_search *c, const int *before)
{
    return BG_STOPPING  ? bg_search_struck(c)
        : BG_SWITCHES ? bg_search_ways(c, before)
                      : bg_stick(c->m, &c->at);
}

int bg_decide_step(bg_model *m, double t, double h, double *s, const double *w)
{
    int before[BG_ROOM(K)], old[BG_ROOM(K)], again = BG_RESETS && m->started;
    step_search c = {.m = m, .s = s, .at = {t, h, s, w, m->work.rates[0], before, m->started}};
    memcpy(before, m->mode, sizeof before);
    memcpy(old, m->mode, sizeof old);
    double begun[BG_SIZE];
    memcpy(c.begun, s, sizeof c.begun);
    memcpy(begun, s, sizeof begun);
    int status = search_once(&c, before);
    for (int k = 0; status == BG_OK && again; k++) {
        status = k < BG_RENEWALS ? bg_set_in_step(&c, before, &again) : BG_SET_ENDLESSLY;
        if (status == BG_OK && again)
            status = search_once(&c, before);
    }
    if (status == BG_OK) {
        m->started = 1;
        return BG_OK;
    }
    memcpy(s, begun, sizeof begun);
    memcpy(m->mode, old, sizeof old);
    return status;
}
