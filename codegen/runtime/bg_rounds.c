/* Whether a run gets anywhere. */
#include "bg_rounds.h"

int bg_stalls(bg_rounds *rounds, double t, double least)
{
    rounds->time[rounds->next] = t;
    rounds->next = (rounds->next + 1) % BG_STALLED;
    rounds->full |= rounds->next == 0;
    return rounds->full && t - rounds->time[rounds->next] < least;
}
