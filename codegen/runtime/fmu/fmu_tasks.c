/* Sampled tasks of a unit: their instants are time events, in co-simulation parts of runs. */
#include <math.h>
#include <string.h>

#include "fmu_common.h"

int fmu_due(fmu_instance *f, int *due)
{
    double ticked = fmax(f->at.ticked, f->at.time);
    int any = 0;
    for (int k = 0; k < BG_CLOCKS; k++) {
        const double latest = bg_clock_latest(bg_clocks + k, bg_reached(f->at.time));
        due[k] = latest > f->at.ticked;
        any |= due[k];
        ticked = fmax(ticked, latest);
    }
    f->at.ticked = ticked;
    return any;
}

fmu_error fmu_set_by_tasks(fmu_instance *f, const int *due)
{
    const bg_sight sight = bg_view_sight(&f->located.view);
    const bg_instant at = {.t = f->at.time, .time = FMU_SHORTEST, .following = INFINITY,
                           .s = f->at.s};
    f->stale = 1;
    return fmu_message(f, bg_set_by_tasks(&sight, &at, f->at.mode, due));
}

double fmu_next_tick(const fmu_instance *f)
{
    double first = INFINITY;
    for (int k = 0; k < BG_CLOCKS; k++)
        first = fmin(first, bg_clock_after(bg_clocks + k, f->at.ticked));
    return first;
}

double fmu_run_end(double from, double end)
{
    double last = -INFINITY;
    for (int k = 0; k < BG_CLOCKS; k++)
        last = fmax(last, bg_clock_latest(bg_clocks + k, bg_reached(end)));
    return last > from && bg_reached(last) >= end ? last : end;
}
