/* Directions along which the efforts of redundant ports may change, and who shares a load. */
#ifndef BG_PORT_SHARE_H
#define BG_PORT_SHARE_H

#include "model_internal.h"

/* Directions over all ports, by rows; once reduced row k has port pivots[k] to itself. */
typedef struct {
    int free, count, pivots[PORTS];
    double rows[PORTS * PORTS];
} bg_directions;

/* Efforts, what each port can hold, and the ports that are left to share and that move. */
typedef struct {
    int size, left[PORTS];
    double efforts[PORTS], caps[PORTS];
} bg_load;

/* Pivots and one port more, with the load that no direction changes: its weight of each port's
 * effort. How far to go along each direction for these ports to carry that fraction of their caps,
 * each on its side. */
typedef struct {
    bg_directions by;
    int last;
    double fraction, weights[PORTS], sides[PORTS], ways[PORTS];
} bg_reference;

/* port_share.c: Gauss-Jordan elimination on the columns of `size` ports, each time by the largest
 * pivot; leaves as many directions as are independent there. */
void bg_reduce(bg_directions *d, int size, const int *ports);

/* port_reference.c: whether a port is a pivot; what of a port's column is rounding beside one and
 * the largest entry; the port that has with pivots the load of the highest fraction, -1 if all are.
 * at's load by its directions and last port, and at->sides of all ports that have a weight. */
int bg_is_pivot(const bg_directions *d, int port);
double bg_least_entry(const bg_directions *d, int port);
int bg_first_port(const bg_load *load, const bg_directions *d);
void bg_refer(const bg_load *load, bg_reference *at);

/* port_exchange.c: that of the two references which has the highest fraction; ports that each move
 * alone carry none. NULL where exchanges find no end. */
const bg_reference *bg_settle(const bg_load *load, const bg_directions *d, bg_reference *two);

#endif
