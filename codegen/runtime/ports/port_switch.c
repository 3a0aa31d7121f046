/* What keeps a switch; one consistent mode at one instant, where some ports are switches. */
#include <string.h>

#include "port_choosing.h"
#include "port_ways.h"

int bg_condition(const bg_switch *s, int sign)
{
    return s->guard + (s->on == (sign == 0));
}

double bg_stay(const bg_switch *s, int sign, double slip, double effort, const double *guards)
{
    if (s->kind == BG_TOLD)
        return -guards[bg_condition(s, sign)];
    return sign ? s->side * slip : -s->side * effort;
}

int bg_is_apart(const bg_switch *s, int sign)
{
    return s->kind == BG_STOPS && s->on == (sign == 0);
}

int bg_hangs(const bg_switch *s)
{
    return s->order == 2;
}

/* A search among the ways of the switches. `mode`: what is found. */
typedef struct {
    bg_choice choice;
    const int *before;
    bg_set switches;
    int *mode;
} bg_search;

/* Tries one way: the switches that contradict it go to *broken; *holds with its mode. */
static int try_way(void *self, const bg_set *held, int *holds, bg_set *broken)
{
    bg_search *const search = self;
    bg_choice *const choice = &search->choice;
    const bg_sight *const c = choice->sight;
    int tried[BG_MOST_PORTS];
    for (int i = 0; i < c->ports; i++)
        tried[i] = bg_has(&search->switches, i) ? !bg_has(held, i) : search->before[i];
    choice->blow = (bg_blow){0};
    choice->s = c->struck;
    memcpy(choice->s, choice->at->s, sizeof(double) * (size_t)c->size);
    int status = BG_OK, any = 0;
    for (int i = 0; i < c->ports; i++)
        any |= tried[i] == 0 && c->switches[i].kind != BG_RUBS;
    if (any)
        status = c->strike(c->self, choice->at, tried, NULL, choice->s, &choice->blow);
    if (status) {
        choice->why = choice->why ? choice->why : status;
        return status != BG_NOT_AFFINE && bg_ends_search(status) ? status : BG_OK;
    }
    status = bg_choose_rubbing(choice, tried, holds, broken);
    for (int i = 0; i < c->ports && *holds; i++)
        search->mode[i] = tried[i];
    return status;
}

/* The mode, where some ports are switches. */
static int choose_switched(bg_search *search, int *holds)
{
    const bg_sight *const c = search->choice.sight;
    bg_set first = {{0}}, guarded = {{0}};
    for (int i = 0; i < c->ports; i++) {
        if (c->switches[i].kind == BG_RUBS || bg_has(&search->choice.barred, i))
            continue;
        bg_add(&search->switches, i);
        if (c->switches[i].kind == BG_TOLD)
            bg_add(&guarded, i);
        if (search->mode[i] == 0)
            bg_add(&first, i);
    }
    return bg_try_ways(c->ports, &search->switches, &guarded, first, try_way, search, holds);
}

int bg_choose_once(const bg_sight *c, const bg_instant *at, const bg_set *barred, int *mode,
                   bg_blow *blow)
{
    int before[BG_MOST_PORTS], holds = 0;
    bg_set broken;
    bg_search search = {
        .choice = {.sight = c, .at = at, .s = at->s, .barred = *barred},
        .before = before, .mode = mode};
    memcpy(before, mode, sizeof(int) * (size_t)c->ports);
    const int status = c->switches ? choose_switched(&search, &holds)
                                   : bg_choose_rubbing(&search.choice, mode, &holds, &broken);
    if (status || !holds)
        return status ? status : search.choice.why;
    *blow = search.choice.blow;
    if (blow->struck)
        memcpy(at->s, search.choice.s, sizeof(double) * (size_t)c->size);
    for (int i = 0; i < c->ports && blow->struck && at->log; i++)
        at->log->given[i] += blow->given[i];
    return BG_OK;
}

int bg_choose_mode(const bg_sight *c, const bg_instant *at, int *mode)
{
    const bg_set none = {{0}};
    bg_instant again = *at;
    bg_blow blow = {0};
    if (c->stopping)
        return bg_choose_struck(c, at, mode);
    int status = bg_choose_once(c, at, &none, mode, &blow);
    memset(again.touched, 0, sizeof again.touched);
    /* What passed an impulse may well not stay as it was for that. */
    for (int k = 0; k < BG_IMPACTS && status == BG_OK && blow.struck; k++)
        status = bg_choose_once(c, &again, &none, mode, &blow);
    return status;
}
