/* Event-located runs of a generated model: integrated with step control between breakpoints of the
 * inputs, sticking, release and zero crossings, each located by its root. Nothing is allocated and
 * nothing is global: the caller provides a `bg_located` for each run at a time. */
#ifndef BG_MODEL_LOCATED_H
#define BG_MODEL_LOCATED_H

#include "located_request.h"
#include "port_sight.h"
#include "run_loop.h"

enum { BG_EXPLICIT_STAGES = 16 };

/* One step of an integrator, and what its interpolation needs. `doubts`: so many explicit steps are
 * judged warily; `before`: what the third power of the latest one's length makes its estimate. */
typedef struct {
    int method, begun, dense, stale, factored, doubts;
    double t_old, t, h, next, longest, error, before, h_factored;
    double y_old[BG_SIZE], y[BG_SIZE], f_old[BG_SIZE], f[BG_SIZE];
    double stage[BG_EXPLICIT_STAGES][BG_SIZE], tried[BG_SIZE], scale[BG_SIZE];
    double interpolation[7][BG_SIZE], collocation[3][BG_SIZE];
    double jacobian[BG_SIZE * BG_SIZE], real[BG_SIZE * BG_SIZE];
    double complex[4 * BG_SIZE * BG_SIZE];
    int real_pivots[BG_SIZE], complex_pivots[2 * BG_SIZE];
} bg_solver;

/* So many things are watched at a time: ports, or corners. */
enum { BG_WATCHED = BG_ROOM(BG_FRICTION > BG_CORNERS ? BG_FRICTION : BG_CORNERS) };

/* What is watched of each through a stretch: armed when it has risen above what counts as zero;
 * `blind`: in the moment up to then nothing that begins at zero falls. */
typedef struct {
    double blind, limit[BG_WATCHED], before[BG_WATCHED];
    int armed[BG_WATCHED];
} bg_falling;

/* The triggers of a stretch, one for each port, positive while its mode holds: the slip, or the
 * margin to the breakaway effort. */
typedef struct {
    bg_falling of;
    double near[BG_ROOM(BG_FRICTION)]; /* where slips that inputs rule have left zero */
} bg_watch;

/* Corners of laws: what they hang on, as far from zero as on this side; those crossed latest; when
 * they were, and how long they are gone over where that was too often; the largest rate; where
 * the way from corner to corner ends at the latest. */
typedef struct {
    bg_falling of;
    int crossed[BG_WATCHED];
    bg_rounds rounds;
    double over, fastest, stop;
} bg_corner_watch;

/* The steps of a stretch: when the latest lot of them began, and whether the one before went
 * nowhere. */
typedef struct {
    double begin;
    long steps;
    int idle;
} bg_progress;

/* Of the steps of a stretch whose method is chosen: those in a row that speak against it, or of its
 * lot; since when; how many it takes. */
typedef struct {
    double begin;
    long count, patience;
} bg_turns;

/* A stretch: where it ends at the latest, the largest rate at its latest look, its method. */
typedef struct {
    double stop, fastest;
    long steps;
    int method;
} bg_stretch;

/* What works several points out at once, where there is such: the triggers of ports at times inside
 * the latest step; rates at states, by rows, in the present mode. Whether it could. */
enum { BG_AT_ONCE = 8 };
typedef struct {
    void *self;
    int (*triggers)(void *self, int count, const double *times, double (*values)[BG_WATCHED]);
    int (*rates)(void *self, double t, int count, double (*s)[BG_SIZE], double (*rate)[BG_SIZE]);
} bg_together;

/* A run: where it is, what it looks at, the next sample. From a rate `stiff` [1/s] on steps are
 * implicit, where the method is chosen; `ahead` tells the latest time to stop at after t, no later
 * than `stop`, to look what is to be decided; NULL: `stop`. */
typedef struct {
    double stiff, (*ahead)(const void *self, double t, double stop);
    const bg_together *together; /* NULL: one after the other */
    bg_model *model;
    const bg_signals *signals;
    bg_request *asked;
    bg_course run;
    bg_peaks peaks;
    bg_view view;
    double s[BG_SIZE], squares[2][BG_SIZE * BG_SIZE];
    int list[BG_LIST(BG_SIZE, BG_SIZE)];
    double own;                /* the largest rate of an affine model in the mode `rated`, if .. */
    int known, rated[BG_ROOM(BG_FRICTION)]; /* .. it is known */
    bg_stretch stretch;
    int leaves;                /* whether it is left where a stretch begins */
    int next, turned;          /* the next sample; whether rates may have turned since a step */
    bg_watch watch;
    bg_corner_watch corners;
    bg_progress progress;
    bg_turns turns;
    bg_solver solver;
} bg_located;

/* A stretch of a run, for whoever keeps its own instant: set out from t, with c->s, the peaks and
 * the magnitudes of the view as they are and modes before it, and then go to the end; in between
 * the view's inputs, `stiff` and `ahead` may be set. A status. */
void bg_located_set_out(bg_located *c, bg_model *m, const bg_signals *signals, bg_request *asked,
                        double t, double end, const int *first);
int bg_located_go(bg_located *c);

/* The same in two parts: to the end, and what is decided there; the next sample, which is at s. */
int bg_located_arrive(bg_located *c);
int bg_located_finish(bg_located *c);
int bg_located_hand_over(bg_located *c, const double *s);

/* Runs; a status. */
int bg_model_run(bg_located *c, bg_model *m, const bg_signals *signals, bg_request *asked);

#endif
