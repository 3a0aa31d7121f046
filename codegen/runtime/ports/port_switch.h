/* Ideal switches: ports that are held or let go, as a side, conditions or a bound tell. */
#ifndef BG_PORT_SWITCH_H
#define BG_PORT_SWITCH_H

/* What makes a port change over: friction, a side, conditions, or a bound that it stops at. */
enum bg_way { BG_RUBS, BG_ONE_SIDED, BG_TOLD, BG_STOPS };

/* `on`: whether it is on while it is held. `side`: let go while side * y >= 0, held while side * u
 * <= 0. `guard`: the place of its condition to turn on, before that to turn off. `slides`: 1 or -1
 * for the ways in which friction slips that gives a flow, one after the other: held it slips. Of a
 * stop, which is on while it is apart and has its sides where the gap is closed: `guard`: the place
 * of its gap, before its restitution; `place`: that of its displacement in s, with which the gap
 * changes by `opening`; `bound`: whether it is told as one, that touches and is apart. `order`: of
 * the jump of a law, which rubs, and slides while it is held, the derivative of what it hangs on
 * that it moves, 1 or 2; of second order it receives how fast that changes, and `guard` is its
 * place. `machine`: of a transition of a state machine, taken as it turns on, which machine, from 1
 * on. */
typedef struct {
    int kind, on, side, guard, slides, place, opening, bound, order, machine;
} bg_switch;

/* What a state becomes as a port comes to a mode, `sign`, or at an impact of a stop: its place in
 * s, and that of the value among the conditions. Of a task `port` is -1 less its place among the
 * clocks. Those of transitions happen at the begin of a run, too. */
typedef struct {
    int port, sign, place, value;
} bg_reset;

/* The instants (k * every + offset) / unit of a task, k = 0, 1, ..; all three are whole numbers. */
typedef struct {
    double every, offset, unit;
} bg_clock;

/* port_clock.c: the first instant after t; the last up to t, before the first minus infinity;
 * whether t is one. */
double bg_clock_after(const bg_clock *clock, double t);
double bg_clock_latest(const bg_clock *clock, double t);
int bg_clock_strikes(const bg_clock *clock, double t);

/* The place of the condition that changes a switch over in its mode. */
int bg_condition(const bg_switch *s, int sign);

/* What keeps a switch from changing over in its mode: positive as long as it stays. */
double bg_stay(const bg_switch *s, int sign, double slip, double effort, const double *guards);

/* Whether it is a stop that is apart in its mode: its gap is watched as long as that lasts. */
int bg_is_apart(const bg_switch *s, int sign);

/* Whether it is a jump of second order. */
int bg_hangs(const bg_switch *s);

#endif
