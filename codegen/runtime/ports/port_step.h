/* What the files of a step's choice of mode share. */
#ifndef BG_PORT_STEP_H
#define BG_PORT_STEP_H

#include "model_internal.h"
#include "port_choosing.h"

/* A search: the start of the step, with s after the impulses of the way that is tried; s before
 * them; switches that stay as they are; why there is no mode. Of stops that are met `depth`: how far
 * beyond their bounds displacements were. */
typedef struct {
    bg_model *m;
    bg_start at;
    double *s, begun[BG_SIZE], struck[BG_SIZE], depth[BG_ROOM(BG_FRICTION)];
    bg_set barred;
    int why;
} step_search;

/* port_step_stop.c: the stops that are met, with their gaps closed; the others are barred. Those of
 * them that bounce. What these throw back. Statuses. */
int bg_meet_in_step(step_search *c, bg_set *met);
int bg_closing_in_step(step_search *c, const bg_set *met, bg_throw *wanted);
int bg_throw_in_step(step_search *c, const bg_throw *wanted, int *thrown);

#endif
