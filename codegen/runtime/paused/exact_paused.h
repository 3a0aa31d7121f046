/* Exact runs that pause, for whoever steps a model from outside. */
#ifndef BG_EXACT_PAUSED_H
#define BG_EXACT_PAUSED_H

#include "exact.h"

typedef struct ex_paused ex_paused;

/* The sizes in bytes of a paused run, and of what is told of it as numbers, which begin with what
 * affine maps act on at the present instant, EX_L of them. */
void ex_paused_sizes(unsigned long *sizes);

/* Begins at the first of a task's times, and pauses there; goes on to `stop` as BG_GO_ON or
 * BG_GO_ANEW tells, `renewed`: whether inputs were written since; looks at the present instant
 * again. A status; the place of the mode is the first of the task's modes. */
int ex_pause_first(ex_context *c, const ex_model *model, const ex_inputs *inputs, ex_task *task,
                   ex_paused *to);
int ex_pause_next(ex_context *c, const ex_model *model, const ex_inputs *inputs, ex_task *task,
                  const ex_paused *from, ex_paused *to, double stop, int how, int renewed);
int ex_pause_look(ex_context *c, const ex_model *model, const ex_inputs *inputs, ex_task *task,
                  ex_paused *p);

/* A paused run as numbers, or as it was where it was told. */
void ex_pause_carry(ex_paused *p, double *numbers, int back);

#endif
