/* What the files of the engine share. */
#ifndef BG_EXACT_INTERNAL_H
#define BG_EXACT_INTERNAL_H

#include "exact.h"
#include "run_extremes.h"
#include "exact_pair.h"
#include "port_rounding.h"
#include "run_loop.h"

enum {
    EX_RENEWAL = 16,      /* steps for which a bound on fourth derivatives holds */
    EX_KEPT = EX_K > 0 ? 1 : BG_RUNGS,
    EX_F = EX_Z + EX_W + 1 /* state where nothing is watched */
};

#if defined(__GNUC__)
#define EX_ALIGNED __attribute__((aligned(EX_ALIGNMENT)))
#else
#define EX_ALIGNED
#endif

/* A mode with a generator, z' = M z + .., and its exponentials for one step. By columns. */
typedef struct {
    const ex_mode *mode;
    ex_key key;
    int place;                          /* of the mode in the model's */
    long long parts;
    int cap[EX_TRIGGERS];               /* whether a trigger is only a cap */
    ex_chains chains;
    double norm;                        /* of M, in a sum weighted by `weight` */
    double h, step;                     /* between samples, and its part that is a step */
    double weight[EX_Z], M[EX_Z][EX_Z];
    double trigger[EX_Z][EX_TRIGGERS];
    double gather[EX_Z][EX_Z];          /* the integral of the exponential over a step */
    EX_ALIGNED double leap[EX_STRIDE][EX_Z][EX_ROW];
    double fourth[EX_Z][EX_TRIGGERS];   /* h^4/384 times bounds on fourth derivatives, per rate */
} ex_entry;

/* A stretch between events and breakpoints: constant parts, and what rounding is in triggers. */
typedef struct {
    ex_entry *entry;
    double t, blind, b[EX_Z], level[EX_TRIGGERS], limit[EX_TRIGGERS];
    EX_ALIGNED double constant[EX_STRIDE][EX_ROW];
    EX_ALIGNED double origin[EX_ROW];
    int armed[EX_TRIGGERS], leaping;
} ex_stretch;

/* exp(M h) for h of 1, 2, 4, .. units, of a mode and a generator; by columns. */
typedef struct {
    const ex_mode *mode;
    int known, rungs;
    ex_chains chains;
    double unit, h;                     /* of `leap`, negative if there is none */
    ex_pair M[EX_F][EX_F], leap[EX_F][EX_F], rung[EX_KEPT][EX_F][EX_F];
} ex_ladder;

/* The largest magnitudes seen. */
typedef struct {
    double x[EX_X], u[EX_U];
} ex_peaks;

typedef double ex_shot[EX_SHOT];

/* Where a stretch has come to. `base`: the sample that is there, -1 if none is. */
typedef struct {
    double t, stop, z[EX_Z];
    int at, last, base;
    bg_set ports;
} ex_place;

/* Goes on to `stop` or the first event, in a stretch that has begun. A status. */
typedef int ex_advancing(ex_context *c, double stop);

struct ex_context {
    const ex_model *model;
    const ex_inputs *inputs;
    ex_task *task;
    ex_advancing *advance;
    void *caller;                       /* for `advance` */
    int clock, next;                    /* the next sample */
    ex_key where;                       /* the latest mode .. */
    int place;                          /* .. and its place in the model's */
    unsigned looks;
    double s[EX_N];
    int known, known_segment;           /* whether `given` holds, for `known_time` */
    double known_time, given[2 * EX_W];
    ex_peaks peaks;
    ex_stretch stretch;
    double work[6][EX_Z][EX_Z];
    double terms[BG_DEGREE + 1][EX_Z], powers[EX_TRIGGERS][BG_DEGREE + 1];
    double scratch[EX_BLOCK + 1][EX_ROW];
    int used[EX_ENTRIES];               /* when each was used last; 0 if it is empty */
    ex_entry entries[EX_ENTRIES];
    ex_ladder ladder;
    bg_course run;
    double point[EX_N], struck[EX_N];   /* room of the loop */
    double seen[EX_L];                  /* what its latest look was at .. */
    ex_shot shot;                       /* .. and what there was */
};

/* exact_inputs.c: the slots at t in a segment; and w and its rate from them. */
void ex_slots(const ex_inputs *inputs, int segment, double t, double *g);
void ex_given(const ex_inputs *inputs, int segment, const double *g, double *w, double *dw);

/* The magnitudes of the terms that make up w, with what rounding of t adds. */
void ex_input_sizes(const ex_inputs *inputs, int segment, double t, double *w);

/* exact_modes.c: a mode, valid until others are looked for; everything at one instant in it; a status. */
int ex_is_same(const ex_key *one, const ex_key *other);
int ex_find(ex_context *c, const int *mode, const ex_mode **found);
int ex_rests(const ex_mode *mode, int port);
void ex_vector(ex_context *c, double t, const double *s, double *v);
int ex_look(ex_context *c, double t, const double *s, const ex_mode *mode, double *shot);
void ex_ports(const double *shot, bg_port *ports);
void ex_round(const ex_context *c, const double *shot, double t, bg_port *ports);

/* exact_switch.c: whether a port is a switch; what keeps those of a mode, at v, and below what that is
 * none; their impulses, as a choice wants them. */
int ex_switches(const ex_context *c, int port);
void ex_keep(const ex_context *c, const ex_mode *mode, const double *v, bg_port *ports);
void ex_round_stay(const ex_context *c, const ex_mode *mode, const double *v, const double *shot,
                   double t, bg_port *ports);
int ex_strike(void *context, const bg_instant *at, const int *mode, double *s, int *shocks,
              int *struck);

/* exact_system.c: an entry of the cache, without and with exponentials, and stretches; whether a port
 * has one trigger, and a cap that is only looked at. */
int ex_single(const ex_context *c, const ex_mode *record, int port);
int ex_begin(ex_context *c, double stop);
void ex_leaps(ex_context *c, ex_stretch *stretch, double h, const double *row);

/* exact_ladder.c: the ladder of an entry; z after any time, and after one for which an exponential of
 * its own is kept. */
void ex_build(ex_ladder *l, const ex_entry *e);
void ex_climb(ex_ladder *l, double length, ex_pair *z);
void ex_leap_by(ex_ladder *l, double h, ex_pair *z);

/* exact_free.c: to `stop`, where nothing is watched. */
int ex_free(ex_context *c, double stop);

/* exact_bounds.c: e for steps that divide h, whose exponential goes to E; and bounds on its triggers'
 * fourth derivatives. */
void ex_divide(ex_context *c, ex_entry *e, double h, double (*E)[EX_Z]);
void ex_bound(ex_context *c, ex_entry *e, double (*E)[EX_Z]);

/* exact_exponential.c: exp(M h) and its integral. */
void ex_exponential(ex_context *c, double (*M)[EX_Z], double norm, double h, double (*E)[EX_Z],
                    double (*gather)[EX_Z]);
void ex_multiply(double (*left)[EX_Z], double (*right)[EX_Z], double (*restrict product)[EX_Z]);

/* exact_roots.c: where sum p[k] tau^k falls to zero in (begin, 1]: 1 if it does, 0 if not, -1 if the
 * search has no end. */
int ex_first_fall(const double *p, double begin, double *root);
double ex_value(const double *p, double tau);

/* exact_series.c: from t by `length`, z in place; *ports are those whose event ended it at *end. */
int ex_series(ex_context *c, double t, double length, double *z, double *end, bg_set *ports);

/* exact_leap.c: steps from rows[0]; how many are certain to be without an event. */
int ex_leap(const ex_stretch *stretch, int count, double (*rows)[EX_ROW]);
void ex_fill(const ex_stretch *stretch, double *row);
void ex_uncertainty(const ex_stretch *stretch, const double *row, double *slack);

/* What is done at samples: `record` takes the one that a step has come to, `leap` goes on over
 * `count` samples at distances of h; the latest with its triggers is in `row`, or that of the task. */
typedef struct {
    void *self;
    const double *row;
    int (*record)(void *self, ex_context *c, ex_place *p);
    int (*leap)(void *self, ex_context *c, ex_place *p, int count, double h);
} ex_recorder;

/* exact_advance.c: to `stop` or the first event, into the rows of the task or elsewhere; its ends. A
 * friction level below zero is refused. */
int ex_advance(ex_context *c, double stop);
int ex_advance_by(ex_context *c, double stop, const ex_recorder *to);
void ex_set_out(const ex_context *c, ex_place *p, double stop);
void ex_arrive(ex_context *c, ex_place *p);
int ex_check_levels(ex_context *c, double t, double *row);

/* exact_run.c: a run but for its last sample; a status. */
int ex_run_by(ex_context *c, const ex_model *model, const ex_inputs *inputs, ex_task *task,
              ex_advancing *advance, void *caller);

#endif
