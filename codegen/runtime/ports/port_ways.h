/* Which switches hold: the ways to try, from the one at hand to those with more changes. */
#ifndef BG_PORT_WAYS_H
#define BG_PORT_WAYS_H

#include "port_set.h"

/* Tries the switches of `held` held and all others let go: whether that holds, or else which
 * switches contradict it, if these alone do. A status that ends the search. */
typedef int (*bg_way)(void *self, const bg_set *held, int *holds, bg_set *broken);

/* Tries ways of so many ports, of which `switches` are some, from the first on, until one holds.
 * `guarded`: switches with conditions of their own, which contradict before they change over, if
 * they can. */
int bg_try_ways(int ports, const bg_set *switches, const bg_set *guarded, bg_set first,
                bg_way attempt, void *self, int *holds);

/* The next choice of `size` among `total`, in order; 0 after the last. */
int bg_next_choice(int size, int total, int *chosen);

#endif
