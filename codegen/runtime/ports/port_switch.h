/* Ideal switches: ports that are held or let go, as a side or conditions of theirs tell. */
#ifndef BG_PORT_SWITCH_H
#define BG_PORT_SWITCH_H

/* What makes a port change over: friction, a side, or conditions. */
enum bg_way { BG_RUBS, BG_ONE_SIDED, BG_TOLD };

/* `on`: whether it is on while it is held. `side`: let go while side * y >= 0, held while side * u
 * <= 0. `guard`: the place of its condition to turn on, before that to turn off. `slides`: 1 or -1
 * for the ways in which friction slips that gives a flow, one after the other: held it slips. */
typedef struct {
    int kind, on, side, guard, slides;
} bg_switch;

/* The place of the condition that changes a switch over in its mode. */
int bg_condition(const bg_switch *s, int sign);

/* What keeps a switch from changing over in its mode: positive as long as it stays. */
double bg_stay(const bg_switch *s, int sign, double slip, double effort, const double *guards);

#endif
