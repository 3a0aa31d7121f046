/* What the files of the engine share: what a run works in. */
#ifndef BG_EXACT_CONTEXT_H
#define BG_EXACT_CONTEXT_H

#include "exact.h"
#include "run_extremes.h"
#include "exact_choice.h"
#include "exact_pair.h"
#include "exact_stride.h"
#include "port_rounding.h"
#include "run_loop.h"

enum {
    EX_RENEWAL = 16,      /* steps for which a bound on fourth derivatives holds */
    EX_VAIN = 63,         /* instants that are not looked at again while none is made again */
    /* steps by series that an entry is walked through before it has tables for leaps, which cost as
     * much as EX_Z such steps: an event may end its stretch before */
    EX_WALKED = EX_K > 0 && EX_Z > 16 ? EX_Z / 4 - 4 : 0,
    EX_KEPT = EX_K > 0 ? 1 : BG_RUNGS,
    EX_WIDE = (EX_Z + EX_T + 3) / 4 * 4, /* rates and triggers of a state */
    EX_LEAST_DEGREE = 5,
    EX_F = EX_Z + EX_W + 1 /* state where nothing is watched */
};

#if defined(__GNUC__)
#define EX_ALIGNED __attribute__((aligned(EX_ALIGNMENT)))
#else
#define EX_ALIGNED
#endif

/* sum at[k] tau^k; of degree EX_LEAST_DEGREE at the least */
typedef struct {
    int degree;
    double at[BG_POWERS + 1];
} ex_powers;

/* A mode with a generator, z' = M z + .., and its exponentials for one step. By columns. */
typedef struct {
    const ex_mode *mode;
    ex_key key;
    int place;                          /* of the mode in the model's */
    int segment;                        /* whose constant parts these are, in which run */
    unsigned run;
    double b[EX_Z], level[EX_TRIGGERS];
    long long parts;
    int cap[EX_TRIGGERS];               /* whether a trigger is only a cap */
    int moves[EX_TRIGGERS];             /* what moves it; whether time alone moves one that is none, */
    int timed, paced[EX_G];             /* by which slots, with those of their chains; and whether */
    int foreseeable;                    /* anything of a stretch may be known before it has begun */
    ex_chains chains;
    double norm;                        /* of M, in a sum weighted by `weight` */
    double h, step;                     /* between samples, and its part that is a step */
    int walked;                         /* steps that might have been leaps, in which run */
    unsigned walking;
    int least;                          /* degree of its power series, at the least */
    double weight[EX_Z], M[EX_Z][EX_Z];
    double trigger[EX_Z][EX_TRIGGERS];
    EX_ALIGNED double rows[EX_Z][EX_WIDE]; /* of M, then of triggers */
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
    int armed[EX_TRIGGERS], leaping, foreseen;
    ex_foresight ahead;
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
    int taken;                          /* samples that are in the rows of the task no more */
    int unasked;                        /* stretches since it was asked whether to go on */
    ex_key where;                       /* the latest mode .. */
    int place;                          /* .. its place in the model's, -1 if none has been found, .. */
    int signs[EX_PORTS];                /* .. and what it was asked for as */
    unsigned long long looks, began;    /* how often any mode was asked for, before this run, too */
    int met;                            /* modes that this run has come to */
    double s[EX_N];
    int known, known_segment;           /* whether `given` holds, for `known_time` */
    double known_time, slots[EX_G], given[2 * EX_W];
    ex_peaks peaks;
    double farthest[EX_PORTS];          /* that the displacements of stops have been */
    ex_stretch stretch;
    double work[6][EX_Z][EX_Z];
    int degree;                         /* of terms */
    double terms[BG_POWERS + 1][EX_Z];
    ex_powers powers[EX_TRIGGERS];
    double scratch[EX_BLOCK + 1][EX_ROW];
    int used[EX_ENTRIES];               /* when each was used last; 0 if it is empty */
    int latest[EX_ENTRIES];             /* which was asked for last of a few modes */
    ex_entry entries[EX_ENTRIES];
    int stridden;                       /* how many there are */
    ex_stride strides[EX_STRIDES];
    int glancing, decided, chosen, looked, vain; /* whether choices are kept; how many are .. */
    ex_choice choices[EX_CHOICES];
    unsigned runs;
    ex_ladder ladder;
    bg_course run;
    double point[EX_N], struck[EX_N];   /* room of the loop */
    double seen[EX_L];                  /* what its latest look was at .. */
    ex_shot shot;                       /* .. and what there was, which may be shown again: */
    const ex_mode *shown;               /* in which mode, NULL if in none, .. */
    ex_key shown_key;
    double shown_time;                  /* .. when, .. */
    int shown_segment, rounded;         /* .. and whether its ports are here, with what counts as zero .. */
    double rounded_time;                /* .. at this time constant */
    bg_port ports[EX_PORTS];
};

#endif
