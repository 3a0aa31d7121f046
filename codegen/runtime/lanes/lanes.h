/* Event-located runs side by side, each with its own time and step: the steps of up to so many runs
 * are worked out at once, a lane each, with their samples and the first look for events; whatever
 * else a run comes to is done for it by itself, as in located_run.c. What a run is worked out to
 * does not hang on the others. */
#ifndef BG_LANES_H
#define BG_LANES_H

#include "batch_located.h"
#include "lanes_config.h"
#include "located_internal.h"
#include "located_rows.h"

typedef double bg_lane[BG_LANES];

enum {
    LANE_SERIES = 20, /* so many terms at the most, of inputs about an instant */
    LANE_CORNERS = BG_MAP_ROWS, LANE_ROWS = LANE_CORNERS + 2 * BG_CORNERS, /* of an instant */
    LANE_WATCHED = BG_ROOM(K + BG_CORNERS), /* ports, then corners of laws */
    LANE_WIDE = N + M + BG_OUTSIDE, /* factors of what holds a port */
    /* explicit steps before others are tried again */
    LANE_FEW_STEPS = 3, LANE_PATIENCE = 8, LANE_NEVER = 1 << 30,
    LANE_RUNS = 2 * BG_LANES /* under way at a time, so that few lanes of either kind stand empty */
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

/* The steps a run goes by, or none: it is over. */
typedef enum { LANE_NONE, LANE_EXPLICIT, LANE_EXPONENTIAL } bg_lane_steps;

/* Of a run what is done by itself. `run`: which one; `tries`: how often the present explicit step
 * was tried; `reach` [s]: how far from its middle the series of inputs is one; `turns`: so many have
 * come to no breakpoint. Before exponential steps it takes so many explicit ones: `waits`, and those
 * up to the time `after`, where something may happen; the next time that they are too coarse
 * `patience`. They are so many times `finer` than rates ask. `was`: what is watched at the latest
 * two instants of these. */
typedef struct {
    struct bg_lanes *all;
    bg_together together;
    located_room *room;
    bg_lane_steps by;
    int seated, run, tries;
    long waits, patience, finer;
    double reach, grow, turns, after, constants[BG_ROOM(BG_LANE_CONSTANTS)];
    bg_request own;
    double was[2][LANE_WATCHED];
} bg_lane_run;

/* Runs that go by steps of one kind: in each lane one, or none. Their inputs are series about
 * `origin`, of so many `terms`. */
typedef struct {
    bg_lane_run *run[BG_LANES];
    bg_lanes_own own;
    bg_lanes_at at;
    bg_lane origin, series[BG_ROOM(BG_EXTERNAL)][LANE_SERIES];
    int terms;
} bg_lanes_group;

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

/* lanes_points.c: what works several points of a run out at once; sets so many up, at times, and
 * looks at them. Whether it could. */
void bg_lanes_join(bg_lane_run *one);
int bg_lanes_set(bg_lane_run *one, int count, const double *times);
int bg_lanes_see(bg_lane_run *one, int count, const double (*s)[BG_SIZE]);

/* lanes_series.c: the series of each input about t in the present pieces, which holds as far from
 * there as its fastest rate takes to change by LANE_REACH: how many terms all of them take, 0 where
 * that is more than there is room for. That of a lane's run, from where it is to `end`, if the
 * latest does not reach; 0 where there is none. Inputs of all lanes at their times. */
#define LANE_REACH 0.5
int bg_lanes_series(const bg_signals *signals, const bg_span *span, double t,
                    double (*series)[LANE_SERIES]);
int bg_lanes_follow(bg_lanes_group *group, int lane, double end);
void bg_lanes_inputs(bg_lanes_group *group);

/* lanes_load.c: whether a run may go by steps of lanes from where it is; its numbers and its mode
 * to a lane; the mode alone. The triggers of its ports at an instant of a lane, each positive while
 * all stays as it is. */
int bg_lanes_may(bg_lane_run *one);
void bg_lanes_load(bg_lanes_group *group, int lane, bg_lane_run *one);
int bg_lanes_load_mode(bg_lanes_own *own, int lane, const bg_located *c);
void bg_lanes_triggers(const bg_lanes_own *own, int lane, const bg_lane *shot, double *values);

/* Keeps what is followed of a sample at an instant of a lane; a status. What steps a run takes
 * next. */
int bg_lanes_keep(bg_lane_run *one, int lane, const bg_lane *s, const bg_lane *w,
                  const bg_lane *shot);
bg_lane_steps bg_lanes_kind(const bg_lane_run *one);

/* Exponential steps were too coarse for a run. */
void bg_lanes_too_coarse(bg_lane_run *one);

/* lanes_turn.c: begins a run, of many or by itself, and takes it on until it goes by steps of lanes
 * or is over; from where it is in its stretch, `ended` or not, at which it may have come to a
 * status; is done with it: where it could not go on so it is done another way, from its start. */
void bg_lanes_begin(bg_lane_run *one, int run);
void bg_lanes_begin_alone(bg_lane_run *one, const bg_signals *signals, bg_request *asked);
void bg_lanes_take_on(bg_lane_run *one, int ended, int status);
void bg_lanes_leave(bg_lane_run *one, int status);

/* Does every run, in LANE_RUNS rooms; a status for each. */
typedef struct bg_lanes bg_lanes;
void lanes_batch(bg_lanes *a, located_room *rooms, const batch_job *job, const located_runs *runs);

/* A run by itself, whose samples become the rows of a table, in a room; as bg_rows_run. */
int lanes_rows_run(bg_lanes *a, located_room *room, const double *parameters,
                   const bg_signals *signals, bg_request *asked, bg_rows *rows);
unsigned long lanes_size(void);
int lanes_rooms(void);

#endif
