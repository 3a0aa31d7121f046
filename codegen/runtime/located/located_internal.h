/* What the files of event-located runs share. */
#ifndef BG_LOCATED_INTERNAL_H
#define BG_LOCATED_INTERNAL_H

#include <math.h>

#include "model_internal.h"
#include "model_located.h"

/* By how much a step may be smaller or larger than the one before it. */
#define SHRINK 0.2
#define GROW 10.0

/* located_run.c: rates of s at t in the present segment and mode. */
int bg_located_rate(bg_located *c, double t, const double *s, double *rate);

/* A status of whoever goes from a turn to the next by itself. */
enum { BG_AWAY = -1 };

/* The parts of a run: sets it up; in turns, decides where it is and where the stretch from there
 * ends at the latest, until it is at its end; what is decided there, and the last sample. */
int bg_located_begin(bg_located *c, bg_model *m, const bg_signals *signals, bg_request *asked);
int bg_located_turn(bg_located *c, double *stop);
int bg_located_end(bg_located *c);

/* located_rates.c: how rates change with the states, by rows; the largest rate, of the inputs too;
 * that at the present instant, a jump beside it left aside. */
int bg_located_jacobian(bg_located *c, double t, const double *s, double *jacobian);
int bg_located_fastest(bg_located *c, double t, const double *s, double *fastest);
int bg_located_calm(bg_located *c, double *fastest);

/* located_progress.c: BG_STEPS where lots of steps go nowhere, at a jump of the rates. */
void bg_progress_begin(bg_located *c);
int bg_progress_check(bg_located *c);

/* located_turns.c: whether the other method goes on from the latest step, where it may. */
void bg_turns_begin(bg_located *c);
int bg_turns_over(bg_located *c, double fastest, double stop);

/* located_watch.c: triggers from c->t on; the first event of the solver's latest step: its time,
 * which is infinite where there is none, and ports. */
int bg_watch_begin(bg_located *c);
int bg_watch_step(bg_located *c, double *time, int *ports);

/* located_corner.c, where laws have any: which side of each laws are on from the present instant
 * on, at the largest rate `fastest`; how corners are watched from there; the first that are crossed
 * in the solver's latest step, as events are; on which side laws are after these; how
 * far what they hang on is from zero on this side. */
int bg_corners_begin(bg_located *c, double fastest);
int bg_corners_watch(bg_located *c, double fastest);
int bg_corners_step(bg_located *c, double *time);
int bg_corners_cross(bg_located *c);
void bg_corners_away(const bg_values *now, double *values);

/* located_remember.c: what delays read in the latest step, up to a time. */
int bg_located_remember(bg_located *c, double until);

/* located_sides.c: as a stretch, from corner to corner. located_run.c: from the present instant to
 * `stop`, or to the first event, or corner where laws are on one side of each: that in `ended`, 0
 * where there is none. Its first step is tried as long as `first`, if that is above zero. */
enum { BG_AT_EVENT = 1, BG_AT_CORNER };
int bg_corners_go(bg_located *c, double stop);

/* Its parts: which sides it sets off on, to `stop`; after a stretch whether `more` follow, with a
 * first step tried so long: it ended at a corner that is crossed. Once none does laws are as they
 * are again. */
int bg_corners_set_off(bg_located *c, double stop);
int bg_corners_follow(bg_located *c, int *ended, double *first, int *more);
int bg_located_stretch(bg_located *c, double stop, double first, int *ended);

/* Its parts: to set off; the rest of it, step by step, or, if not the `whole`, as far as steps are
 * implicit; of each step what the solver's latest one
 * passes, events and samples, up to its end; c->s there; and how to go on from there. */
int bg_located_set_off(bg_located *c, double stop, double first);
int bg_located_rest(bg_located *c, int whole, int *ended);
int bg_located_pass(bg_located *c, int *ended);
void bg_located_reach(bg_located *c, double t, const double *s);
int bg_located_go_on(bg_located *c);

/* located_fall.c: so many triggers of something inside a step, each positive until its event; a
 * status. Whether none falls in a step, as its ends and its middle tell, which is noted
 * then. The
 * first time in a step at which one falls, infinite where none does, and which do. */
typedef struct {
    void *self;
    int (*at)(void *self, double t, double *values), count;
    const bg_together *together; /* NULL, or what tells them at several times at once */
} bg_triggers;
int bg_passes(const bg_falling *f, int count, const double *middle, const double *end);
void bg_note_pass(bg_falling *f, int count, const double *end);
int bg_first_fall(bg_falling *f, const bg_triggers *of, double begin, double end, double *time,
                  int *which);

/* located_dip.c: 1 where what is above zero at points k and k + 1, of `count`, is not at one
 * between them, which is found. */
int bg_dip(double (*above)(void *self, double at), void *self, int count, const double *times,
           const double *values, int k, double *found);

/* The mean of values over scales, which repeat. */
static inline double bg_norm(int count, const double *values, const double *scale)
{
    double sum = 0.0;
    for (int i = 0; i < count; i++)
        sum += values[i] / scale[i % BG_SIZE] * (values[i] / scale[i % BG_SIZE]);
    return sqrt(sum / count);
}

/* located_solver.c: steps to no later than `stop` that keep the tolerance, and the state anywhere
 * in the latest. */
int bg_solver_begin(bg_located *c, int method, double longest, double stop);
int bg_solver_step(bg_located *c, double stop);
int bg_solver_dense(bg_located *c, double t, double *s);

/* located_explicit.c, located_implicit.c. Of explicit steps: the shortest there is; the error of
 * one over what the tolerance allows, below 1 if it is good, from the sums of squares of its
 * estimates of order 5 and 3; by what it is shortened if it is not; takes it, up to `end`, and says
 * how long the next may be, longer by `grow` at the most. */
double bg_explicit_least(const bg_solver *s);
double bg_explicit_judge(bg_solver *s, double fifth, double third, double h);
double bg_explicit_shorter(double error);
void bg_explicit_take(bg_solver *s, double end, double h, double error, double grow);
int bg_explicit_step(bg_located *c, double stop);
int bg_explicit_dense(bg_located *c);
void bg_explicit_at(const bg_solver *solver, double t, double *s);
int bg_implicit_step(bg_located *c, double stop);
void bg_implicit_at(const bg_solver *solver, double t, double *s);

#endif
