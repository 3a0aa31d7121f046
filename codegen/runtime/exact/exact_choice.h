/* Choices of mode that were made, and what has to be so for them to be made again. */
#ifndef BG_EXACT_CHOICE_H
#define BG_EXACT_CHOICE_H

#include "exact.h"
#include "port_choose.h"

enum {
    EX_CHOICES = 8,                              /* that are kept */
    EX_NEVER = 9,                                /* no mode of a port */
    EX_LANE = 8,                                 /* rows that are looked at together */
    EX_ROWS = EX_PORTS < 16 ? 8 * EX_PORTS : 128 /* conditions of one, at the most */
};

/* From the mode `before`, with these ports touched, to that `after`; `used`: when it was asked for last.
 * It is made where `rows` rows over (s, w, w', 1), by columns, are above `least`:
 * as long as the time constant is the same, t before `until`, states and inputs are below `most`,
 * displacements of stops never were `farthest`, and inputs are above `low`; which these are for sure
 * in the segment `steady`, -1 where they are not; and their rates are not above `pace`. */
typedef struct {
    int used, rows, steady;
    int before[EX_PORTS], touched[EX_PORTS], after[EX_PORTS];
    double time, until, pace;
    double most_x[EX_X], most_u[EX_U], most[EX_L], low[EX_W], farthest[EX_PORTS];
    double row[EX_L][EX_ROWS], least[EX_ROWS];
} ex_choice;

/* The mode at the instant of a context: as bg_choose decides it, or as before, where that is sure. */
int ex_choose(void *context, const bg_sight *sight);

#endif
