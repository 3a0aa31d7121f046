/* What switches and stops set states to at the start of a step. */
#include <math.h>
#include <string.h>

#include "port_step.h"

/* The stops that threw back, or took a shock and are as they were. */
static bg_set hits_in_step(const step_search *c, const int *before)
{
    const double largest = bg_largest(K, c->given);
    bg_set found = c->back;
    for (int i = 0; i < K; i++)
        if (bg_switches[i].kind == BG_STOPS && c->m->mode[i] == before[i]
            && fabs(c->given[i]) > BG_ROUNDING * largest)
            bg_add(&found, i);
    return found;
}

/* Whether what switches hold both ways would have to be stopped; a status. */
static int check_set(step_search *c)
{
    int held[BG_ROOM(K)], any = 0;
    double ways[PORTS] = {0}, set[BG_SIZE];
    for (int i = 0; i < K; i++) {
        held[i] = bg_switches[i].kind == BG_RUBS || bg_switches[i].side ? 1 : c->m->mode[i];
        any |= held[i] == 0;
    }
    if (!any)
        return BG_OK;
    memcpy(set, c->s, sizeof set);
    int struck = 0;
    const int status = bg_strike_in_step(c, held, ways);
    for (int i = 0; i < BG_SIZE; i++)
        struck |= set[i] != c->s[i];
    memcpy(c->s, set, sizeof set);
    return status ? status : struck ? BG_SET_HELD : BG_OK;
}

int bg_become_in_step(bg_model *m, const bg_start *at, double *values)
{
    double guards[BG_ROOM(BG_GUARDS)];
    const int status = bg_look(m, at, m->mode);
    if (status)
        return status;
    bg_guards(&m->now, guards);
    for (int r = 0; r < BG_RESETS; r++) {
        const int place = bg_resets[r].place;
        const double state = place < N ? m->shot.x[place] : at->s[place];
        values[r] = guards[bg_resets[r].value] + (at->s[place] - state);
    }
    return BG_OK;
}

int bg_set_in_step(step_search *c, int *before, int *any)
{
    const bg_set hit = hits_in_step(c, before);
    double values[BG_MOST_RESETS] = {0};
    int fired[BG_MOST_RESETS];
    bg_take_first(bg_switches, K, before, c->m->mode);
    *any = bg_find_fired(bg_resets, BG_RESETS, bg_switches, before, c->m->mode, &hit,
                         !c->at.started, fired);
    c->at.started = 1;
    if (!*any)
        return BG_OK;
    int status = bg_become_in_step(c->m, &c->at, values);
    if (status == BG_OK)
        status = bg_set_states(bg_resets, BG_RESETS, fired, values, c->s);
    memcpy(before, c->m->mode, sizeof(int) * K);
    if (status == BG_OK)
        status = check_set(c);
    memcpy(c->begun, c->s, sizeof c->begun);
    memset(&c->barred, 0, sizeof c->barred);
    memset(&c->back, 0, sizeof c->back);
    memset(c->given, 0, sizeof c->given);
    return status;
}
