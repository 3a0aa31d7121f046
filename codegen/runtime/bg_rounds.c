/* How short a moment is, and whether a run gets anywhere. */
#include "bg_rounds.h"

#include <math.h>

#include "bg_choose.h"

#define SLOWEST 100.0   /* rate below which nothing is called fast while a run is young */
#define COARSEST 20.0   /* no step is longer than what went before divided by this */

double bg_time_constant(double fastest, double elapsed)
{
    return 1.0 / fmax(fastest, SLOWEST / fmax(elapsed, 1.0));
}

double bg_look_ahead(double time, double t, double following)
{
    return fmin(BG_LOOK_AHEAD * time, 0.5 * (following - t));
}

double bg_moment(double time)
{
    return BG_LOOK_AHEAD * fmin(time, 1.0 / SLOWEST);
}

double bg_longest_step(double elapsed)
{
    return fmax(elapsed, 1.0) / COARSEST;
}

int bg_stalls(bg_rounds *rounds, double t, double time)
{
    const double least = 2 * BG_STALLED * bg_moment(time);
    rounds->time[rounds->next] = t;
    rounds->next = (rounds->next + 1) % BG_STALLED;
    rounds->full |= rounds->next == 0;
    return rounds->full && t - rounds->time[rounds->next] < least;
}
