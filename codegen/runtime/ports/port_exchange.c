/* Which ports carry the load of the highest fraction: Stiefel's exchange (Numer. Math. 1, 1959;
 * Cheney, Introduction to Approximation Theory, ch. 2), the simplex method on the dual of the
 * linear program that shares ask for.
 *
 * A reference is one port more than there are directions; the fraction of its load rises as one of
 * its ports is exchanged for one that would carry more. Where the port that goes has no weight the
 * fraction stays; which of several goes is told by their order, so that no reference comes twice
 * (Dantzig, Orden, Wolfe, Pacific J. Math. 5, 1955). */
#include <math.h>
#include <string.h>

#include "port_share.h"

/* The ports of the first reference, in order. */
typedef struct {
    int size, ports[PORTS];
    double sides[PORTS];
} port_order;

/* Rows whose ports turn to their other side as one, and by how much of the port that comes; -1 of
 * none. */
typedef struct {
    int size, rows[PORTS + 1];
    double by[PORTS + 1];
} turning;

/* The port that would carry the largest fraction above the reference's, and its side; -1 if none
 * would. */
static int entering(const bg_load *load, const bg_reference *at, double *side)
{
    double highest = -1.0;
    int found = -1;
    for (int i = 0; i < load->size; i++) {
        const int port = load->left[i];
        double sum = load->efforts[port], terms = fabs(sum);
        if (port == at->last || bg_is_pivot(&at->by, port))
            continue;
        for (int k = 0; k < at->by.free; k++) {
            const double term = at->ways[k] * at->by.rows[k * at->by.count + port];
            sum += term;
            terms += fabs(term);
        }
        if (fabs(sum) - at->fraction * load->caps[port] > BG_EXCHANGED * terms
            && fabs(sum) / load->caps[port] > highest) {
            highest = fabs(sum) / load->caps[port];
            found = port;
            *side = copysign(1.0, sum);
        }
    }
    return found;
}

/* Keeps the rows of which these are the least, but for rounding. */
static void keep_least(turning *all, const double *values)
{
    double least = INFINITY;
    int size = 0;
    for (int i = 0; i < all->size; i++)
        least = fmin(least, values[i]);
    for (int i = 0; i < all->size; i++)
        if (values[i] <= least + BG_NOTHING * fabs(least)) {
            all->rows[size] = all->rows[i];
            all->by[size++] = all->by[i];
        }
    all->size = size;
}

/* The row whose port is the first to turn, if the ports of the first reference had loads of their
 * own, on their sides and each far smaller than the one before. */
static int in_turn(const bg_reference *at, const port_order *first, turning *all)
{
    const bg_directions *const d = &at->by;
    double own[PORTS + 1];
    for (int c = 0; c < first->size && all->size > 1; c++) {
        const double least = bg_least_entry(d, first->ports[c]);
        for (int i = 0; i < all->size; i++) {
            const int k = all->rows[i];
            const double entry = k < 0 ? 0.0 : d->rows[k * d->count + first->ports[c]];
            own[i] = 0.0;
            if (fabs(entry) > least)
                own[i] = at->sides[d->pivots[k]] / all->by[i] * entry * first->sides[c];
        }
        keep_least(all, own);
    }
    return all->rows[0];
}

/* The pivot that a port on this side takes to its other side first; if none, the port beside. */
static int leaving(const bg_reference *at, const port_order *first, int port, double side)
{
    const bg_directions *const d = &at->by;
    const double least = bg_least_entry(d, port);
    turning turned = {0, {0}, {0}}, kept = {0, {0}, {0}};
    double ratios[PORTS + 1];
    for (int k = 0; k < d->free; k++) {
        const double entry = d->rows[k * d->count + port];
        const double size = fabs(at->weights[d->pivots[k]]);
        const double against = side * entry * at->sides[d->pivots[k]];
        if (fabs(entry) > least && against > 0.0) {
            ratios[turned.size] = size / against;
            turned.rows[turned.size] = k;
            turned.by[turned.size++] = against;
        } else if (!(fabs(entry) > least) && size > 0.0) {
            kept.rows[kept.size] = k;
            kept.by[kept.size++] = size;
        }
    }
    kept.rows[kept.size] = -1;
    kept.by[kept.size++] = 1.0;
    if (turned.size > 0)
        keep_least(&turned, ratios);
    const int row = in_turn(at, first, turned.size > 0 ? &turned : &kept);
    return row < 0 ? at->last : d->pivots[row];
}

/* The ports of a reference in order, one exchanged for another. */
static int list_ports(const bg_reference *at, int from, int to, int *ports)
{
    int size = 0;
    for (int port = 0; port < at->by.count; port++)
        if (port == to || (port != from && (port == at->last || bg_is_pivot(&at->by, port))))
            ports[size++] = port;
    return size;
}

static void copy_directions(const bg_directions *from, bg_directions *to)
{
    to->free = from->free;
    to->count = from->count;
    memcpy(to->pivots, from->pivots, sizeof from->pivots);
    memcpy(to->rows, from->rows, sizeof(double) * (size_t)(from->free * from->count));
}

/* `after` becomes the reference of `at` with one port exchanged for another on this side; 0 where
 * those move together in fewer directions. */
static int exchange(const bg_load *load, const bg_directions *d, const bg_reference *at, int from,
                    int to, double side, bg_reference *after)
{
    int ports[PORTS];
    list_ports(at, from, to, ports);
    copy_directions(d, &after->by);
    bg_reduce(&after->by, d->free + 1, ports);
    if (after->by.free < d->free)
        return 0;
    for (int i = 0; i <= d->free; i++)
        if (!bg_is_pivot(&after->by, ports[i]))
            after->last = ports[i];
    memcpy(after->sides, at->sides, sizeof at->sides);
    after->sides[to] = side;
    bg_refer(load, after);
    return 1;
}

/* The first reference; where no port is beside the pivots these are to carry nothing. */
static void first_reference(const bg_load *load, const bg_directions *d, bg_reference *at,
                            port_order *first)
{
    copy_directions(d, &at->by);
    at->last = bg_first_port(load, d);
    for (int i = 0; i < d->count; i++) {
        at->sides[i] = 1.0;
        at->weights[i] = bg_is_pivot(d, i);
    }
    for (int k = 0; k < d->free; k++)
        at->ways[k] = -load->efforts[d->pivots[k]];
    if (at->last < 0)
        return;
    bg_refer(load, at);
    first->size = list_ports(at, -1, -1, first->ports);
    for (int c = 0; c < first->size; c++)
        first->sides[c] = at->sides[first->ports[c]];
}

const bg_reference *bg_settle(const bg_load *load, const bg_directions *d, bg_reference *two)
{
    bg_reference *at = two, *after = two + 1;
    port_order first;
    first_reference(load, d, at, &first);
    for (int k = 0; k < BG_EXCHANGES; k++) {
        double side = 1.0;
        const int to = at->last < 0 ? -1 : entering(load, at, &side);
        if (to < 0)
            return at;
        const int from = leaving(at, &first, to, side);
        const int stays = at->weights[from] == 0.0;
        if (!exchange(load, d, at, from, to, side, after)
            || !(stays || after->fraction > at->fraction))
            return at; /* by rounding alone that port would carry more */
        bg_reference *const before = at;
        at = after;
        after = before;
    }
    return NULL;
}
