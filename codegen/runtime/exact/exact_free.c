/* One stretch of a linear model in which nothing is watched: one exponential for each distance of
 * samples, so that it takes the same time whatever its rates and its length. */
#include "exact_internal.h"

#include <string.h>

/* Where the stretch sets out, with the factor it is scaled by. */
static double set_out(const ex_context *c, const ex_place *p, ex_pair *z)
{
    double largest = 1.0;
    int exponent;
    for (int i = 0; i < EX_Z; i++)
        z[i] = (ex_pair){p->z[i], 0.0};
    for (int j = 0; j < EX_W; j++)
        z[EX_Z + j] = (ex_pair){c->inputs->constant[c->run.span.segment][j], 0.0};
    z[EX_F - 1] = (ex_pair){1.0, 0.0};
    for (int i = 0; i < EX_F; i++)
        largest = bg_greater(largest, fabs(z[i].hi));
    frexp(largest, &exponent);
    const double shrink = ldexp(1.0, exponent > BG_LARGE ? BG_LARGE - exponent : 0);
    for (int i = 0; i < EX_F; i++)
        z[i].hi *= shrink;
    return shrink;
}

int ex_free(ex_context *c, double stop)
{
    ex_ladder *const l = &c->ladder;
    ex_pair z[EX_F];
    ex_place p;
    int status = BG_OK;
    ex_set_out(c, &p, stop);
    ex_build(l, c->stretch.entry);
    const double shrink = set_out(c, &p, z), grid = c->task->grid;
    for (int even = 0; p.at <= p.last; p.at++, even = 1) {
        const int sample = p.at < p.last;
        const double to = sample ? c->task->times[p.at] : stop;
        if (sample && even && grid > 0.0)
            ex_leap_by(l, grid, z);
        else if (to > p.t)
            ex_climb(l, to - p.t, z);
        for (int i = 0; i < EX_Z; i++)
            p.z[i] = z[i].hi / shrink;
        p.t = to;
        if (!sample)
            break;
        status = ex_make_room(c, p.at);
        if (status)
            break;
        memcpy(ex_row_of(c, p.at), p.z, sizeof p.z);
        *ex_mode_of(c, p.at) = c->stretch.entry->place;
    }
    ex_arrive(c, &p);
    return status;
}
