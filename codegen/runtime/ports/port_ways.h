/* Which switches hold: the ways to try, from the one at hand to those with more changes. */
#ifndef BG_PORT_WAYS_H
#define BG_PORT_WAYS_H

/* Tries the switches of the bits in `held` held and all others let go: whether that holds, or else
 * which switches contradict it, if these alone do. A status that ends the search. */
typedef int (*bg_way)(void *self, unsigned held, int *holds, unsigned *broken);

/* Tries ways of so many ports, of which `switches` are some, from the first on, each once, until
 * one holds. */
int bg_try_ways(int ports, unsigned switches, unsigned first, bg_way attempt, void *self,
                int *holds);

#endif
