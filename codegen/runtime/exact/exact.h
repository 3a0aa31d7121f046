/* Event-driven runs of models that are affine in each friction mode, stepped exactly.
 *
 * The sizes come from config.h, which is generated:
 *   EX_N integrated states s         EX_X states x        EX_U inputs u of the equations
 *   EX_W external inputs w           EX_K friction ports  EX_MODES that are kept at a time, at most
 *   EX_G slots of the inputs' generator                   three to the power of EX_K
 * All but EX_K are at least 1. What is of exact steps alone begins with ex_.
 *
 * Nothing is allocated and nothing is global: the caller owns a context for each run at a time. */
#ifndef BG_EXACT_H
#define BG_EXACT_H

#include "port_events.h"
#include "config.h"
#include "run_status.h"

enum {
    EX_PORTS = EX_K > 0 ? EX_K : 1,
    EX_MOST_RESETS = BG_RESETS > 0 ? BG_RESETS : 1,
    EX_MOST_CLOCKS = BG_CLOCKS > 0 ? BG_CLOCKS : 1,
    EX_DIGITS = 32,         /* of a word */
    EX_WORDS = (EX_PORTS + EX_DIGITS - 1) / EX_DIGITS,
    EX_Z = EX_N + EX_G,     /* state of a stretch: s and the slots of the generator */
    EX_T = 2 * EX_K,        /* triggers: two for each port */
    EX_TRIGGERS = 2 * EX_PORTS,
    EX_ROW = (EX_Z + 2 * EX_T + 3) / 4 * 4, /* a sample: state, triggers, a third of their change */
    EX_L = EX_N + 2 * EX_W + 1, /* what affine maps act on: s, w, their rates, 1 */
    EX_SHARP = EX_K > 0 ? 1 : EX_L,
    /* where the rows of a snapshot begin */
    EX_AT_X = 0,
    EX_AT_U = EX_AT_X + EX_X,
    EX_AT_SLIP = EX_AT_U + EX_U,
    EX_AT_EFFORT = EX_AT_SLIP + EX_PORTS,
    EX_AT_CAP = EX_AT_EFFORT + EX_PORTS,
    EX_AT_PUSH = EX_AT_CAP + EX_PORTS,
    EX_AT_RATE = EX_AT_PUSH + EX_PORTS,
    EX_SHOT = (EX_AT_RATE + EX_N + 3) / 4 * 4,
    EX_STRIDE = 4,          /* so many steps are taken from one row */
    EX_BLOCK = 64,          /* rows of scratch, where samples are divided into steps */
    EX_ENTRIES = EX_MODES < 12 ? EX_MODES + 4 : 16, /* exponentials that are kept */
    EX_ALIGNMENT = 32       /* of a context in bytes; rows are read faster if they have it, too */
};

/* A mode as a number of two bits for each port, the first port the lowest: 0 sticks, 1 slips
 * forwards, 2 backwards. */
typedef struct {
    unsigned long long digits[EX_WORDS];
} ex_key;

/* One friction mode: affine maps over (s, w, w', 1), by columns. One that is not affine may have no
 * more than slips, their rates and caps, to tell whether what inputs rule of them lets it be;
 * `none`: nothing holds its ports. */
typedef struct {
    int supported, held;           /* whether it is affine; slips that sticking takes from x */
    int none, ruled;
    double ruling[EX_PORTS][EX_PORTS]; /* combinations of slips, by rows, that must be zero */
    int joined[EX_PORTS];          /* alike, not 0: ports with part in what none rules alone */
    double fastest;                /* the largest rate of s by itself */
    double weight[EX_N];           /* M is balanced in the sum of weight times magnitude */
    double shot[EX_L][EX_SHOT];    /* x, u, then of the ports: slips, efforts, caps, and how fast
                                      the slips change; the rates of s */
    double left[EX_L][EX_PORTS];   /* the slips that are to be removed .. */
    double take_away[EX_PORTS][EX_N]; /* .. and what to add to s per unit of each */
    double mix[EX_PORTS][EX_PORTS]; /* what those slips are of the ports' own */
    double stay[EX_L][EX_PORTS];   /* what keeps switches, and what jumps of second order hang on */
    double become[EX_L][EX_MOST_RESETS]; /* what resets set s to */
    /* where friction slips forwards, as switches come to hold: what s gains per unit of each slip,
     * how far the impulse goes with each switch's way, and what each port gives */
    double jump[EX_PORTS][EX_N], shock[EX_PORTS][EX_PORTS], blow[EX_PORTS][EX_PORTS];
    int rates;                     /* how many of `spectrum` are known; below 0: none was asked for */
    double spectrum[EX_N][2];      /* rates of s by itself: magnitudes, and how fast they decay */
    int sharp;                     /* without ports: whether `rate` and `rest` are known .. */
    double rate[EX_SHARP][EX_N], rest[EX_SHARP][EX_N]; /* .. the rates of s as pairs */
} ex_mode;

/* The `count` modes that have been worked out; `supply`: works out one more, or is NULL where the
 * caller does; `used`: when each was asked for last, or NULL; `most`: that a run may come to, 0: any.
 * Magnitudes from which rounding is told, rows of the ports by columns of states and inputs. */
typedef struct {
    int count, most;
    const ex_key *keys;
    const ex_mode *const *modes;
    unsigned long long *used;
    int (*supply)(void *self, const int *mode);
    void *self;
    double F[EX_X][EX_PORTS], D[EX_U][EX_PORTS], FP[EX_X][EX_PORTS], FQ[EX_U][EX_PORTS];
    double P[EX_X][EX_X], Q[EX_U][EX_X], inertia[EX_PORTS];
    int coupled[EX_PORTS];          /* whether the slip depends at once on friction */
    int own[EX_PORTS];              /* the input that each port gives */
    int switched, stopping, hung;   /* whether any port is a switch; a stop; a jump of second order */
    double room[EX_PORTS], back[EX_PORTS]; /* of stops: the gap where s is zero; restitution */
    bg_switch switches[EX_PORTS];
    bg_reset resets[EX_MOST_RESETS];
    bg_clock clocks[EX_MOST_CLOCKS];
} ex_model;

/* The generator of inputs: chains y0' = r y0 + y1, y1' = r y1 + y2, .. with w = constant + Re y0.
 * A chain of a complex rate has two slots, real and imaginary part, for each of its components. */
typedef struct {
    int count, input[EX_G], first[EX_G], depth[EX_G], width[EX_G], unused;
    double rate[EX_G][2];
} ex_chains;

/* The inputs between breakpoints, from `since` to `until`: segment k lasts to breaks[k], the last
 * one to `until`. In segment k each chain is a polynomial (coefficients where its slots are) of the
 * time from its own start. Where that is not all of a run, `more` writes the segments from t on in
 * place of these; not 0 if it cannot. Structures stay. */
typedef struct {
    double since, until;
    int (*more)(void *self, double t);
    void *self;
    int segments;
    const double *breaks;             /* segments - 1 times, increasing */
    const int *chains;                /* which of `structures` */
    const ex_chains *structures;
    const double (*constant)[EX_W], (*start)[EX_G], (*polynomial)[EX_G];
    const double *fastest;            /* the largest rate of a segment */
} ex_inputs;

/* What a run is given and gives. `grid`: the distance of the samples if all are alike, else 0. */
typedef struct {
    const double *times;              /* samples, increasing, the first where the run begins */
    int samples, capacity;
    double grid;
    const double *start;              /* s at the first */
    double (*rows)[EX_ROW];           /* out: s in the first EX_N columns */
    int *modes;                       /* out: each sample's mode, by its place in the model's */
    const int *first;                 /* the mode before the run; NULL: all let go */
    bg_event *events;                 /* out */
    int count;                        /* of events */
    ex_key where;                     /* the mode that an error is about */
    double time;                      /* where the run ended */
    /* Where there is room for so many samples alone, two or more, `full` takes the first of rows and
     * modes, or the events; what is left comes to begin with the next. None of either now and then, so
     * that it can tell to stop. Not 0: it cannot. */
    int room;
    int (*full)(void *self, int samples, int events);
    void *self;
} ex_task;

typedef struct ex_context ex_context;

/* The sizes of a context, a model, a mode, a generator and of a row, in bytes. */
void ex_sizes(unsigned long *sizes);

/* Makes a context ready, and forgets what it has kept: exponentials are of one model. */
void ex_forget(ex_context *c);

/* Runs once; the status. */
int ex_run(ex_context *c, const ex_model *model, const ex_inputs *inputs, ex_task *task);

/* Runs `repeats` times, forgetting between runs or not; the status of the last. */
int ex_run_often(ex_context *c, const ex_model *model, const ex_inputs *inputs, ex_task *task,
                 int repeats, int anew);

#endif
