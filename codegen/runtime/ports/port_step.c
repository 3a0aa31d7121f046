/* The mode of a step: what ports give and receive decides, and conditions of switches; what comes
 * to hold gives its impulse. */
#include <math.h>
#include <string.h>

#include "port_step.h"

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
    double impulses[PORTS * PORTS], slips[PORTS];
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
        double given[PORTS] = {0};
        status = bg_stop(m, &m->shot, mode, held, impulses, NULL, c->s, given, ways);
        if (status)
            return status;
        for (int i = 0; i < K; i++)
            c->given[i] += given[i];
    }
    return BG_OK;
}

/* Switches whose conditions change them over: above zero, or at zero and above it in the step. */
static bg_set sent(step_search *c)
{
    bg_model *const m = c->m;
    double told[BG_ROOM(BG_GUARDS)] = {0}, near[BG_ROOM(BG_GUARDS)] = {0};
    bg_set found = {{0}}, tied = {{0}};
    bg_guards(&m->now, told);
    bg_told_terms(m, near);
    for (int i = 0; i < K; i++) {
        const int at = bg_condition(bg_switches + i, m->mode[i]);
        if (bg_switches[i].kind != BG_TOLD)
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
    int status = bg_look(m, &later, m->mode);
    if (status == BG_OK)
        bg_guards(&m->now, told);
    /* Back to the start, which the rest is about. */
    if (bg_look(m, &c->at, m->mode) != BG_OK || status != BG_OK)
        return found;
    for (int i = 0; i < K; i++) {
        const int at = bg_condition(bg_switches + i, m->mode[i]);
        if (bg_has(&tied, i) && told[at] > BG_STEP_ROUNDING * near[at])
            bg_add(&found, i);
    }
    return found;
}

/* Everything in the mode or, where that has no values, in the first that has, which it becomes. */
static int look_any(step_search *c)
{
    int tried[BG_MOST_PORTS] = {0};
    const int first = bg_look(c->m, &c->at, c->m->mode);
    if (first == BG_OK || bg_look_any(c->m, &c->at, c->m->mode, tried) != BG_OK)
        return first;
    memcpy(c->m->mode, tried, sizeof c->m->mode);
    return BG_OK;
}

/* The mode from which a search begins: as before, stops that are barred apart; where no step was
 * before, friction turns as it slips, and what is at rest holds. */
static void begin_mode(step_search *c, const int *before)
{
    bg_model *const m = c->m;
    int loose[BG_MOST_PORTS], looks = 0;
    for (int i = 0; i < K; i++) {
        const int rubs = bg_switches[i].kind == BG_RUBS;
        m->mode[i] = rubs && !c->at.started ? 1
            : bg_has(&c->barred, i)         ? !bg_switches[i].on
                                            : before[i];
        looks |= rubs && !c->at.started;
        loose[i] = 1;
    }
    if (!looks || bg_look_slipping(m, &c->at, loose) != BG_OK)
        return;
    for (int i = 0; i < K; i++) {
        double terms;
        const double slip = bg_slip(m, &m->shot, i, &terms);
        if (bg_switches[i].kind == BG_RUBS)
            m->mode[i] = fabs(slip) <= BG_STEP_ROUNDING * terms ? 0 : slip > 0 ? 1 : -1;
    }
}

static int any_switch_held(const int *mode)
{
    int any = 0;
    for (int i = 0; i < K; i++)
        any |= bg_switches[i].kind != BG_RUBS && mode[i] == 0;
    return any;
}

/* Whether switches change over again and again, or let go by what they have stopped. */
static int goes_round(const bg_set *found, const int *stopped, int *turns)
{
    int round = 0;
    for (int i = 0; i < K; i++)
        round |= bg_has(found, i) && (++turns[i] > 2 || stopped[i]);
    return round;
}

int bg_search_ways(step_search *c, const int *before)
{
    bg_model *const m = c->m;
    int turns[PORTS] = {0}, stopped[PORTS] = {0}, changed = 1;
    int status = BG_OK, decided = BG_OK;
    memcpy(c->s, c->begun, sizeof c->begun);
    begin_mode(c, before);
    for (int round = 0; round < BG_ROUNDS && status == BG_OK && changed; round++) {
        double ways[PORTS] = {0};
        bg_set told = {{0}};
        status = look_any(c);
        if (status == BG_OK && BG_GUARDS) {
            told = sent(c);
            status = goes_round(&told, stopped, turns) ? BG_UNDECIDED : BG_OK;
        }
        if (status == BG_OK)
            decided = bg_settle_ways(c, &told, stopped, &changed);
        if (status == BG_OK && changed && any_switch_held(m->mode))
            status = bg_strike_in_step(c, m->mode, ways);
    }
    if (status == BG_OK && changed)
        status = bg_look(m, &c->at, m->mode);
    m->decided = status == BG_OK ? decided : BG_OK;
    if (status != BG_OK)
        memcpy(c->s, c->begun, sizeof c->begun);
    return status;
}

static int search_once(step_search *c, const int *before)
{
    return BG_STOPPING ? bg_search_struck(c) : bg_search_ways(c, before);
}

int bg_decide_step(bg_model *m, double t, double h, double *s, const double *w)
{
    int before[BG_ROOM(K)], old[BG_ROOM(K)], again = BG_RESETS > 0;
    step_search c = {.m = m, .at = {t, h, s, w, m->work.rates[0], before, m->started}, .s = s};
    memcpy(before, m->mode, sizeof before);
    memcpy(old, m->mode, sizeof old);
    double begun[BG_SIZE];
    memcpy(c.begun, s, sizeof c.begun);
    memcpy(begun, s, sizeof begun);
    int status = search_once(&c, before);
    for (int k = 0; k <= BG_RENEWALS && status == BG_OK && again; k++) {
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
