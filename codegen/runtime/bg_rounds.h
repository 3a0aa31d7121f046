/* Whether a run gets anywhere. */
#ifndef BG_ROUNDS_H
#define BG_ROUNDS_H

#include "config.h"

enum { BG_STALLED = 60 }; /* so many events within a moment are a run that goes nowhere */

/* When latest stretches ended in an event; `next` is where the next time goes: on the oldest. */
typedef struct {
    double time[BG_STALLED];
    int next, full;
} bg_rounds;

/* Counts an event at t; whether the latest ones all were within `least`. */
int bg_stalls(bg_rounds *rounds, double t, double least);

#endif
