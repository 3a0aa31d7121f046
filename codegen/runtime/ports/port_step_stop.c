/* Stops at the start of a step: one is met where its gap is closed, or would be within the step at
 * its present rate. The gap is closed then, at the speed that what meets it will have there; what
 * would be back within a step stays. Times of impacts are those of steps. */
#include <math.h>
#include <string.h>

#include "port_step.h"

static int look_in_step(void *self, double t, const double *s, const int *mode)
{
    const step_search *const c = self;
    bg_start at = c->at;
    at.t = t;
    at.s = s;
    return bg_look(c->m, &at, mode);
}

static void tell_in_step(void *self, const int *mode, const bg_instant *at, bg_port *ports,
                         bg_ruling *ruling)
{
    const step_search *const c = self;
    (void)mode, (void)at, (void)ruling;
    for (int i = 0; i < K; i++)
        ports[i] = (bg_port){.slip = c->m->shot.y[bg_friction_readings[i]]};
}

/* As `bg_sight` tells it; only ever with speeds. */
static int throw_in_step(void *self, const bg_instant *at, const int *mode, const double *speeds,
                         double *s, bg_blow *blow)
{
    step_search *const c = self;
    double impulses[PORTS * PORTS], ways[PORTS] = {0};
    bg_hold *held = NULL;
    int loose[BG_MOST_PORTS];
    (void)at;
    blow->struck = 0;
    memset(blow->given, 0, sizeof blow->given);
    for (int i = 0; i < BG_MOST_PORTS; i++)
        loose[i] = 1;
    int status = bg_look_slipping(c->m, &c->at, loose);
    if (status == BG_OK)
        status = bg_impulses(c->m, mode, &held, impulses);
    if (status || !held || held->kept == 0)
        return status;
    status = bg_stop(c->m, &c->m->shot, mode, held, impulses, speeds, s, blow->given, ways);
    if (status)
        return status;
    bg_round_struck(c->m, &c->m->shot, blow->given, BG_STEP_ROUNDING, blow->near);
    blow->struck = 1;
    return BG_OK;
}

/* The stops that are met, their gaps closed; the others are barred. */
static int meet_in_step(step_search *c, bg_set *met)
{
    double guards[BG_ROOM(BG_GUARDS)] = {0};
    bg_model *const m = c->m;
    const int status = bg_look_slipping(m, &c->at, c->at.before);
    memset(met, 0, sizeof *met);
    if (status != BG_OK)
        return status;
    bg_guards(&m->now, guards);
    for (int i = 0; i < K; i++) {
        const bg_switch *const one = bg_switches + i;
        if (one->kind != BG_STOPS)
            continue;
        const double gap = guards[one->guard], place = c->begun[one->place];
        const double size = fabs(place) + fabs(gap - one->opening * place);
        const double then = gap + c->at.h * one->opening * m->shot.rate[one->place];
        if (bg_is_apart(one, c->at.before[i]) && gap > BG_STEP_ROUNDING * size && then > 0.0) {
            bg_add(&c->barred, i);
            continue;
        }
        bg_add(met, i);
        c->depth[i] = -gap;
        c->begun[one->place] -= one->opening * gap;
    }
    memcpy(c->s, c->begun, sizeof c->begun);
    return BG_OK;
}

/* Those among some of them that bounce. */
static int closing_in_step(step_search *c, bg_set met, bg_throw *wanted)
{
    double guards[BG_ROOM(BG_GUARDS)] = {0}, terms, moves;
    bg_model *const m = c->m;
    memset(wanted, 0, sizeof *wanted);
    const int status = bg_look_slipping(m, &c->at, m->mode);
    if (status != BG_OK)
        return status;
    bg_guards(&m->now, guards);
    for (int i = 0; i < K; i++) {
        const bg_switch *const one = bg_switches + i;
        if (!bg_has(&met, i) || one->on || !bg_is_apart(one, m->mode[i]))
            continue;
        const double slip = one->side * bg_slip(m, &m->shot, i, &terms);
        const double push = one->side * bg_slip_rate(m, &m->shot, i, &moves);
        const double square = fmax(0.0, slip * slip + 2.0 * push * c->depth[i]);
        const double speed = guards[one->guard + 1] * sqrt(square);
        if (slip >= -BG_STEP_ROUNDING * terms || 2.0 * speed <= c->at.h * fmax(0.0, -push))
            continue;
        bg_add(&wanted->ports, i);
        wanted->speed[i] = speed;
    }
    return BG_OK;
}

/* What these throw back. */
static int give_back(step_search *c, const bg_throw *wanted, int *thrown)
{
    const bg_sight sight = {
        .self = c, .size = BG_SIZE, .ports = K, .switches = bg_switches, .stopping = 1,
        .struck = c->struck, .look = look_in_step, .tell = tell_in_step, .strike = throw_in_step};
    const bg_instant at = {.t = c->at.t, .s = c->s};
    bg_blow blow = {0};
    const int status = bg_throw_back(&sight, &at, c->m->mode, wanted, &blow);
    *thrown = status == BG_OK && blow.struck;
    if (*thrown)
        memcpy(c->s, c->struck, sizeof c->struck);
    for (int i = 0; i < K && *thrown; i++) {
        if (bg_has(&wanted->ports, i) && blow.given[i] != 0.0)
            bg_add(&c->back, i);
        else
            c->given[i] += blow.given[i];
    }
    memset(c->depth, 0, sizeof c->depth);
    return status;
}

/* Whether impulses of what joins have changed s. */
static int has_joined(const step_search *c)
{
    int any = 0;
    for (int i = 0; i < BG_SIZE; i++)
        any |= c->s[i] != c->begun[i];
    return any;
}

int bg_search_struck(step_search *c)
{
    bg_set met;
    bg_throw wanted;
    int thrown = 1, status = meet_in_step(c, &met);
    const bg_set apart = c->barred;
    for (int turn = 0; turn < BG_BOUNCES && status == BG_OK; turn++) {
        int before[BG_ROOM(K)];
        memcpy(before, c->m->mode, sizeof before);
        status = closing_in_step(c, met, &wanted);
        c->barred = bg_turned(apart, &wanted.ports);
        if (status == BG_OK)
            status = bg_search_ways(c, before);
        const int joined = has_joined(c);
        if (status == BG_OK)
            status = closing_in_step(c, wanted.ports, &wanted);
        thrown = !bg_is_empty(&wanted.ports);
        if (status == BG_OK && thrown)
            status = give_back(c, &wanted, &thrown);
        if (status == BG_OK && !thrown && !joined)
            return BG_OK;
        memcpy(c->begun, c->s, sizeof c->begun);
    }
    return status ? status : BG_STRUCK;
}
