/* What the files of event-located runs share. */
#ifndef BG_MODEL_LOCATED_INTERNAL_H
#define BG_MODEL_LOCATED_INTERNAL_H

#include "model_internal.h"
#include "model_located.h"

/* model_located.c: everything at t and s in the present segment and a mode, in c->shot; rates. */
int bg_located_look(bg_located *c, double t, const double *s, const signed char *mode);
int bg_located_rate(bg_located *c, double t, const double *s, double *rate);

/* model_rounding.c */
double bg_slip_rate(const bg_model *m, const bg_snapshot *shot, int port);
void bg_located_rounding(bg_located *c, double t, bg_rounding *size);
int bg_located_see(bg_located *c);
int bg_located_jacobian(bg_located *c, double t, const double *s, double *jacobian);
int bg_located_fastest(bg_located *c, double t, const double *s, double *fastest);

int bg_located_calm(bg_located *c, double *fastest);

/* model_progress.c: BG_STEPS where lots of steps go nowhere, at a jump of the rates. */
void bg_progress_begin(bg_located *c);
int bg_progress_check(bg_located *c);

/* model_decide.c: the mode just after c->t, sticking slips removed. */
int bg_located_decide(bg_located *c);

/* model_watch.c: triggers from c->t on; the first event of the solver's latest step: 1 in *found,
 * with its time and ports. */
int bg_watch_begin(bg_located *c);
int bg_watch_step(bg_located *c, int *found, double *time, signed char *ports);

/* model_solver.c: one step that keeps the tolerance, and the state anywhere inside it. */
int bg_solver_begin(bg_located *c, int method, double longest);
int bg_solver_step(bg_located *c, double stop);
int bg_solver_dense(bg_located *c, double t, double *s);

/* model_explicit.c, model_implicit.c */
int bg_explicit_step(bg_located *c, double stop);
int bg_explicit_dense(bg_located *c);
void bg_explicit_at(const bg_solver *solver, double t, double *s);
int bg_implicit_step(bg_located *c, double stop);
void bg_implicit_at(const bg_solver *solver, double t, double *s);

#endif
