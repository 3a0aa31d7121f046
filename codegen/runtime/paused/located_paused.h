/* Event-located runs that pause, for whoever steps a model from outside. */
#ifndef BG_LOCATED_PAUSED_H
#define BG_LOCATED_PAUSED_H

#include "model_located.h"

typedef struct bg_paused bg_paused;

/* The sizes in bytes of a paused run, which begins with a row as of `bg_rows_run`, and of what is
 * told of it as numbers. */
void bg_paused_sizes(unsigned long *sizes);

/* Makes an instance and begins at `t` with s, in the modes that `asked` tells, and pauses there; goes
 * on to `stop` as BG_GO_ON or BG_GO_ANEW tells; looks at the present instant again. A status. */
int bg_pause_make(bg_model *m, const double *parameters);
int bg_pause_first(bg_located *c, bg_model *m, const bg_signals *signals, bg_request *asked,
                   bg_paused *to, double t, const double *s);
int bg_pause_next(bg_located *c, bg_model *m, const bg_signals *signals, bg_request *asked,
                  const bg_paused *from, bg_paused *to, double stop, int how);
int bg_pause_look(bg_located *c, bg_model *m, const bg_signals *signals, bg_request *asked,
                  bg_paused *p);

/* A paused run as numbers, or as it was where it was told. */
void bg_pause_carry(bg_paused *p, double *numbers, int back);

#endif
