/* Event-driven runs of models that are affine in each friction mode, stepped exactly.
 *
 * The sizes come from config.h, which is generated:
 *   BG_N integrated states s         BG_X states x        BG_U inputs u of the equations
 *   BG_W external inputs w           BG_K friction ports  BG_MODES three to the power of BG_K
 *   BG_G slots of the inputs' generator
 * All but BG_K are at least 1. A mode's number has a digit of base 3 for each port, the first port
 * the lowest: 0 sticks, 1 slips forwards, 2 backwards.
 *
 * Nothing is allocated and nothing is global: the caller owns a context for each run at a time. */
#ifndef BG_ENGINE_H
#define BG_ENGINE_H

#include "bg_events.h"
#include "config.h"

enum {
    BG_PORTS = BG_K > 0 ? BG_K : 1,
    BG_Z = BG_N + BG_G,     /* state of a stretch: s and the slots of the generator */
    BG_T = 2 * BG_K,        /* triggers: two for each port */
    BG_TRIGGERS = 2 * BG_PORTS,
    BG_ROW = (BG_Z + 2 * BG_T + 3) / 4 * 4, /* a sample: state, triggers, a third of their change */
    BG_L = BG_N + 2 * BG_W + 1, /* what affine maps act on: s, w, their rates, 1 */
    /* where the rows of a snapshot begin */
    BG_AT_X = 0,
    BG_AT_U = BG_AT_X + BG_X,
    BG_AT_SLIP = BG_AT_U + BG_U,
    BG_AT_EFFORT = BG_AT_SLIP + BG_PORTS,
    BG_AT_CAP = BG_AT_EFFORT + BG_PORTS,
    BG_AT_PUSH = BG_AT_CAP + BG_PORTS,
    BG_AT_RATE = BG_AT_PUSH + BG_PORTS,
    BG_SHOT = (BG_AT_RATE + BG_N + 3) / 4 * 4,
    BG_STRIDE = 4,          /* so many steps are taken from one row */
    BG_BLOCK = 64,          /* rows of scratch, where samples are divided into steps */
    BG_ENTRIES = BG_MODES < 12 ? BG_MODES + 4 : 16, /* exponentials that are kept */
    BG_ALIGNMENT = 32       /* of a context in bytes; rows are read faster if they have it, too */
};

/* How a run ended. BG_MISSING: the mode `where` is not in the table. BG_UNSUPPORTED: that mode is
 * not affine. BG_NEGATIVE: a friction level falls below zero. BG_UNDECIDED: no mode is consistent.
 * BG_STALLS: no progress. BG_STIFF: most steps would follow what has decayed. BG_FULL: more events
 * than fit. BG_WORK: a search had no end. BG_UNUSABLE: numbers that are not finite. BG_BLUNT: the
 * rates of the mode `where` are wanted with 32 digits. BG_ENDLESS: so many steps have no end. */
enum bg_status {
    BG_OK, BG_MISSING, BG_UNSUPPORTED, BG_NEGATIVE, BG_UNDECIDED, BG_STALLS, BG_STIFF, BG_FULL,
    BG_WORK, BG_UNUSABLE, BG_BLUNT, BG_ENDLESS
};

/* One friction mode: affine maps over (s, w, w', 1), by columns. One that is not affine may have no
 * more than slips, their rates and caps, to tell whether what inputs rule of them lets it be;
 * `none`: nothing holds its ports. */
typedef struct {
    int supported, held;           /* whether it is affine; slips that sticking takes from x */
    int none, ruled;
    double ruling[BG_PORTS][BG_PORTS]; /* combinations of slips, by rows, that must be zero */
    double fastest;                /* the largest rate of s by itself */
    double weight[BG_N];           /* M is balanced in the sum of weight times magnitude */
    double shot[BG_L][BG_SHOT];    /* x, u, then of the ports: slips, efforts, caps, and how fast
                                      the slips change; the rates of s */
    double left[BG_L][BG_PORTS];   /* the slips that are to be removed .. */
    double take_away[BG_PORTS][BG_N]; /* .. and what to add to s per unit of each */
    int rates;                     /* how many of `spectrum` are known */
    double spectrum[BG_N][2];      /* rates of s by itself: magnitudes, and how fast they decay */
    int sharp;                     /* whether `rate` and `rest` are known .. */
    double rate[BG_L][BG_N], rest[BG_L][BG_N]; /* .. the rates of s as pairs, without friction */
} bg_mode;

/* Magnitudes from which rounding is told, rows of the ports by columns of states and inputs. */
typedef struct {
    const bg_mode *modes[BG_MODES]; /* NULL where a mode has not been worked out */
    double F[BG_X][BG_PORTS], D[BG_U][BG_PORTS], FP[BG_X][BG_PORTS], FQ[BG_U][BG_PORTS];
    double P[BG_X][BG_X], Q[BG_U][BG_X], inertia[BG_PORTS];
    int coupled[BG_PORTS];          /* whether the slip depends at once on friction */
} bg_model;

/* The generator of inputs: chains y0' = r y0 + y1, y1' = r y1 + y2, .. with w = constant + Re y0.
 * A chain of a complex rate has two slots, real and imaginary part, for each of its components. */
typedef struct {
    int count, input[BG_G], first[BG_G], depth[BG_G], width[BG_G], unused;
    double rate[BG_G][2];
} bg_chains;

/* The inputs between breakpoints: segment k lasts to breaks[k], the last one for ever. In segment k
 * each chain is a polynomial (coefficients where its slots are) of the time from its own start. */
typedef struct {
    int segments;
    const double *breaks;             /* segments - 1 times, increasing */
    const int *chains;                /* which of `structures` */
    const bg_chains *structures;
    const double (*constant)[BG_W], (*start)[BG_G], (*polynomial)[BG_G];
    const double *fastest;            /* the largest rate of a segment */
} bg_inputs;

/* What a run is given and gives. `grid`: the distance of the samples if all are alike, else 0. */
typedef struct {
    const double *times;              /* samples, increasing, the first where the run begins */
    int samples, capacity;
    double grid;
    const double *start;              /* s at the first */
    double (*rows)[BG_ROW];           /* out: s in the first BG_N columns */
    int *modes;                       /* out: each sample's mode */
    bg_event *events;                 /* out */
    int count, where;                 /* events; the mode that an error is about */
    double time;                      /* where the run ended */
} bg_task;

typedef struct bg_context bg_context;

/* The sizes of a context, a model, a mode, a generator and of a row, in bytes. */
void bg_sizes(unsigned long *sizes);

/* Makes a context ready, and forgets what it has kept: exponentials are of one model. */
void bg_forget(bg_context *c);

/* Runs once; the status. */
int bg_run(bg_context *c, const bg_model *model, const bg_inputs *inputs, bg_task *task);

/* Runs `repeats` times, forgetting between runs or not; the status of the last. */
int bg_run_often(bg_context *c, const bg_model *model, const bg_inputs *inputs, bg_task *task,
                 int repeats, int anew);

#endif
