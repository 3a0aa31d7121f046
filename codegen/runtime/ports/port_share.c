/* Redundant ports share a load so that the largest fraction of a port's breakaway effort is the
 * least possible, then the next largest of the ports that remain.
 *
 * Efforts may change along the rows of `ways`. A weighted sum of efforts that no row changes is a
 * load that its ports carry, whatever they share: at the least the fraction |load| / sum of
 * |weight| cap. The ports for which that is highest reach it; the others share along what
 * directions are left. */
#include <math.h>
#include <string.h>

#include "port_share.h"

static void swap(int count, double *a, double *b)
{
    for (int i = 0; i < count; i++) {
        const double kept = a[i];
        a[i] = b[i];
        b[i] = kept;
    }
}

/* Makes the column of `port` a unit vector with its one in row k. */
static void eliminate(bg_directions *d, int k, int port)
{
    double *pivot = d->rows + k * d->count;
    const double by = pivot[port];
    for (int i = 0; i < d->count; i++)
        pivot[i] /= by;
    for (int r = 0; r < d->free; r++) {
        double *row = d->rows + r * d->count;
        const double factor = r == k ? 0.0 : row[port];
        for (int i = 0; i < d->count && factor != 0.0; i++)
            row[i] -= factor * pivot[i];
    }
    d->pivots[k] = port;
}

void bg_reduce(bg_directions *d, int size, const int *ports)
{
    const double least = BG_NOTHING * bg_largest(d->free * d->count, d->rows);
    int rank = 0;
    for (; rank < d->free && rank < size; rank++) {
        double largest = -1.0;
        int row = rank, port = 0;
        for (int r = rank; r < d->free; r++)
            for (int i = 0; i < size; i++) {
                const double entry = fabs(d->rows[r * d->count + ports[i]]);
                if (entry > largest) {
                    largest = entry;
                    row = r;
                    port = ports[i];
                }
            }
        if (!(largest > least))
            break;
        if (row != rank)
            swap(d->count, d->rows + rank * d->count, d->rows + row * d->count);
        eliminate(d, rank, port);
    }
    d->free = rank;
}

/* Of the ports that were left those that a direction moves. */
static void keep_moving(const bg_directions *d, bg_load *load)
{
    int size = 0;
    for (int i = 0; i < load->size; i++) {
        double most = 0.0;
        for (int r = 0; r < d->free; r++)
            most = fmax(most, fabs(d->rows[r * d->count + load->left[i]]));
        if (most > BG_NOTHING)
            load->left[size++] = load->left[i];
    }
    load->size = size;
}

/* Settles the ports of one load, and leaves the directions that move none of them. */
static void take_out(const bg_reference *found, bg_load *load, bg_directions *d)
{
    const int count = d->count;
    int size = 0;
    d->free = 0;
    for (int k = 0; k < found->by.free; k++) {
        const double *row = found->by.rows + k * count;
        const int moves = found->weights[found->by.pivots[k]] != 0.0;
        for (int i = 0; i < count && moves; i++)
            load->efforts[i] += found->ways[k] * row[i];
        if (!moves)
            memcpy(d->rows + d->free++ * count, row, sizeof(double) * (size_t)count);
    }
    for (int i = 0; i < load->size; i++)
        if (found->weights[load->left[i]] == 0.0)
            load->left[size++] = load->left[i];
    load->size = size;
}

int bg_fair_share(const bg_hold *held, const double *caps, double *efforts)
{
    bg_directions d;
    bg_reference two[2];
    bg_load load;
    if (BG_FRICTION < 2)
        return BG_OK;
    const double least = BG_LEAST_CAP * bg_largest(held->count, efforts) + BG_TINY;
    d.free = held->share_count;
    d.count = load.size = held->count;
    memcpy(d.rows, held->ways, sizeof(double) * (size_t)(d.free * d.count));
    for (int i = 0; i < d.count; i++) {
        load.left[i] = i;
        load.efforts[i] = efforts[i];
        load.caps[i] = fmax(caps[i], least);
    }
    /* Each turn settles a port. */
    for (int turn = 0; turn <= BG_FRICTION && d.free > 0 && load.size > 0; turn++) {
        bg_reduce(&d, load.size, load.left);
        keep_moving(&d, &load);
        const bg_reference *const found = bg_settle(&load, &d, two);
        if (!found)
            return BG_NO_SHARE;
        take_out(found, &load, &d);
    }
    memcpy(efforts, load.efforts, sizeof(double) * (size_t)d.count);
    return BG_OK;
}
