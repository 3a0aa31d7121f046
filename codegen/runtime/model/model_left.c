/* Which table was left, where a law has no value. */
#include <math.h>

#include "model_internal.h"

/* How far a place is beyond the ends; not a number where it is none. */
static double beyond(const bg_table *of, int axis, double x)
{
    const double *const breaks = of->breaks[axis];
    return bg_max(breaks[0] - x, x - breaks[of->cells[axis]]);
}

/* Of laws in turn the first whose argument is outside is what made the others no numbers. A run that
 * goes up to an end and no further is on it but for rounding. */
int bg_model_left(const bg_model *m, const char **argument, double *place)
{
    double values[BG_ROOM(BG_REFUSING)] = {0};
    bg_refused(&m->now, values);
    for (int near = 0; near < 2; near++)
        for (int i = 0; i < BG_REFUSING; i++) {
            const bg_refusing *const one = bg_refusings + i;
            const bg_table *const of = m->now.tables + one->table;
            const double *const breaks = of->breaks[one->axis];
            const double span = breaks[of->cells[one->axis]] - breaks[0];
            if (beyond(of, one->axis, values[i]) > (near ? -BG_TOGETHER * span : 0.0)) {
                *argument = one->argument;
                *place = values[i];
                return one->table;
            }
        }
    return -1;
}
