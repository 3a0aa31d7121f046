/* What a choice of mode rests on, switches and friction. */
#ifndef BG_PORT_CHOOSING_H
#define BG_PORT_CHOOSING_H

#include "port_choose.h"

/* `s`: that of the instant, or what it is after an impact, if it is `struck`; `shocks`: the signs
 * of its impulses. `undecided`: the `count` friction ports that may stick, by bits in `open`. `why`
 * there is no mode: as none could be looked at so far, or as those are not consistent. */
typedef struct {
    const bg_sight *sight;
    const bg_instant *at;
    double *s;
    const int *before;
    int shocks[BG_MOST_PORTS], struck;
    int forward[BG_MOST_PORTS], undecided[BG_MOST_PORTS], count, why;
    unsigned open;
} bg_choice;

/* What is found of a mode: whether it holds, or else whether friction or which switches contradict
 * it. */
typedef struct {
    int holds, rubbing;
    unsigned broken;
} bg_finding;

/* port_choose.c: the first consistent mode with the switches of `mode`, if one holds; else switches
 * that would have to change over. A status that ends the search. */
int bg_choose_rubbing(bg_choice *choice, int *mode, int *holds, unsigned *broken);

#endif
