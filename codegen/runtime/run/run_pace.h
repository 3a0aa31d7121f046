/* How short a moment is, and whether a run gets anywhere. */
#ifndef BG_RUN_PACE_H
#define BG_RUN_PACE_H

#include "config.h"
#include "port_set.h"
#include "tuning.h"

/* When latest stretches ended in an event; `next` is where the next time goes: on the oldest. */
typedef struct {
    double time[BG_STALLED];
    int next, full;
} bg_rounds;

/* Of each port that is the jump of a law when it was crossed last, how many of its latest leaps
 * could not be seen, and how fast it was crossed the last two times. */
typedef struct {
    double last[BG_MOST_PORTS];
    int unseen[BG_MOST_PORTS];
    double speed[BG_MOST_PORTS][2];
} bg_crossings;

/* The shortest time constant at the largest rate; what has none of its own is as slow as a run is
 * old, which is `elapsed`. As codegen/modes/pace.py. */
double bg_time_constant(double fastest, double elapsed);

/* How much later ties at t are decided: never beyond `following`, the inputs' next breakpoint. */
double bg_look_ahead(double time, double t, double following);

/* Too short to matter: in it, what starts from complete rest gets going. */
double bg_moment(double time);

/* No step is longer. */
double bg_longest_step(double elapsed);

/* Counts an event at t; whether the latest ones all were within a moment of a time constant. */
int bg_stalls(bg_rounds *rounds, double t, double time);

/* The pieces of all inputs at an instant: the segment of a table, when the latest of them began and
 * the next breakpoint of any; infinite where there is none. */
typedef struct {
    int segment;
    double begin, following;
} bg_span;

/* What holds of a table at t and just after; segment k lasts to breaks[k], the last for ever. */
bg_span bg_span_at(int segments, const double *breaks, double t);

#endif
