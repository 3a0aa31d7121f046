/* A first look at a choice of mode: where all is far from a tie, signs of a few rows decide. */
#ifndef BG_EXACT_GLANCE_H
#define BG_EXACT_GLANCE_H

#include "exact_internal.h"

/* `v`: what maps act on at the instant; `most`: its bounds while the choice is kept; `loose`: all let
 * go, of which `near` is no less than what slips count as zero below, nor `low` more; `rate`: of the
 * displacements of stops. `barred`: stops that are apart. `mode`: what is found. */
typedef struct {
    ex_context *c;
    ex_choice *to;
    double v[EX_L], near[EX_PORTS], low[EX_PORTS], rate[EX_PORTS];
    bg_set barred;
    int mode[EX_PORTS];
} ex_glance;

/* Bounds in a mode while magnitudes are below `most`: its rows, what slips count as zero below, and
 * what keeps switches. */
typedef struct {
    ex_shot shot;
    bg_port ports[EX_PORTS];
} ex_limits;

void ex_limit(const ex_glance *g, const ex_mode *mode, const double *most, ex_limits *limits);

/* Asks for a row to be above `least`: whether it is, and there is room to keep that. */
int ex_ask(ex_glance *g, const double *row, double sign, double least);
double ex_row(const double *row, const double *v);

/* exact_stop.c: whether all stops were apart in a mode and stay so, for sure; these are not asked. */
int ex_bar_stops(ex_glance *g, const int *before);

/* What contradicts a way of the switches, as bg_try_ways asks for it; a status where that is not sure. */
int ex_glance_at(void *self, const bg_set *held, int *holds, bg_set *broken);

/* exact_glance_strike.c: the impulse with which the switches of a mode come to hold, sure or 0 for its
 * status: the signs of its shocks; rows of what keeps switches become those after it, and `most`. */
int ex_glance_strike(ex_glance *g, const ex_mode *mode, double (*stay)[EX_PORTS], double *most,
                     int *shocks, int *struck);

#endif
