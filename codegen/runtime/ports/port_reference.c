/* Pivots and one port more: the load of the highest fraction that begins, and what each carries. */
#include <math.h>
#include <string.h>

#include "port_share.h"

int bg_is_pivot(const bg_directions *d, int port)
{
    int found = 0;
    for (int k = 0; k < d->free; k++)
        found |= d->pivots[k] == port;
    return found;
}

double bg_least_entry(const bg_directions *d, int port)
{
    double most = 1.0;
    for (int k = 0; k < d->free; k++)
        most = fmax(most, fabs(d->rows[k * d->count + port]));
    return BG_NOTHING * most;
}

int bg_first_port(const bg_load *load, const bg_directions *d)
{
    double highest = -1.0;
    int found = -1;
    for (int i = 0; i < load->size; i++) {
        const int port = load->left[i];
        double sum = load->efforts[port], most = load->caps[port];
        if (bg_is_pivot(d, port))
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

void bg_refer(const bg_load *load, bg_reference *at)
{
    const bg_directions *const d = &at->by;
    const double least = bg_least_entry(d, at->last);
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
