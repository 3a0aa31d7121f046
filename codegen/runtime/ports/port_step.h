/* What the files of a step's choice of mode share. */
#ifndef BG_PORT_STEP_H
#define BG_PORT_STEP_H

#include "model_internal.h"
#include "port_choosing.h"

/* A search: the start of the step, with s after impulses; s before them; stops that stay apart. Of
 * those that are met `depth`: how far beyond their bounds displacements were. `given`: what ports
 * have given of impulses, but for what stops have thrown back, which `back` tells. */
typedef struct {
    bg_model *m;
    bg_start at;
    double *s, begun[BG_SIZE], struck[BG_SIZE], depth[BG_ROOM(BG_FRICTION)];
    double given[BG_ROOM(BG_FRICTION)];
    bg_set barred, back;
} step_search;

/* port_settle.c: a mode in which nothing contradicts that in m->shot, but for switches that are
 * sent; whether it is another; ports are `stopped` that come to hold as they move. BG_PIVOTS where
 * that was not decided. */
int bg_settle_ways(step_search *c, const bg_set *sent, int *stopped, int *changed);

/* port_step.c: a mode in m->mode and m->shot; a step that has none leaves all as it was. */
int bg_search_ways(step_search *c, const int *before);

/* port_step.c: s after the impulses of what switches hold in a mode; how far these go with it. */
int bg_strike_in_step(step_search *c, const int *mode, double *ways);

/* port_step_reset.c: what s becomes at the place of each reset, a status. */
int bg_become_in_step(bg_model *m, const bg_start *at, double *values);

/* port_step_reset.c: sets what states are reset to at the events from the mode before to the
 * present one, which then is that before; `any`: whether there were such. A status. */
int bg_set_in_step(step_search *c, int *before, int *any);

/* port_step_stop.c: the same where stops may be met: what joins first, then what closes is thrown
 * back; again until nothing closes. */
int bg_search_struck(step_search *c);

#endif
