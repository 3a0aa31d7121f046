/* Event-located runs side by side, each in a lane of its own with its own time and step: explicit
 * steps, samples and the first look for events are worked out for all lanes at once; whatever else
 * a run comes to is done for it by itself, as in located_run.c. What a lane is worked out to does
 * not hang on the others. */
#ifndef BG_LANES_H
#define BG_LANES_H

#include "batch_located.h"
#include "lanes_config.h"
#include "located_internal.h"

typedef double bg_lane[BG_LANES];

enum {
    LANE_SERIES = 20, /* so many terms at the most, of inputs about an instant */
    LANE_CORNERS = BG_MAP_ROWS, LANE_ROWS = LANE_CORNERS + 2 * BG_CORNERS, /* of an instant */
    LANE_LAST = 12, /* the stage at a step's end */
    LANE_WIDE = N + M + BG_OUTSIDE /* factors of what holds a port */
};

/* What a lane's run is worked out with: what parameters determine; the way in which friction slips,
 * 0 where it holds, and the factors of what holds it, port by port: of states, inputs and the rates
 * of outside inputs. Slips that stick are left to drift by rounding in a stretch, as no step sees
 * that; its end takes them away. */
typedef struct {
    bg_lane constants[BG_ROOM(BG_LANE_CONSTANTS)], signs[BG_ROOM(K)];
    bg_lane held[BG_ROOM(BG_LANE_HELD)], sides[BG_ROOM(BG_CORNERS)];
} bg_lanes_own;

/* An instant of each lane: its time, external inputs and their rates. */
typedef struct {
    bg_lane t, w[BG_ROOM(BG_EXTERNAL)], dw[BG_ROOM(BG_EXTERNAL)];
} bg_lanes_at;

/* Several points of one run, a lane each. */
typedef struct {
    bg_lanes_own own;
    bg_lanes_at at;
    bg_lane s[BG_SIZE], rate[BG_SIZE], shot[LANE_ROWS];
} bg_lanes_points;

/* Of a lane what is done by itself. `run`: which one, -1 for none; `tries`: how often the present
 * step was tried; `taken`: whether it was good; `reach` [s]: how far from its middle the series of
 * inputs is one; `turns`: so many have come to no breakpoint. */
typedef struct {
    struct bg_lanes *all;
    bg_together together;
    located_room *room;
    int run, tries, taken;
    double reach, grow, turns;
    bg_request asked;
} bg_lane_run;

/* `terms`: so many of series; `next`: the next run; `middle`, `end`: of a step, everything. */
typedef struct bg_lanes {
    bg_lanes_own own;
    bg_lanes_at at;
    int terms, next;
    double rtol, atol;
    bg_lane t_old, t, h, y_old[BG_SIZE], y[BG_SIZE], tried[BG_SIZE], f[BG_SIZE];
    bg_lane stage[BG_EXPLICIT_STAGES][BG_SIZE], interpolation[7][BG_SIZE];
    bg_lane origin, series[BG_ROOM(BG_EXTERNAL)][LANE_SERIES];
    bg_lane shot[LANE_ROWS], middle[LANE_ROWS], end[LANE_ROWS], fifth, third;
    bg_lanes_points points;
    bg_lane_run lane[BG_LANES];
} bg_lanes;

/* Generated. Rates, and everything at an instant, with what corners hang on and whether each counts
 * in the end: by laws on one side of each corner, which have no value beyond it; rates by laws as
 * they are. */
void bg_lanes_prepare(bg_model *m, double *constants);
void bg_lanes_rates(const bg_lanes_own *restrict own, const bg_lanes_at *restrict at,
                    const bg_lane *restrict s, bg_lane *restrict out);
void bg_lanes_look(const bg_lanes_own *restrict own, const bg_lanes_at *restrict at,
                   const bg_lane *restrict s, bg_lane *restrict out);
void bg_lanes_plain(const bg_lanes_own *restrict own, const bg_lanes_at *restrict at,
                    const bg_lane *restrict s, bg_lane *restrict out);

/* lanes_step.c: all stages of a step of every lane, and what its error is estimated by; what is
 * needed between its ends; states there, at the lanes' times; everything at states. */
void bg_lanes_attempt(bg_lanes *a);
void bg_lanes_dense(bg_lanes *a);
void bg_lanes_between(bg_lanes *a, bg_lane *s);
void bg_lanes_shoot(bg_lanes *a, const bg_lane *s, bg_lane *shot);

/* Rates of lanes that have no numbers on this side of a corner become those of laws as they are. */
void bg_lanes_mend(const bg_lanes_own *own, const bg_lanes_at *at, const bg_lane *s, bg_lane *rate);

/* The triggers of a lane's ports at an instant, positive while the mode holds. */
void bg_lanes_triggers(const bg_lanes_own *own, int lane, const bg_lane *shot, double *values);

/* lanes_points.c: what works several points of a lane's run out at once. */
void bg_lanes_join(bg_lanes *a, int lane);

/* lanes_series.c: the series of each input about t in the present pieces, which holds as far from
 * there as its fastest rate takes to change by LANE_REACH: how many terms all of them take, 0 where
 * that is more than there is room for. */
#define LANE_REACH 0.5
int bg_lanes_series(const bg_signals *signals, const bg_span *span, double t,
                    double (*series)[LANE_SERIES]);

/* lanes_load.c: the present mode of a run to a lane; puts a lane where its run is as a stretch
 * begins; the series of inputs from there to `end`, if the latest one does not reach. All give 0
 * where the run has to go on by itself. Puts the lane's latest step into the run's solver, with all
 * between its ends. */
int bg_lanes_load_mode(bg_lanes_own *own, int lane, const bg_located *c);
int bg_lanes_load(bg_lanes *a, int lane);
int bg_lanes_follow(bg_lanes *a, int lane, double end);
void bg_lanes_unload(const bg_lanes *a, int lane);

/* Does every run, in so many rooms as there are lanes; a status for each. */
void lanes_batch(bg_lanes *a, located_room *rooms, const batch_job *job, const located_runs *runs);
unsigned long lanes_size(void);

#endif
