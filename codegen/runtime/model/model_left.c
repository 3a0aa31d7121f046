/* Which table was left, where a law has no value. */
#include <math.h>

#include "model_internal.h"

static const double ENDLESS = 1e299;

/* Whether a failure is of what no table may have been left for. */
static int is_other(int status)
{
    return status != BG_NOT_FINITE && status != BG_COEFFICIENT && status != BG_NO_SOLUTION
        && status != BG_BAD_FRICTION && status != BG_STEPS;
}

/* How far a place is beyond the ends; not a number where it is none. */
static double beyond(const bg_table *of, int axis, double x)
{
    const double *const breaks = of->breaks[axis];
    return bg_max(breaks[0] - x, x - breaks[of->cells[axis]]);
}

/* Of laws in turn the first whose argument is outside is what made the others no numbers. What went
 * up to an end and no further stands on it but for rounding. */
static int left(const bg_model *m, const double *values)
{
    for (int near = 0; near < 2; near++)
        for (int i = 0; i < BG_REFUSING; i++) {
            const bg_refusing *const one = bg_refusings + i;
            const bg_table *const of = m->now.tables + one->table;
            const double *const breaks = of->breaks[one->axis];
            const double whole = breaks[of->cells[one->axis]] - breaks[0];
            /* What guards a law that is turned round may have no end. */
            const double span = whole < ENDLESS ? whole : 1.0;
            if (beyond(of, one->axis, values[i]) > (near ? -BG_ROUNDING * span : 0.0))
                return i;
        }
    return -1;
}

int bg_model_left(const bg_model *m, int status, bg_leaving *told)
{
    double values[BG_ROOM(BG_REFUSING)] = {0};
    int at;
    if (is_other(status))
        return 0;
    bg_refused(&m->now, values);
    at = left(m, values);
    if (at < 0)
        return 0;
    const bg_refusing *const one = bg_refusings + at;
    const bg_table *const of = m->now.tables + one->table;
    told->time = m->now.t;
    told->place = values[at];
    told->low = of->breaks[one->axis][0];
    told->high = of->breaks[one->axis][of->cells[one->axis]];
    told->table = bg_lookup_names[one->table];
    told->argument = one->argument;
    told->never = one->never;
    return 1;
}
