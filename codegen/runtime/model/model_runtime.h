/* What a generated model is and does. Nothing is allocated, nothing is global: all of an instance
 * is one `bg_model`, which the caller puts where it likes; several run side by side. Every function
 * that can fail returns a status, 0 for success; `bg_model_message` says what it means. */
#ifndef BG_MODEL_RUNTIME_H
#define BG_MODEL_RUNTIME_H

#include <stddef.h>

#include "config.h"
#include "layout.h"
#include "model_memory.h"
#include "port_box.h"
#include "port_set.h"
#include "run_status.h"
#include "tuning.h"

/* Arrays of a length that may be zero have room for one. */
#define BG_ROOM(n) ((n) > 0 ? (n) : 1)
#define BG_TABLE(rows, columns) (BG_ROOM(rows) * BG_ROOM(columns))

/* Room to list which entries of a table are not zero: of a large one, if they are few. Begins with
 * where the columns of each row begin in the list; 0 in front where there is none. */
#define BG_LISTED(rows, columns) (BG_TABLE(rows, columns) >= BG_LARGE_TABLE)
#define BG_LIST(rows, columns) \
    (BG_LISTED(rows, columns) ? (rows) + 1 + BG_TABLE(rows, columns) / BG_FEW_ENTRIES : 1)

enum {
    /* The integrated vector s: states less what driven dependent storages add, then law states. */
    BG_SIZE = BG_ROOM(BG_STATES + BG_LAW_STATES),
    BG_STAGES = 6, /* of a step, at the most */
    BG_CUT = BG_CLOCKS > 0 || BG_DELAYS > 0, /* whether steps are cut */
    BG_MAP_COLUMNS = BG_SIZE + 2 * BG_EXTERNAL + 1,
    /* What ranks are found over: what friction and the laws that it moves give; states; inputs. */
    BG_RANKED = BG_FRICTION + BG_COUPLED + BG_STATES + BG_INPUTS
};

/* Where each part of an instant begins, BG_AT_x and so on, one after the other. */
#define BG_PLACE(part, count) BG_AT_##part, BG_LAST_##part = BG_AT_##part + (count) - 1,
enum { BG_PARTS(BG_PLACE) BG_MAP_ROWS };

/* A table: polynomials of a degree between breaks; `outside` tells what is beyond the ends. Along
 * an axis there are `cells` between breaks. The factors of each cell, those along the last axis in
 * turn, are of (x - x_i)^p (y - y_j)^q, highest powers first. They come of `counts` points along
 * each axis (over one, of 1 along the other), of values row by row; no slope over one axis is above
 * `steepest`. Of a table that is turned round the degree is -3: c3, c2, c1 and x of a cell. */
typedef struct {
    int degree, outside, cells[2];
    const double *breaks[2], *factors;
    int method, counts[2];
    const double *points[2], *values;
    double steepest;
} bg_table;

/* Tables with values of the caller's; room that the caller provides, and that stays where it is. */
typedef struct {
    bg_table tables[BG_ROOM(BG_TABLES)];
    double values[BG_ROOM(BG_TABLE_VALUES)], factors[BG_ROOM(BG_TABLE_FACTORS)];
    double work[BG_ROOM(BG_TABLE_WORK)];
} bg_own_tables;

/* One instant: time, states, law states, readings, inputs, external inputs and their rates. Where
 * `sided`, laws are on a side of each of their corners: 1 above the zero of what it hangs on. What
 * is not made of doubles comes last. */
typedef struct {
    double t;
    double x[BG_ROOM(BG_STATES)], z[BG_ROOM(BG_LAW_STATES)], y[BG_ROOM(BG_READINGS)];
    double u[BG_ROOM(BG_INPUTS)], w[BG_ROOM(BG_EXTERNAL)], dw[BG_ROOM(BG_EXTERNAL)];
    double p[BG_ROOM(BG_PARAMETERS)], side[BG_ROOM(BG_CORNERS)], sided;
    const bg_table *tables;
} bg_values;

/* Everything at one instant: states, law states, inputs and their rates, readings, the rate of s,
 * breakaway efforts. */
#define BG_FIELD(part, count) double part[BG_ROOM(count)];
typedef struct {
    BG_PARTS(BG_FIELD)
} bg_snapshot;

/* x' = P x + Q u + R u',  y = F x + D u + G u', by rows; A factored, its rows and columns scaled.
 * slip_F, slip_D: F and D of the friction ports' slips, as they stand without x'; of D what
 * friction and the laws coupled to it give. */
typedef struct {
    double P[BG_TABLE(BG_STATES, BG_STATES)], Q[BG_TABLE(BG_STATES, BG_INPUTS)];
    double R[BG_TABLE(BG_STATES, BG_INPUTS)];
    double F[BG_TABLE(BG_READINGS, BG_STATES)], D[BG_TABLE(BG_READINGS, BG_INPUTS)];
    double G[BG_TABLE(BG_READINGS, BG_INPUTS)];
    double A[BG_TABLE(BG_STATES, BG_STATES)], scale[BG_ROOM(BG_STATES)];
    double slip_F[BG_TABLE(BG_FRICTION, BG_STATES)];
    double slip_D[BG_TABLE(BG_FRICTION, BG_FRICTION + BG_COUPLED)];
    int pivots[BG_ROOM(BG_STATES)];
    int P_list[BG_LIST(BG_STATES, BG_STATES)], Q_list[BG_LIST(BG_STATES, BG_INPUTS)];
    int F_list[BG_LIST(BG_READINGS, BG_STATES)], D_list[BG_LIST(BG_READINGS, BG_INPUTS)];
    int G_list[BG_LIST(BG_READINGS, BG_INPUTS)];
} bg_numbers;

/* Ranks of one set of sticking ports, exact: `direct` rows of D, over the set and the coupled laws
 * that it moves, are independent in `direct_columns`; of the combinations that D leaves free (one
 * for each of `null`, positions of the other ports), those of positions `kept` are independent in
 * the states `kept_columns`; `ruled`: whether other inputs rule one that is not. */
typedef struct {
    int moved, direct, null, kept, ruled;
    int moved_laws[BG_ROOM(BG_COUPLED)];
    int direct_rows[BG_ROOM(BG_FRICTION)], direct_columns[BG_ROOM(BG_FRICTION)];
    int null_rows[BG_ROOM(BG_FRICTION)];
    int kept_rows[BG_ROOM(BG_FRICTION)], kept_columns[BG_ROOM(BG_FRICTION)];
} bg_structure;

/* The holding equations X x + U u + V u' = 0 of one set of sticking ports, `stuck`, where `used`
 * tells when they were asked for; `ready`: whether there are some at the present numbers.
 * Of `count` ports, the slips of `kept` combinations are states' and kept zero by taking away;
 * those of the first `ruled` rows of `share` are other inputs' and must be zero. Along `ways`, by
 * rows, efforts may change without moving anything. */
typedef struct {
    bg_set stuck;
    unsigned used;
    int ready, count, kept, share_count, ruled, ports[BG_ROOM(BG_FRICTION)];
    bg_structure ranks;
    double X[BG_TABLE(BG_FRICTION, BG_STATES)];
    double U[BG_TABLE(BG_FRICTION, BG_INPUTS)], V[BG_TABLE(BG_FRICTION, BG_INPUTS)];
    double inverse[BG_TABLE(BG_FRICTION, BG_FRICTION)], share[BG_TABLE(BG_FRICTION, BG_FRICTION)];
    double ways[BG_TABLE(BG_FRICTION, BG_FRICTION)];
    double slip_x[BG_TABLE(BG_FRICTION, BG_STATES)], slip_u[BG_TABLE(BG_FRICTION, BG_INPUTS)];
    double fixed[BG_TABLE(BG_FRICTION, BG_INPUTS)];
    double take_away[BG_TABLE(BG_STATES, BG_FRICTION)];
    double mix[BG_TABLE(BG_FRICTION, BG_FRICTION)]; /* what those slips are of the ports' own */
    int X_list[BG_LIST(BG_FRICTION, BG_STATES)], U_list[BG_LIST(BG_FRICTION, BG_INPUTS)];
    int V_list[BG_LIST(BG_FRICTION, BG_INPUTS)], fixed_list[BG_LIST(BG_FRICTION, BG_INPUTS)];
    int inverse_list[BG_LIST(BG_FRICTION, BG_FRICTION)];
    int slip_x_list[BG_LIST(BG_FRICTION, BG_STATES)];
    int take_away_list[BG_LIST(BG_STATES, BG_FRICTION)];
} bg_hold;

/* What a unit of what each friction port gives over a time adds to states and to readings, by
 * ports. */
typedef struct {
    double time, gains[BG_TABLE(BG_FRICTION, BG_STATES)];
    double readings[BG_TABLE(BG_FRICTION, BG_READINGS)];
} bg_response;

/* Room to work in, so that nothing large lies on the stack. */
typedef struct {
    int unshared; /* how redundant ports share a load is not asked, as it moves no state */
    double entries[BG_ROOM(BG_ENTRIES)], moved[BG_TABLE(BG_STATES, BG_FRICTION)];
    double law[BG_ROOM(BG_LARGEST)], more[BG_ROOM(BG_INPUTS)];
    double u[BG_ROOM(BG_INPUTS)], y[BG_ROOM(BG_READINGS)];
    double aim[BG_ROOM(BG_FRICTION)]; /* slips that ports which hold are brought to; as a rule 0 */
    double stage[BG_STAGES][BG_SIZE], point[BG_SIZE];
    double weight[BG_SIZE], reach[BG_SIZE], image[BG_SIZE], next[BG_SIZE];
    double given[3][BG_ROOM(BG_EXTERNAL)], rates[3][BG_ROOM(BG_EXTERNAL)];
    double recalled[3 * BG_ROOM(BG_EXTERNAL)];
    double origin[BG_MAP_ROWS], external[2][BG_ROOM(BG_EXTERNAL)];
    double mean[BG_ROOM(BG_FRICTION)], mean_caps[BG_ROOM(BG_FRICTION)]; /* over a step */
    double begun[BG_ROOM(BG_FRICTION)]; /* slips where it begins */
    double yields[BG_TABLE(BG_FRICTION, BG_FRICTION)];
    double system[BG_TABLE(BG_FRICTION, BG_FRICTION)];
    double implicit[BG_SIZE * BG_SIZE], gained[BG_TABLE(BG_STATES, BG_FRICTION)];
    int implicit_pivots[BG_SIZE];
    bg_response response;
    bg_boxed box;
    double loop[BG_ROOM(BG_LOOP)][6], slopes[BG_TABLE(BG_LOOP, BG_LOOP)];
    int pivots[BG_ROOM(BG_LOOP)];
    unsigned long long residues[BG_TABLE(BG_FRICTION, BG_RANKED)];
    double holding[BG_ROOM(BG_HOLDING_VALUES)];
    bg_values sizes;
} bg_work;

/* What a step knows of the model's fastest rates: a direction in which the rates move fast, and how
 * fast. `step`: after BG_UNSTABLE the longest step [s] that is stable there. */
typedef struct {
    double direction[BG_SIZE], growth, step;
    unsigned noise;
    int rounds;
} bg_fastest;

/* How the latest step ended. */
typedef struct {
    double s[BG_SIZE], w[BG_ROOM(BG_EXTERNAL)];
    int mode[BG_ROOM(BG_FRICTION)];
} bg_latest;

/* One instance. `band` [unit of each slip]: the dead band inside which a step lets a port stick;
 * `mode`: 0 sticking, 1 or -1 the sign of the slip; of a switch 0 where it is held, 1 where it is
 * let go; as the last step left it (`started`: there was one), or as switches are before the first.
 * `where`: the friction port or group of laws that a failure is about, -1 for none. `ticked`: the
 * instant [s] at which tasks last set what they set; `unclocked`: whether the caller runs them. The
 * rest is its own. */
typedef struct {
    double band[BG_ROOM(BG_FRICTION)], ticked;
    int mode[BG_ROOM(BG_FRICTION)], started, unclocked, where, decided;
    bg_fastest fastest;
    bg_values now;
    double seen[BG_SIZE]; /* the largest magnitudes of s at starts of steps: what it rounds by */
    double du[BG_ROOM(BG_INPUTS)], caps[BG_ROOM(BG_FRICTION)], constants[BG_ROOM(BG_CONSTANTS)];
    bg_numbers numbers;
    bg_hold holds[BG_HOLDS];
    unsigned asked; /* how often for what holds ports */
    bg_snapshot shot;
    bg_work work;
    bg_latest latest;
    bg_memory memory; /* of delays; the last, as it may be large */
} bg_model;

/* Names, units ("" where none is told) and defaults, in the order of the arrays; in model.c. */
extern const char *const bg_model_name;
extern const char *const bg_state_names[], *const bg_state_units[]; /* law states last */
extern const char *const bg_input_names[], *const bg_input_units[]; /* external inputs, as in w */
extern const char *const bg_output_names[], *const bg_output_units[];
extern const char *const bg_parameter_names[];
extern const char *const bg_friction_names[];
extern const char *const bg_lookup_names[];
extern const char *const bg_held_names[]; /* what storages hold, BG_HOLDINGS of them */
extern const char *const bg_task_names[]; /* BG_CLOCKS of them */

/* The parameters the model was generated at, BG_PARAMETERS of them. */
void bg_model_parameters(double *parameters);

/* Makes an instance; `parameters` may be NULL for those that the model was generated at. */
int bg_model_init(bg_model *m, const double *parameters);

/* The same with tables of the caller's, which `bg_tables_init` makes as the model was generated.
 * `bg_tables_set` gives one new values at its points, row by row of x, and works out what is
 * between them; BG_TABLE_VALUE where one is not finite. As with a parameter an instance is then
 * made again, which may go on with its `mode`, `seen`, `started`, `ticked` and `unclocked`, and by
 * `bg_model_remember` with what delays have read, which was `memory.is`. */
int bg_model_init_with(bg_model *m, const double *parameters, const bg_own_tables *own);
void bg_tables_init(bg_own_tables *own);
int bg_tables_set(bg_own_tables *own, int table, const double *values);

/* A table that refuses what is outside, its ends along an axis, and when which argument left it, to
 * this place; `never`: what is to be said of a law that is turned round and gives this in no state,
 * else 0. After a call that failed: whether one was left; model_left.h has it in words. */
typedef struct {
    double time, place, low, high;
    const char *table, *argument, *never;
} bg_leaving;
int bg_model_left(const bg_model *m, int status, bg_leaving *told);
void bg_model_remember(bg_model *m, const bg_remembered *was);

/* s from the states (law states last) and the external inputs: they differ where inputs drive
 * dependent storages. */
int bg_model_vector(bg_model *m, double t, const double *states, const double *w, double *s);

/* States at which storages hold what a start tells, the `held` that are `told`, in the order of
 * bg_held_names. The states that are `named` are kept; those that follow become so. 0, or 1 + the
 * place of one that does not tell a state: of a field all has to be told, or the other states. */
int bg_model_held(bg_model *m, const int *told, const double *held, int *named, double *states);

/* Before a run: switches of `mode` change over where their conditions say so, and states that are
 * not `named` follow what the switches then hold. */
int bg_model_complete(bg_model *m, double t, const double *w, const int *named, double *s);

/* Whether a port is a switch that is on, 1, or off, 0, in this mode of its; -1 for friction. */
int bg_model_switched(int port, int mode);

/* Everything at t, s, external inputs w and their rates dw (NULL: zero), in a friction mode. */
int bg_model_evaluate(bg_model *m, double t, const double *s, const double *w, const double *dw,
                      const int *mode, bg_snapshot *shot);

/* The outputs of a snapshot. */
void bg_model_outputs(const bg_snapshot *shot, double *outputs);

/* BG_MAP_ROWS x BG_MAP_COLUMNS: the parts of an instant as a matrix times [s, w, dw, 1]. */
int bg_model_affine_map(bg_model *m, const int *mode, double *matrix);

/* The rate of s of slipping friction in straight-line code; signs: +1 or -1 a friction port. For
 * models with `BG_STRAIGHT`; others take the way of `bg_model_evaluate`. */
int bg_model_rhs(bg_model *m, double t, const double *s, const double *w, const double *signs,
                 double *rate);

/* One step of h from t, s in place; w: the external inputs at t, t + h/2 and t + h, one after
 * the other. What delays give, BG_DELAYS of these from place BG_DELAYED_FROM on, steps look up
 * themselves: they follow one another or go back, and are cut where breaks come late, as at
 * instants of tasks. BG_FORGETS where BG_MEMORY parts of the past are too few.
 *
 * Work is bounded; config.h counts it. `bg_model_settle` decides which ports hold,
 * sets `mode`, gives the impulses of switches that come to hold to s and takes the slips of
 * sticking ports away; `bg_model_advance` goes on in that mode by Runge's and Kutta's method of
 * fourth order, or the linearly implicit one that the model was generated for, and stops or
 * turns round at the end of the step what would have gone through zero in it, so that `mode` is
 * that of the end.
 *
 * * A step of Runge's and Kutta's beyond its stability gives BG_UNSTABLE before anything is
 * changed, so a shorter one may follow; `fastest.step` is the longest that would be stable. Two
 * evaluations a step find that out, two more where rates may jump, 32 more in a refusal;
 * BG_CHECK_STEP 0 leaves them out. BG_PIVOTS and BG_INACCURATE tell of a step that was taken
 * (`bg_is_taken`): ports were not decided in so many pivots, s is the best that was found; the
 * error that an implicit step embeds is beyond 1 % of a state's range. */
int bg_model_step(bg_model *m, double t, double h, double *s, const double *w);
int bg_model_settle(bg_model *m, double t, double h, double *s, const double *w);
int bg_model_advance(bg_model *m, double t, double h, double *s, const double *w);

/* What delays give at t, in the stretch of a run that was settled last: external inputs of w, and
 * their slopes, where `dw` is not NULL. Steps do so themselves; `bg_model_evaluate` does not. */
void bg_model_recall(const bg_model *m, double t, double *w, double *dw);

/* Sampled tasks, such as controllers. By itself a step sets at its start what is due there, once at
 * each instant, and is cut at instants inside it, at the cost of a step more for each; its inputs
 * there are on the parabola through their three values. BG_INSTANTS where it would be more than
 * BG_CUTS parts. With the clock off, as it is after
 * `bg_model_clock` of 0, the caller runs tasks where it likes, as a timer or an interrupt tells:
 * `bg_model_tasks` sets what those set that are `due`, BG_CLOCKS flags, all told by what stood
 * before, of the external inputs w at t; the mode is decided anew by the next step. `bg_task_after`
 * is the first instant [s] of one after t. */
void bg_model_clock(bg_model *m, int on);
int bg_model_tasks(bg_model *m, double t, double *s, const double *w, const int *due);
double bg_task_after(int task, double t);

const char *bg_model_message(int status);
size_t bg_model_size(void);

#endif
