/* Redundant ports share a load so that the largest fraction of a port's breakaway effort is the
 * least possible, then the next largest of the ports that remain.
 *
 * Efforts may change along the rows of `share`. A weighted sum of efforts that no row changes is a
 * load that its ports carry, whatever they share: at the least the fraction |load| / sum of
 * |weight| cap. The ports for which that is highest reach it; the others share along what
 * directions are left. */
#include <math.h>
#include <string.h>

#include "model_internal.h"
#include "port_ways.h"

enum { MOST_WAYS = 20000 }; /* of ports that may carry a load together */

/* Directions over all ports, by rows, and what each port can hold. */
typedef struct {
    int free, count;
    double rows[PORTS * PORTS], caps[PORTS];
} directions;

static void swap(int count, double *a, double *b)
{
    for (int i = 0; i < count; i++) {
        const double kept = a[i];
        a[i] = b[i];
        b[i] = kept;
    }
}

/* Makes the column of `port` a unit vector with its one in row k. */
static void eliminate(directions *d, int k, int port)
{
    double *pivot = d->rows + k * d->count;
    const double by = pivot[port];
    for (int i = 0; i < d->count; i++)
        pivot[i] /= by;
    for (int r = 0; r < d->free; r++) {
        double *row = d->rows + r * d->count;
        const double factor = r == k ? 0.0 : row[port];
        for (int i = 0; i < d->count; i++)
            row[i] -= factor * pivot[i];
    }
}

/* Gauss-Jordan elimination on the columns of `size` ports; pivots[k]: the port that row k has to
 * itself among them. The rank. */
static int reduce(directions *d, int size, const int *ports, int *pivots)
{
    const double least = BG_NOTHING * bg_largest(d->free * d->count, d->rows);
    int rank = 0;
    while (rank < d->free) {
        int row = rank, port = ports[0];
        for (int r = rank; r < d->free; r++)
            for (int i = 0; i < size; i++)
                if (fabs(d->rows[r * d->count + ports[i]])
                    > fabs(d->rows[row * d->count + port])) {
                    row = r;
                    port = ports[i];
                }
        if (!(fabs(d->rows[row * d->count + port]) > least))
            break;
        swap(d->count, d->rows + rank * d->count, d->rows + row * d->count);
        eliminate(d, rank, port);
        pivots[rank++] = port;
    }
    return rank;
}

/* The weights of the load that these `free + 1` ports carry; 0 if there are several. */
static int weigh(const directions *d, const int *ports, double *weights)
{
    directions own = *d;
    int pivots[PORTS], last = -1;
    if (reduce(&own, d->free + 1, ports, pivots) < d->free)
        return 0;
    memset(weights, 0, sizeof(double) * (size_t)d->count);
    for (int i = 0; i <= d->free; i++) {
        int taken = 0;
        for (int k = 0; k < d->free; k++)
            taken |= pivots[k] == ports[i];
        if (!taken)
            last = ports[i];
    }
    weights[last] = 1.0;
    for (int k = 0; k < d->free; k++)
        weights[pivots[k]] = -own.rows[k * d->count + last];
    for (int i = 0; i < d->count; i++)
        if (fabs(weights[i]) <= BG_NOTHING * bg_largest(d->count, weights))
            weights[i] = 0.0;
    return 1;
}

/* Of the ports that move, the weights of the load with the highest fraction; that fraction with
 * the load's sign. */
static double most_loaded(const directions *d, int moved, const int *ports, const double *efforts,
                          double *worst)
{
    double highest = -1.0, result = 0.0;
    int chosen[PORTS], set[PORTS];
    for (int i = 0; i <= d->free; i++)
        chosen[i] = i;
    do {
        double weights[PORTS], load = 0.0, most = 0.0;
        for (int i = 0; i <= d->free; i++)
            set[i] = ports[chosen[i]];
        if (!weigh(d, set, weights))
            continue;
        for (int i = 0; i < d->count; i++) {
            load += weights[i] * efforts[i];
            most += fabs(weights[i]) * d->caps[i];
        }
        if (fabs(load) / most > highest) {
            highest = fabs(load) / most;
            result = load / most;
            memcpy(worst, weights, sizeof weights);
        }
    } while (bg_next_choice(d->free + 1, moved, chosen));
    return result;
}

/* The ports that any direction moves. */
static int moving(const directions *d, int *ports)
{
    const double least = BG_NOTHING * bg_largest(d->free * d->count, d->rows);
    int count = 0;
    for (int i = 0; i < d->count; i++) {
        double most = 0.0;
        for (int r = 0; r < d->free; r++)
            most = fmax(most, fabs(d->rows[r * d->count + i]));
        if (most > least)
            ports[count++] = i;
    }
    return count;
}

/* Whether there are more choices of `size` among `total` than are looked at. */
static int too_many(int size, int total)
{
    double choices = 1.0;
    for (int k = 0; k < size; k++)
        choices *= (double)(total - k) / (k + 1);
    return choices > MOST_WAYS + 0.5;
}

/* Settles the ports of one load at its fraction, and leaves the directions that move none; 0 where
 * there are too many ways. */
static int settle_load(directions *d, double *efforts)
{
    double weights[PORTS] = {0}, fraction = 0.0;
    int ports[PORTS], pivots[PORTS], size = 0, rank;
    const int moved = moving(d, ports);
    if (too_many(d->free + 1, moved))
        return 0;
    if (moved > d->free) {
        fraction = most_loaded(d, moved, ports, efforts, weights);
        for (int i = 0; i < moved; i++)
            if (weights[ports[i]] != 0)
                ports[size++] = ports[i];
    } else {
        size = moved;
    }
    rank = reduce(d, size, ports, pivots);
    for (int k = 0; k < rank; k++) {
        const int port = pivots[k];
        const double way = fraction * bg_sign(weights[port]) * d->caps[port] - efforts[port];
        for (int i = 0; i < d->count; i++)
            efforts[i] += way * d->rows[k * d->count + i];
    }
    d->free = rank > 0 ? d->free - rank : 0;
    memmove(d->rows, d->rows + rank * d->count, sizeof(double) * (size_t)(d->free * d->count));
    return 1;
}

int bg_fair_share(const bg_hold *held, const double *caps, double *efforts)
{
    directions d;
    if (BG_FRICTION < 2)
        return 1;
    const double least = BG_LEAST_CAP * bg_largest(held->count, efforts) + BG_TINY;
    d.free = held->share_count;
    d.count = held->count;
    memcpy(d.rows, held->share, sizeof d.rows);
    for (int i = 0; i < d.count; i++)
        d.caps[i] = fmax(caps[i], least);
    while (d.free > 0)
        if (!settle_load(&d, efforts))
            return 0;
    return 1;
}
