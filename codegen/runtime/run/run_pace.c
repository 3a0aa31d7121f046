/* How short a moment is, whether a run gets anywhere, and between which breakpoints it is. */
#include "run_pace.h"

#include <math.h>

#include "tuning.h"

double bg_time_constant(double fastest, double elapsed)
{
    return 1.0 / fmax(fastest, BG_SLOWEST / fmax(elapsed, 1.0));
}

double bg_look_ahead(double time, double t, double following)
{
    return fmin(BG_LOOK_AHEAD * time, 0.5 * (following - t));
}

double bg_moment(double time)
{
    return BG_LOOK_AHEAD * fmin(time, 1.0 / BG_SLOWEST);
}

double bg_longest_step(double elapsed)
{
    return fmax(elapsed, 1.0) / BG_COARSEST;
}

int bg_stalls(bg_rounds *rounds, double t, double time)
{
    const double least = 2 * BG_STALLED * bg_moment(time);
    rounds->time[rounds->next] = t;
    rounds->next = (rounds->next + 1) % BG_STALLED;
    rounds->full |= rounds->next == 0;
    return rounds->full && t - rounds->time[rounds->next] < least;
}

bg_span bg_span_at(int segments, const double *breaks, double t)
{
    int low = 0, high = segments - 1;
    while (low < high) {
        const int middle = (low + high) / 2;
        if (breaks[middle] <= t)
            low = middle + 1;
        else
            high = middle;
    }
    return (bg_span){low, low > 0 ? breaks[low - 1] : -INFINITY,
                     low + 1 < segments ? breaks[low] : INFINITY};
}
