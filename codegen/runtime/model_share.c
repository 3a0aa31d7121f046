/* Redundant ports share a load so that the largest fraction of a port's breakaway effort is the
 * least possible. One direction to choose along: where two ports carry equal fractions. More: the
 * least of the corners of the linear program, of which six ports have at most 924. */
#include <math.h>
#include <string.h>

#include "model_internal.h"

#define PORTS BG_ROOM(BG_FRICTION)
#define BIG 1e300

static double largest_fraction(int count, const double *efforts, double way,
                               const double *direction, const double *caps, double least)
{
    double worst = 0.0;
    for (int i = 0; i < count; i++)
        worst = fmax(worst, fabs(efforts[i] + way * direction[i]) / fmax(caps[i], least));
    return worst;
}

static double least_cap(int count, const double *efforts)
{
    double largest = 0.0;
    for (int i = 0; i < count; i++)
        largest = fmax(largest, fabs(efforts[i]));
    return 1e-12 * largest + 1e-300;
}

static void share_one_way(int count, const double *direction, const double *caps, double *efforts)
{
    const double least = least_cap(count, efforts);
    double best = 0.0, best_fraction = INFINITY;
    for (int i = 0; i < count; i++)
        for (int j = i; j < count; j++)
            for (int sign = 1; sign >= -1; sign -= 2) {
                const double slope = i == j ? direction[i]
                    : direction[i] * caps[j] - sign * direction[j] * caps[i];
                double way, fraction;
                if (slope == 0)
                    continue;
                way = i == j ? -efforts[i] / slope
                    : (sign * efforts[j] * caps[i] - efforts[i] * caps[j]) / slope;
                fraction = largest_fraction(count, efforts, way, direction, caps, least);
                if (fraction < best_fraction) {
                    best = way;
                    best_fraction = fraction;
                }
            }
    for (int i = 0; i < count; i++)
        efforts[i] += best * direction[i];
}

/* The corner where `free + 1` of the bounds sign (e + S^T a) = cap * fraction are met; 0: none. */
static int corner(const bg_hold *held, const double *caps, const double *efforts, const int *chosen,
                  double *found)
{
    double system[(PORTS + 1) * (PORTS + 1)];
    int pivots[PORTS + 1];
    const int count = held->count, size = held->share_count + 1;
    for (int r = 0; r < size; r++) {
        const int port = chosen[r] % count;
        const double sign = chosen[r] < count ? 1.0 : -1.0;
        for (int k = 0; k + 1 < size; k++)
            system[r * size + k] = sign * held->share[k * count + port];
        system[r * size + size - 1] = -caps[port];
        found[r] = -sign * efforts[port];
    }
    if (!bg_factor(size, system, pivots))
        return 0;
    bg_solve(size, system, pivots, 1, found);
    return bg_finite(size, found);
}

/* Efforts moved along all directions at once, and whether every port's bound is kept. */
static int moved(const bg_hold *held, const double *caps, const double *efforts,
                 const double *found, double *result)
{
    const int count = held->count, free = held->share_count;
    const double tolerance = 1e3 * least_cap(count, efforts);
    if (found[free] < 0)
        return 0;
    for (int i = 0; i < count; i++) {
        result[i] = efforts[i];
        for (int k = 0; k < free; k++)
            result[i] += held->share[k * count + i] * found[k];
        if (fabs(result[i]) > caps[i] * found[free] + tolerance)
            return 0;
    }
    return 1;
}

/* The next choice of `size` among `total`, in order; 0 after the last. */
static int next_choice(int size, int total, int *chosen)
{
    int at = size - 1;
    while (at >= 0 && chosen[at] == total - size + at)
        at--;
    if (at < 0)
        return 0;
    chosen[at]++;
    for (int i = at + 1; i < size; i++)
        chosen[i] = chosen[i - 1] + 1;
    return 1;
}

static void share_along_all(const bg_hold *held, const double *caps, double *efforts)
{
    double found[PORTS + 1], tried[PORTS], best[PORTS], least = BIG;
    int chosen[PORTS + 1];
    const int size = held->share_count + 1;
    memcpy(best, efforts, sizeof(double) * (size_t)held->count);
    for (int i = 0; i < size; i++)
        chosen[i] = i;
    do {
        if (corner(held, caps, efforts, chosen, found) && found[size - 1] < least
            && moved(held, caps, efforts, found, tried)) {
            least = found[size - 1];
            memcpy(best, tried, sizeof(double) * (size_t)held->count);
        }
    } while (next_choice(size, 2 * held->count, chosen));
    memcpy(efforts, best, sizeof(double) * (size_t)held->count);
}

void bg_fair_share(const bg_hold *held, const double *caps, double *efforts)
{
    if (held->share_count == 1)
        share_one_way(held->count, held->share, caps, efforts);
    else
        share_along_all(held, caps, efforts);
}
