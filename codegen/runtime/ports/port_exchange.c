/* Which ports carry the load of the highest fraction: Stiefel's exchange (Numer. Math. 1, 1959;
 * Cheney, Introduction to Approximation Theory, ch. 2), the simplex method on the dual of the
 * linear program that shares ask for.
 *
 * A reference is one port more than there are directions; the fraction of its load rises as one of
 * its ports is exchanged for one that would carry more. Where the port that goes has no weight it
 * stays; ports then come by their number until it rises (Bland, Math. Oper. Res. 2, 1977), so that
 * none returns. */
#include <math.h>
#include <string.h>

#include "port_share.h"

static int is_pivot(const bg_directions *d, int port)
{
    int found = 0;
    for (int k = 0; k < d->free; k++)
        found |= d->pivots[k] == port;
    return found;
}

/* What of a port's column is rounding beside one. */
static double least_entry(const bg_directions *d, int port)
{
    double most = 1.0;
    for (int k = 0; k < d->free; k++)
        most = fmax(most, fabs(d->rows[k * d->count + port]));
    return BG_NOTHING * most;
}

/* The port that has with pivots the load of the highest fraction; -1 if all are. */
static int first_port(const bg_load *load, const bg_directions *d)
{
    double highest = -1.0;
    int found = -1;
    for (int i = 0; i < load->size; i++) {
        const int port = load->left[i];
        double sum = load->efforts[port], most = load->caps[port];
        if (is_pivot(d, port))
            continue;
        for (int k = 0; k < d->free; k++) {
            const double entry = d->rows[k * d->count + port];
            sum -= entry * load->efforts[d->pivots[k]];
            most += fabs(entry) * load->caps[d->pivots[k]];
        }
        if (fabs(sum) / most > highest || found < 0) {
            highest = fabs(sum) / most;
            found = port;
        }
    }
    return found;
}

/* The load of the pivots and `last`; at->sides: those of ports without weight. */
static void refer(const bg_load *load, bg_reference *at)
{
    const bg_directions *const d = &at->by;
    const double least = least_entry(d, at->last);
    double sum = load->efforts[at->last], most = load->caps[at->last];
    memset(at->weights, 0, sizeof(double) * (size_t)d->count);
    at->weights[at->last] = 1.0;
    for (int k = 0; k < d->free; k++) {
        const double entry = d->rows[k * d->count + at->last];
        const int port = d->pivots[k];
        at->weights[port] = fabs(entry) > least ? -entry : 0.0;
        sum += at->weights[port] * load->efforts[port];
        most += fabs(at->weights[port]) * load->caps[port];
    }
    at->fraction = fabs(sum) / most;
    at->sides[at->last] = copysign(1.0, sum);
    for (int k = 0; k < d->free; k++) {
        const int port = d->pivots[k];
        if (at->weights[port] != 0.0)
            at->sides[port] = copysign(1.0, sum) * copysign(1.0, at->weights[port]);
        at->ways[k] = at->fraction * at->sides[port] * load->caps[port] - load->efforts[port];
    }
}

/* The port that would carry the largest fraction above the reference's, or the first such, and its
 * side; -1 if none would. */
static int entering(const bg_load *load, const bg_reference *at, int first, double *side)
{
    double highest = -1.0;
    int found = -1;
    for (int i = 0; i < load->size && !(first && found >= 0); i++) {
        const int port = load->left[i];
        double sum = load->efforts[port], terms = fabs(sum);
        if (port == at->last || is_pivot(&at->by, port))
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

/* The pivot that a port on this side takes to its other side first; where it takes none there the
 * port beside the pivots. */
static int leaving(const bg_reference *at, int port, double side)
{
    const bg_directions *const d = &at->by;
    const double least = least_entry(d, port);
    double lowest = INFINITY;
    int found = at->last;
    for (int k = 0; k < d->free; k++) {
        const int pivot = d->pivots[k];
        const double entry = d->rows[k * d->count + port];
        if (!(fabs(entry) > least && side * entry * at->sides[pivot] > 0.0))
            continue;
        const double ratio = fabs(at->weights[pivot]) / fabs(entry);
        if (ratio < lowest || (ratio == lowest && pivot < found)) {
            lowest = ratio;
            found = pivot;
        }
    }
    return found;
}

/* The ports of a reference in order, one exchanged for another. */
static void list_ports(const bg_reference *at, int from, int to, int *ports)
{
    int size = 0;
    for (int port = 0; port < at->by.count; port++)
        if (port == to || (port != from && (port == at->last || is_pivot(&at->by, port))))
            ports[size++] = port;
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
        if (!is_pivot(&after->by, ports[i]))
            after->last = ports[i];
    memcpy(after->sides, at->sides, sizeof at->sides);
    after->sides[to] = side;
    refer(load, after);
    return 1;
}

/* The first reference; where no port is beside the pivots these are to carry nothing. */
static void begin(const bg_load *load, const bg_directions *d, bg_reference *at)
{
    copy_directions(d, &at->by);
    at->last = first_port(load, d);
    for (int i = 0; i < d->count; i++) {
        at->sides[i] = 1.0;
        at->weights[i] = is_pivot(d, i);
    }
    for (int k = 0; k < d->free; k++)
        at->ways[k] = -load->efforts[d->pivots[k]];
    if (at->last >= 0)
        refer(load, at);
}

const bg_reference *bg_settle(const bg_load *load, const bg_directions *d, bg_reference *two)
{
    bg_reference *at = two, *after = two + 1;
    int stays = 0;
    begin(load, d, at);
    for (int k = 0; k < BG_EXCHANGES; k++) {
        double side = 1.0;
        const int to = at->last < 0 ? -1 : entering(load, at, stays, &side);
        if (to < 0)
            return at;
        const int from = leaving(at, to, side);
        stays = at->weights[from] == 0.0;
        if (!exchange(load, d, at, from, to, side, after))
            return at;
        if (!stays && !(after->fraction > at->fraction))
            return at; /* by rounding alone that port would carry more */
        bg_reference *const before = at;
        at = after;
        after = before;
    }
    return NULL;
}
