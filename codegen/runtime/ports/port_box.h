/* What ports give in a step, each within bounds and each on its side: one linear complementarity
 * problem, y = slip - V (given - given0). A port is held, y = 0, while what it gives is inside its
 * bounds; at the upper one y >= 0, at the lower one y <= 0. */
#ifndef BG_PORT_BOX_H
#define BG_PORT_BOX_H

#include "config.h"

/* `way`: 0 held, 1 or -1 at the bound `most` or `least`, which holds a port up to `extra` beyond
 * it; `slips`: what is left of both bounds once a port leaves them with a slip. Below `near` a
 * slip, and within `slack` of a bound what a port gives, are rounding; `shared`: what is left of
 * slips that several ports hold together. `reversed`: a port that pushes its slip on, which
 * nothing can hold. */
typedef struct {
    int way[BG_PORTS], reversed[BG_PORTS];
    double least[BG_PORTS], most[BG_PORTS], extra[BG_PORTS], slips[BG_PORTS];
    double given[BG_PORTS], slip[BG_PORTS], slack[BG_PORTS], near[BG_PORTS];
    double shared[BG_PORTS];
} bg_boxed;

/* How many ports contradict their ways. */
int bg_box_broken(int ports, const bg_boxed *box);

/* Ways that contradict nothing, with what ports give and receive then; `yields`: V by rows;
 * `system` has room for as many numbers. BG_PIVOTS where a bounded number of turns was not
 * enough: then the best of them. */
int bg_box_solve(int ports, bg_boxed *box, const double *yields, double *system);

#endif
