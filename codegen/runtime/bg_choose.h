/* Which friction ports stick and which way the others slip: one consistent mode at one instant, of
 * whatever can be looked at in a given mode. */
#ifndef BG_CHOOSE_H
#define BG_CHOOSE_H

#include "config.h"

enum { BG_MOST_PORTS = 8, BG_NO_MODE = -1 };

#define BG_ROUNDING 1e-10 /* of the terms that make up a slip, an effort or a level: that is zero */
#define BG_LOOK_AHEAD 1e-4 /* ties are decided this fraction of the shortest time constant later */
#define BG_LEFT 10.0 /* slips that sources rule have left zero at so many times what is zero */

/* What an instant is to a port: none of its own, its event, or an event that may be long past, as
 * whoever steps the model finds it no better. */
enum { BG_UNTOUCHED, BG_TOUCHED, BG_PASSED };

/* One port at one instant in one mode. `push`: how fast the slip changes; `near_..`: below these
 * slip, margin and push count as zero. */
typedef struct {
    double slip, effort, cap, push, near_slip, near_effort, near_push;
} bg_port;

/* Combinations of slips, by rows over all ports, that only inputs rule and not what the ports of a
 * mode give: those that stick hold only while all are zero. `unknown`: the status of a mode of
 * which no more is known than whether they are. */
typedef struct {
    int count, unknown;
    double rows[BG_MOST_PORTS][BG_MOST_PORTS];
} bg_ruling;

/* `coupled`: whether a port's slip depends at once on friction. `look` tells of every port in a
 * mode; with `later` a moment later, where ties are decided and only the first four are asked for.
 * It gives a status: 0, BG_NO_MODE where the mode cannot be evaluated and so is none, or another,
 * which ends the search. `ruling` comes with no rows. */
typedef struct {
    int ports;
    const signed char *touched;
    const int *coupled;
    void *self;
    int (*look)(void *self, const signed char *mode, int later, bg_port *ports, bg_ruling *ruling);
} bg_chooser;

/* From the mode so far to the one just after the instant: 0 sticks, 1 slips forwards, -1 backwards.
 * Ports at rest, or so close that it is an event's own rounding, stick if they can. A status of
 * `look`, or BG_NO_MODE where none is consistent. */
int bg_choose(const bg_chooser *chooser, signed char *mode);

/* What to try where a mode cannot be evaluated, by number: slipping as it does, the same backwards
 * where it sticks, the mode, the ways of slipping, all stuck; 0 where there are no more. */
int bg_try(int ports, int number, const signed char *mode, signed char *tried);

/* A mode that can be looked at: that of `mode`, or if `slipping` one that slips as it does; else
 * any other way of slipping, or all stuck. The ports in it. A status as above. */
int bg_evaluated(const bg_chooser *chooser, int slipping, signed char *mode, bg_port *ports);

#endif
