/* Stretches that recur: in one mode, from the same inputs, over the same time. What is known of them
 * tells at once where such a stretch ends, if time alone ends it and nothing else can happen before. */
#ifndef BG_EXACT_STRIDE_H
#define BG_EXACT_STRIDE_H

#include "exact.h"
#include "port_set.h"

enum {
    EX_STRIDES = 8,  /* that are kept */
    EX_FEW = 8,      /* samples inside one, at the most */
    EX_PARTS = 16,   /* in which bounds are looked for, at the most */
    /* where rows begin of what a stride makes of the rates at its begin: by how much the state changes,
     * the rates at its end, and the same of triggers; rows of four */
    EX_TO_STATE = 0,
    EX_TO_RATES = EX_TO_STATE + EX_Z,
    EX_TO_VALUES = EX_TO_RATES + EX_Z,
    EX_TO_SLOPES = EX_TO_VALUES + EX_T,
    EX_LIFT = (EX_TO_SLOPES + EX_TRIGGERS + 3) / 4 * 4
};

/* What moves a trigger: nothing, inputs alone, or the state. */
enum { EX_STILL, EX_TIMED, EX_MOVED };

/* `entry`: the place of its own, -1 where that is no more; `used`: when it was asked for last; `known`:
 * whether it has been worked out, -1 where that is of no use. `ports`: whose events end it after `h`, as
 * time alone moves their triggers; none where it ends as told. `start`: the slots at its begin; `level`:
 * the constant parts of triggers. `lift`, by columns; `bend`: bounds on how far triggers are from straight
 * lines, per rate. */
typedef struct {
    int entry, used, known;
    bg_set ports;
    double h, start[EX_G], level[EX_TRIGGERS];
    double lift[EX_Z][EX_LIFT], bend[EX_Z][EX_TRIGGERS];
} ex_stride;

/* The ends of a stride: triggers at its begin; state, rates, triggers and how these change at its end;
 * how far triggers may be from the straight lines between. */
typedef struct {
    double begins[EX_TRIGGERS], z[EX_Z], rates[EX_Z], value[EX_TRIGGERS], slope[EX_TRIGGERS];
    double bend[EX_TRIGGERS];
} ex_ends;

/* Where the stretch that has begun will end. */
typedef struct {
    double end, z[EX_Z];
    bg_set ports;
} ex_foresight;

#endif
