/* What the files of the engine share. */
#ifndef BG_INTERNAL_H
#define BG_INTERNAL_H

#include "bg_engine.h"
#include "bg_extremes.h"
#include "bg_pair.h"
#include "bg_choose.h" /* after the engine, which says whose sizes are meant */
#include "bg_rounds.h"

enum {
    BG_DEGREE = 18,       /* of power series; over |M| h <= 1 what is left out is below rounding */
    BG_RENEWAL = 16,      /* steps for which a bound on fourth derivatives holds */
    BG_RUNGS = 62,        /* beyond, rounding of pairs would show: 2^62 of them are 1e-13 */
    BG_KEPT = BG_K > 0 ? 1 : BG_RUNGS,
    BG_F = BG_Z + BG_W + 1 /* state where nothing is watched */
};

#if defined(__GNUC__)
#define BG_ALIGNED __attribute__((aligned(BG_ALIGNMENT)))
#else
#define BG_ALIGNED
#endif

#define BG_LONGEST 2.5     /* |M| h of one step of a leap: bounds need its square below 8 */
#define BG_ROUNDED 1e4     /* so many steps in double precision leave all digits that count */
#define BG_MANY 3e5        /* so many steps are always taken where something is watched .. */
#define BG_LEAST_PART 0.01 /* .. of more, unless a smaller part follows what has not decayed .. */
#define BG_MOST 1e11       /* .. up to some hours' */
#define BG_GONE 40.0       /* after so many of its time constants a motion is below rounding */

/* A mode with a generator, z' = M z + .., and its exponentials for one step. By columns. */
typedef struct {
    const bg_mode *mode;
    int number;
    long long parts;
    unsigned caps;                      /* a bit for each trigger that is only a cap */
    bg_chains chains;
    double norm;                        /* of M, in a sum weighted by `weight` */
    double h, step;                     /* between samples, and its part that is a step */
    double weight[BG_Z], M[BG_Z][BG_Z];
    double trigger[BG_Z][BG_TRIGGERS];
    double gather[BG_Z][BG_Z];          /* the integral of the exponential over a step */
    BG_ALIGNED double leap[BG_STRIDE][BG_Z][BG_ROW];
    double fourth[BG_Z][BG_TRIGGERS];   /* h^4/384 times bounds on fourth derivatives, per rate */
} bg_entry;

/* A stretch between events and breakpoints: constant parts, and what rounding is in triggers. */
typedef struct {
    bg_entry *entry;
    double t, blind, b[BG_Z], level[BG_TRIGGERS], limit[BG_TRIGGERS];
    BG_ALIGNED double constant[BG_STRIDE][BG_ROW];
    BG_ALIGNED double origin[BG_ROW];
    int armed[BG_TRIGGERS], leaping;
} bg_stretch;

/* exp(M h) for h of 1, 2, 4, .. units, of a mode and a generator; by columns. */
typedef struct {
    const bg_mode *mode;
    int known, rungs;
    bg_chains chains;
    double unit, h;                     /* of `leap`, negative if there is none */
    bg_pair M[BG_F][BG_F], leap[BG_F][BG_F], rung[BG_KEPT][BG_F][BG_F];
} bg_ladder;

/* The largest magnitudes seen, and the shortest time constant. */
typedef struct {
    double x[BG_X], u[BG_U], time;
} bg_peaks;

typedef struct {
    double slip[BG_PORTS], effort[BG_PORTS], acceleration[BG_PORTS];
} bg_scales;

typedef double bg_shot[BG_SHOT];

/* Where a stretch has come to. `base`: the sample that is there, -1 if none is. */
typedef struct {
    double t, stop, z[BG_Z];
    int at, last, base;
    unsigned ports;
} bg_place;

/* Goes on to `stop` or the first event; *at is the next sample. A status. */
typedef int bg_advancing(bg_context *c, int *at, double stop);

struct bg_context {
    const bg_model *model;
    const bg_inputs *inputs;
    bg_task *task;
    bg_advancing *advance;
    void *caller;                       /* for `advance` */
    int clock, segment, where;
    double t, s[BG_N], began;
    int known, known_segment;           /* whether `given` holds, for `known_time` */
    double known_time, given[2 * BG_W];
    signed char mode[BG_PORTS], touched[BG_PORTS];
    bg_peaks peaks;
    bg_stretch stretch;
    bg_rounds rounds;
    double work[6][BG_Z][BG_Z];
    double terms[BG_DEGREE + 1][BG_Z], powers[BG_TRIGGERS][BG_DEGREE + 1];
    double scratch[BG_BLOCK + 1][BG_ROW];
    int used[BG_ENTRIES];               /* when each was used last; 0 if it is empty */
    bg_entry entries[BG_ENTRIES];
    bg_ladder ladder;
};

/* bg_inputs.c: the slots at t in a segment; and w and its rate from them. */
void bg_slots(const bg_inputs *inputs, int segment, double t, double *g);
void bg_given(const bg_inputs *inputs, int segment, const double *g, double *w, double *dw);
int bg_segment(const bg_inputs *inputs, double t);

/* The magnitudes of the terms that make up w, with what rounding of t adds. */
void bg_input_sizes(const bg_inputs *inputs, int segment, double t, double *w);

/* bg_modes.c: everything at one instant in a mode; a status. */
int bg_number(const signed char *mode);
int bg_find(bg_context *c, int number, const bg_mode **found);
int bg_rests(const bg_mode *mode, int port);
void bg_vector(bg_context *c, double t, const double *s, double *v);
int bg_look(bg_context *c, double t, const double *s, const bg_mode *mode, double *shot);
void bg_see(bg_context *c, const bg_mode *mode, const double *shot);
void bg_scale(const bg_context *c, const double *shot, double t, bg_scales *size);

/* bg_decide.c: the mode just after t, where `time` is the shortest time constant. */
int bg_decide(bg_context *c, double time);

/* bg_system.c: an entry of the cache, without and with exponentials, and stretches. */
int bg_begin(bg_context *c, double stop);
void bg_leaps(bg_context *c, bg_stretch *stretch, double h, const double *row);

/* bg_ladder.c: the ladder of an entry; z after any time, and after one for which an exponential of
 * its own is kept. */
void bg_build(bg_ladder *l, const bg_entry *e);
void bg_climb(bg_ladder *l, double length, bg_pair *z);
void bg_leap_by(bg_ladder *l, double h, bg_pair *z);

/* bg_free.c: to `stop`, where nothing is watched. */
int bg_free(bg_context *c, int *at, double stop);

/* bg_bounds.c: e for steps that divide h, whose exponential goes to E; and bounds on its triggers'
 * fourth derivatives. */
void bg_divide(bg_context *c, bg_entry *e, double h, double (*E)[BG_Z]);
void bg_bound(bg_context *c, bg_entry *e, double (*E)[BG_Z]);

/* bg_exponential.c: exp(M h) and its integral. */
void bg_exponential(bg_context *c, double (*M)[BG_Z], double norm, double h, double (*E)[BG_Z],
                    double (*gather)[BG_Z]);
void bg_multiply(double (*left)[BG_Z], double (*right)[BG_Z], double (*restrict product)[BG_Z]);

/* bg_roots.c: where sum p[k] tau^k falls to zero in (begin, 1]: 1 if it does, 0 if not, -1 if the
 * search has no end. */
int bg_first_fall(const double *p, double begin, double *root);
double bg_value(const double *p, double tau);

/* bg_series.c: from t by `length`, z in place; *port is a bit for each port whose event ended it
 * at *end. */
int bg_series(bg_context *c, double t, double length, double *z, double *end, unsigned *ports);

/* bg_leap.c: steps from rows[0]; how many are certain to be without an event. */
int bg_leap(const bg_stretch *stretch, int count, double (*rows)[BG_ROW]);
void bg_fill(const bg_stretch *stretch, double *row);
void bg_uncertainty(const bg_stretch *stretch, const double *row, double *slack);

/* bg_advance.c: to `stop` or the first event; and its parts. How many steps from the present sample
 * on have one length; whether all triggers are armed; a friction level below zero is refused. */
int bg_advance(bg_context *c, int *at, double stop);
void bg_set_out(const bg_context *c, bg_place *p, int at, double stop);
void bg_arrive(bg_context *c, const bg_place *p, int *at);
int bg_alike(const bg_context *c, const bg_place *p, double *h);
int bg_armed(bg_context *c, const double *row);
int bg_check_levels(bg_context *c, double t, double *row);

/* bg_run.c: a run but for its last sample; a status. */
int bg_run_by(bg_context *c, const bg_model *model, const bg_inputs *inputs, bg_task *task,
              bg_advancing *advance, void *caller);

#endif
