/* One stretch of a linear model in which nothing is watched: one exponential for each distance of
 * samples, so that it takes the same time whatever its rates and its length. */
#include "bg_internal.h"

#include <string.h>

enum { BG_LARGE = 500 }; /* larger states than 2 to this power are scaled down */

/* Where the stretch sets out, with the factor it is scaled by. */
static double set_out(const bg_context *c, const bg_place *p, bg_pair *z)
{
    double largest = 1.0;
    int exponent;
    for (int i = 0; i < BG_Z; i++)
        z[i] = (bg_pair){p->z[i], 0.0};
    for (int j = 0; j < BG_W; j++)
        z[BG_Z + j] = (bg_pair){c->inputs->constant[c->segment][j], 0.0};
    z[BG_F - 1] = (bg_pair){1.0, 0.0};
    for (int i = 0; i < BG_F; i++)
        largest = bg_greater(largest, fabs(z[i].hi));
    frexp(largest, &exponent);
    const double shrink = ldexp(1.0, exponent > BG_LARGE ? BG_LARGE - exponent : 0);
    for (int i = 0; i < BG_F; i++)
        z[i].hi *= shrink;
    return shrink;
}

int bg_free(bg_context *c, int *at, double stop)
{
    bg_ladder *const l = &c->ladder;
    bg_pair z[BG_F];
    bg_place p;
    bg_set_out(c, &p, *at, stop);
    bg_build(l, c->stretch.entry);
    const double shrink = set_out(c, &p, z), grid = c->task->grid;
    for (int even = 0; p.at <= p.last; p.at++, even = 1) {
        const int sample = p.at < p.last;
        const double to = sample ? c->task->times[p.at] : stop;
        if (sample && even && grid > 0.0)
            bg_leap_by(l, grid, z);
        else if (to > p.t)
            bg_climb(l, to - p.t, z);
        for (int i = 0; i < BG_Z; i++)
            p.z[i] = z[i].hi / shrink;
        p.t = to;
        if (!sample)
            break;
        memcpy(c->task->rows[p.at], p.z, sizeof p.z);
        c->task->modes[p.at] = bg_number(c->mode);
    }
    bg_arrive(c, &p, at);
    return BG_OK;
}
