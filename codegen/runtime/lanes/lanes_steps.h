/* Both kinds of steps of runs side by side. */
#ifndef BG_LANES_STEPS_H
#define BG_LANES_STEPS_H

#include "lanes.h"
#include "lanes_weights.h"

enum { LANE_LAST = 12 /* the stage at an explicit step's end */ };

/* Explicit steps, each lane's of its own length. `middle`, `end`: of a step, everything. */
typedef struct {
    bg_lanes_group of;
    double rtol, atol;
    bg_lane t_old, t, h, y_old[BG_SIZE], y[BG_SIZE], tried[BG_SIZE], f[BG_SIZE];
    bg_lane stage[BG_EXPLICIT_STAGES][BG_SIZE], interpolation[7][BG_SIZE];
    bg_lane shot[LANE_ROWS], middle[LANE_ROWS], end[LANE_ROWS], fifth, third;
} bg_lanes_explicit;

/* Exponential steps, two at a time, each lane's of a fixed part of what lies between its samples.
 * `y`, `rest`: states and what their rates are more than the slope's, newest first; from two on as
 * before the latest two. `shot`, `w`: everything and the inputs before these, between them and
 * after. `error`: the sum of squares, in what the tolerance allows, of each; `time`: when they end;
 * `ahead`: see bg_lanes_ahead. `place`: how many steps
 * after the first sample; `since`: so many pairs with the present slope; `pairs`:
 * since it was looked whether steps may be longer. */
enum { LANE_PAIR = 2, LANE_WINDOW = LANE_PAST + LANE_PAIR };
typedef struct {
    bg_lanes_group of;
    double rtol, atol, gap;
    bg_lane E[BG_SIZE][BG_SIZE], weight[LANE_PAST][BG_SIZE][BG_SIZE];
    bg_lane correction[BG_SIZE][BG_SIZE], slope[BG_SIZE][BG_SIZE];
    bg_lane y[LANE_WINDOW][BG_SIZE], rest[LANE_WINDOW][BG_SIZE], seen[BG_SIZE];
    bg_lane shot[LANE_PAIR + 1][LANE_ROWS], w[LANE_PAIR + 1][BG_ROOM(BG_EXTERNAL)];
    bg_lane error[LANE_PAIR], time[LANE_PAIR];
    double ahead[LANE_PAST];
    long place[BG_LANES], parts[BG_LANES], since[BG_LANES], pairs[BG_LANES];
} bg_lanes_exponential;

/* A run's way into exponential steps: instants, newest first, with everything at the newest. */
typedef struct {
    long place, parts;
    double y[LANE_PAST][BG_SIZE], rest[LANE_PAST][BG_SIZE], shot[LANE_ROWS];
    double slope[BG_SIZE * BG_SIZE];
    bg_lane_weights weights;
} bg_lane_start;

/* `job`, `runs`: of many; NULL for a run by itself, which comes to `status`. `next`: the next run
 * to begin of so many. */
struct bg_lanes {
    const batch_job *job;
    const located_runs *runs;
    const double *times;
    int samples, next, count, status;
    bg_lanes_points points;
    bg_lanes_explicit explicit_steps;
    bg_lanes_exponential exponential;
    bg_lane_start start;
    bg_lane_run run[LANE_RUNS];
};

/* lanes_explicit.c: all stages of a step of every lane, and what its error is estimated by; what is
 * needed between its ends; states there, at the lanes' times; everything at states. */
void bg_lanes_attempt(bg_lanes_explicit *a);
void bg_lanes_dense(bg_lanes_explicit *a);
void bg_lanes_between(bg_lanes_explicit *a, bg_lane *s);

/* lanes_walk.c: a run to a lane of explicit steps, whether it could; one try of a step in every
 * lane, and what follows. */
int bg_lanes_walk_in(bg_lanes *a, int lane, bg_lane_run *one);
void bg_lanes_walk(bg_lanes *a);

/* lanes_exponential.c: two steps of every lane, from the window's newest instants. */
void bg_lanes_pair(bg_lanes_exponential *a);

/* lanes_clear.c: what is watched at an instant of a lane, positive while all stays as it is; notes
 * it as the latest there is. Whether nothing can happen between so many instants, at places x;
 * between three of four whose states and rates are known, from the first or the second on, by a
 * closer look at `ends`, these, and six more. */
enum { LANE_AROUND = 4 };
typedef struct {
    double t[LANE_AROUND], y[LANE_AROUND][BG_SIZE], rate[LANE_AROUND][BG_SIZE];
} bg_lanes_known;
void bg_lanes_watched(const bg_lane_run *one, const bg_lanes_own *own, int lane,
                      const bg_lane *shot, double *values);
void bg_lanes_note(const bg_lane_run *one, const double *values);
int bg_lanes_is_clear(int count, const double *x, const double (*v)[LANE_WATCHED]);
int bg_lanes_is_clear_closely(bg_lane_run *one, const bg_lanes_known *known, int first,
                              const double (*ends)[LANE_WATCHED]);

/* lanes_start.c: to exponential steps from where a run is, whether it could; so many of them, at
 * least, go on what lies between samples. */
int bg_lanes_start(bg_lanes *a, bg_lane_run *one);
long bg_lanes_parts(const bg_lanes *a, const bg_lane_run *one);

/* lanes_glide.c: the same of exponential steps; the time of a place. */
int bg_lanes_glide_in(bg_lanes *a, int lane, bg_lane_run *one);
void bg_lanes_glide(bg_lanes *a);
double bg_lanes_time(const bg_lanes *a, long place, long parts);

#endif
