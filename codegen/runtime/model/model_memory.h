/* What delays have read so far of a run, and what they give of it. */
#ifndef BG_MODEL_MEMORY_H
#define BG_MODEL_MEMORY_H

#include "config.h"
#include "run_pace.h"

enum {
    BG_PAST_VALUES = 8, /* so many values of a part make its polynomials, at the most */
    BG_LAGS = BG_DELAYS > 0 ? BG_DELAYS : 1
};

/* The places at which parts are read as a rule, BG_PAST_VALUES of them: their ends are among them,
 * so that parts meet. */
const double *bg_past_places(void);

/* A part of a run: what each delay has read in it, by powers of the place, which goes from -1 on to
 * 1. */
typedef struct {
    double begin, end, powers[BG_LAGS][BG_PAST_VALUES];
    int count;
} bg_past;

/* Where a memory is: `begun` since when; up to `until` [s] it knows what was read; what it gives is
 * of the stretch from the break `stretch`, or the start, to the next, `following`. Parts and breaks
 * lie in rings, `count` from place `first` on, round the end. `back` [s]: to where the run may go
 * back; `late` [s], `start`: of each delay; `size`: the largest magnitude that it has read. */
typedef struct {
    int begun, first, count, first_break, breaks;
    double since, until, stretch, following, back;
    double late[BG_LAGS], start[BG_LAGS], size[BG_LAGS];
} bg_remembered;

typedef struct {
    bg_remembered is;
    double breaks[BG_MEMORY];
    bg_past parts[BG_MEMORY];
} bg_memory;

/* Begins at t: nothing has been read. Goes back to t. */
void bg_memory_begin(bg_memory *m, double t);
void bg_memory_back(bg_memory *m, double t);

/* From now on it gives what holds at t and just after: in the stretch between two breaks. */
void bg_memory_pass(bg_memory *m, double t);

/* What each delay gives at t, and its slope. Known up to the shortest delay after what was read. */
void bg_memory_at(const bg_memory *m, double t, double *values, double *slopes);
double bg_memory_shortest(const bg_memory *m);

/* Takes what was read from where it was known up to `end`: `count` values of each delay at places
 * from -1 to 1, delays by rows; `turns`: whether it may not go on smoothly there. BG_FORGETS where
 * there is no room that is not needed. */
int bg_memory_take(bg_memory *m, double end, int count, const double *places,
                   double (*values)[BG_PAST_VALUES], int turns);

#endif
