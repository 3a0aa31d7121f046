/* Which friction ports stick and which way the others slip: one consistent mode at one instant, of
 * whatever can be looked at in a given mode. */
#ifndef BG_CHOOSE_H
#define BG_CHOOSE_H

#include "config.h"

enum { BG_MOST_PORTS = 6, BG_NO_MODE = -1 };

/* One port at one instant in one mode. `push`: how fast the slip changes; `near_..`: below these
 * slip, margin and push count as zero. */
typedef struct {
    double slip, effort, cap, push, near_slip, near_effort, near_push;
} bg_port;

/* `touched`: whether the instant is an event of the port; `coupled`: whether its slip depends at
 * once on friction. `look` tells of every port in a mode; with `later` a moment later, where ties
 * are decided and only the first four are asked for. It gives a status, 0 for success. */
typedef struct {
    int ports;
    const signed char *touched;
    const int *coupled;
    void *self;
    int (*look)(void *self, const signed char *mode, int later, bg_port *ports);
} bg_chooser;

/* From the mode so far to the one just after the instant: 0 sticks, 1 slips forwards, -1 backwards.
 * Ports at rest, or so close that it is an event's own rounding, stick if they can. A status of
 * `look`, or BG_NO_MODE where none is consistent. */
int bg_choose(const bg_chooser *chooser, signed char *mode);

#endif
