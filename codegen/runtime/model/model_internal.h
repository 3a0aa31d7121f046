/* What the files of the runtime share with one another and with the generated model.c. */
#ifndef BG_MODEL_INTERNAL_H
#define BG_MODEL_INTERNAL_H

#include "model_runtime.h"
#include "port_switch.h"
#include "tuning.h"

/* The sizes of a model, as its files write them: friction ports, states, law states, both, inputs,
 * external inputs, readings; room for the ports, which may be none. */
enum {
    K = BG_FRICTION, N = BG_STATES, OWN = BG_LAW_STATES, ALL = N + OWN, M = BG_INPUTS,
    W = BG_EXTERNAL, ROWS = BG_READINGS, PORTS = BG_ROOM(K)
};

/* Where the nonzero entries of a matrix stand. */
typedef struct {
    int count;
    const int *rows, *columns;
} bg_pattern;

enum bg_matrix { BG_A, BG_J, BG_B, BG_E, BG_F, BG_D, BG_H, BG_K, BG_MATRICES };

typedef void bg_block(const bg_values *v, double *out);

/* Laws evaluated together: the inputs they give, what their ports receive. */
typedef struct {
    int count, loop;
    const int *inputs, *readings;
    bg_block *values;
} bg_group;

enum { BG_TABLE_HOLDS, BG_TABLE_EXTENDS, BG_TABLE_REFUSES };
enum { BG_TABLE_LINEAR, BG_TABLE_PCHIP, BG_TABLE_AKIMA, BG_TABLE_BILINEAR, BG_TABLE_BICUBIC,
       BG_TABLE_FIXED };

/* A table's value or derivatives; a region of 0 or more: by the polynomials of that stretch between
 * corners. */
double bg_interpolate(const bg_table *of, int order, double x, double region);
double bg_interpolate_over(const bg_table *of, int order_x, int order_y, double x, double y,
                           double region_x, double region_y);
/* What changes its sign at corners where a bit of the stretch's number in Gray's code does. */
double bg_edge(const bg_table *of, int axis, int bit, double x, double region);
/* The same of the lowest `bits` at once. */
void bg_edges(const bg_table *of, int axis, int bits, double x, double region, double *out);

/* model_fit.c: values of a table's own, to be changed; what is between them, worked out anew. */
double *bg_tables_values(bg_own_tables *own, int table);
int bg_tables_fit(bg_own_tables *own, int table);

/* An argument of a table that refuses what is outside, and along which axis it is one. `never`:
 * what is said where it guards a law that is turned round; else 0. */
typedef struct {
    int table, axis;
    const char *argument, *never;
} bg_refusing;

/* A law that rises or falls all over its domain, and its slope; no number outside that domain. */
typedef double (*bg_law)(double x, const double *a, double *slope);

/* Where a law has a value, with its parameters a; no number where it has it nowhere. */
double bg_searched(bg_law law, double begin, double value, const double *a);

/* As fmin, fmax and the sign, but no number where an argument is none. */
static inline double bg_min(double a, double b)
{
    return a < b || a != a ? a : b;
}

static inline double bg_max(double a, double b)
{
    return a > b || a != a ? a : b;
}

static inline double bg_sign(double a)
{
    return a > 0 ? 1.0 : a < 0 ? -1.0 : a;
}

/* Generated. */
extern const bg_table bg_tables[]; /* config.h has a name for each */
extern const bg_law bg_turnings[]; /* and for each of these */
extern const bg_refusing bg_refusings[];
void bg_refused(const bg_values *v, double *out); /* the values of those, in the order of laws */
extern const bg_pattern bg_layout[BG_MATRICES];
extern const bg_group bg_known, bg_groups[], bg_coupled;
/* The slips F x + D u of friction ports as residues: port k has those from bg_slip_begins[k] on, at
 * places among states, then inputs; the laws that it moves, by their order among the coupled. */
extern const int bg_slip_begins[], bg_slip_places[], bg_moved_begins[], bg_moved[];
extern const unsigned long long bg_slip_residues[], bg_prime, bg_prime_inverse; /* -1/p mod 2^64 */
extern const int bg_law_rates[], bg_friction_inputs[], bg_friction_readings[];
extern const int bg_outside_inputs[], bg_differentiable[], bg_output_readings[], bg_beside[];
/* The slips as the graph has them, where bg_friction_readings are along the tangents of laws. */
extern const int bg_received_readings[];
extern const int bg_moving[]; /* readings of how fast slips change by their factors; -1: none */
extern const bg_switch bg_switches[];
extern const bg_reset bg_resets[];
extern const bg_clock bg_clocks[];
extern const int bg_first_modes[]; /* before the first step, of friction anything */
extern const double bg_defaults[];
void bg_coefficients(const bg_values *v, double *out);
void bg_known_rates(const bg_values *v, double *out);
void bg_friction_values(const bg_values *v, double *out);
void bg_guards(const bg_values *v, double *out);
/* What storages hold of each state, then of readings, where impulses move slopes. */
void bg_momenta(const bg_values *v, double *out);
extern const int bg_momenta_rows[];
void bg_held_values(const bg_values *v, double *out);
/* Of each delay what it reads, how late it is [s], what it gives before. */
void bg_delaying(const bg_values *v, double *out);
/* What a start may tell of storages: where the values of each begin, and their end; the states that
 * it is a sum of, times these; or the one that a law gives, whose value it is. */
extern const int bg_held_begins[], bg_held_states[], bg_held_by_law[];
void bg_corners(const bg_values *v, double *out); /* what they hang on; whether each counts */
void bg_prepare_rhs(bg_model *m);

/* model_linear.c: by rows; n small or large. The largest magnitude; a copy, and what is behind. */
int bg_factor(int n, double *a, int *pivots);
void bg_solve(int n, const double *a, const int *pivots, int columns, double *right);
int bg_inverse(int n, double *a, int *pivots, double *inverse);
void bg_multiply_add(int rows, int columns, const double *a, const double *x, double *y);

/* The same by a list of the entries that are not zero, if there is one; and making it, where
 * `room` is for so many numbers. */
void bg_multiply_listed(int rows, int columns, const double *a, const int *list, const double *x,
                        double *y);
void bg_list_entries(int rows, int columns, const double *a, int room, int *list);
#define BG_LIST_ENTRIES(rows, columns, from, name) \
    bg_list_entries(rows, columns, (from)->name, (int)(sizeof (from)->name##_list / sizeof(int)), \
                    (from)->name##_list)
int bg_finite(int count, const double *values);
double bg_largest(int count, const double *values);
double *bg_put(double *to, int count, const double *from);

/* The next of a row of numbers between -1 and 1 that follow no structure; `noise` begins at 0. */
static inline double bg_stir(unsigned *noise)
{
    *noise = (1664525u * *noise + 1013904223u) & 0xffffffffu;
    return *noise / 2147483648.0 - 1.0;
}

/* model_numbers.c */
int bg_assemble(bg_model *m);
void bg_inverse_entries(bg_model *m, int count, const int *rows, const int *columns, double *out);
void bg_solve_storages(const bg_numbers *a, int columns, double *right);

/* port_rank.c: the ranks of a set of `count` ports. */
void bg_rank(bg_model *m, int count, const int *ports, bg_structure *structure);

/* port_independent.c: combinations of slips; whether redundant ports share a load; how far what
 * other inputs rule of slips is from leaving zero. */
int bg_independent(const bg_model *m, bg_hold *held, double *null);
int bg_shares(const bg_hold *held);
double bg_room(const bg_hold *held, int port, const bg_snapshot *shot, const double *near);

/* port_hold.c */
int bg_hold_of(bg_model *m, const int *mode, bg_hold **found);
int bg_holding_efforts(bg_model *m, const bg_hold *held, double *efforts);

/* The magnitudes of the terms that make those up. */
void bg_effort_terms(const bg_hold *held, const double *x, const double *u, const double *du,
                     double *sums);
void bg_correct(const bg_hold *held, double *rate, const double *du, const double *y);

/* The slips that bind the states, at an instant. */
void bg_held_slips(const bg_hold *held, const bg_snapshot *shot, double *slips);

/* Takes what slips are left at sticking ports from s, along A^-1 F^T; `shot` is of that mode. */
int bg_remove_slips(bg_model *m, const int *mode, const bg_snapshot *shot, double *s);

/* port_impact.c: per unit of each slip that the switches of a mode stop the impulse that each port
 * gives, slips by rows; what holds them, NULL if nothing does. What impulses add to s, and what
 * readings have of them. How far they go with the way of each switch, less what is rounding. */
int bg_impulses(bg_model *m, const int *mode, bg_hold **held, double *impulses);
void bg_pass_on(const bg_model *m, const double *given, double *s, double *received);
void bg_shocks(bg_model *m, const int *mode, const double *given, const double *received,
               double *ways);

/* Whether slips are more than those `near`, one for each port that is held; what they are beyond
 * those that ports are to have. */
int bg_have_slips(const bg_hold *held, const double *slips, const double *near);
void bg_less_speeds(const bg_hold *held, const double *speeds, double *slips);

/* port_bend.c: stops what holds, or brings it to the speeds that ports are to have (NULL: none), by
 * the impulses per unit of each slip, or, where they move slopes of storages, as momenta tell;
 * `before`: everything let go. `given` and `ways` grow by the impulses and by how far they go. */
int bg_stop(bg_model *m, const bg_snapshot *before, const int *mode, const bg_hold *held,
            const double *impulses, const double *speeds, double *s, double *given, double *ways);

/* port_start.c: all switches off. From how switches are told to be before a run, to how conditions
 * let them; states that are not `named` follow what they hold. */
void bg_all_off(int *mode);
int bg_complete(bg_model *m, double t, const double *w, const int *named, int *mode, double *s);

/* port_slips.c: a port's slip at an instant, and how fast it changes; in `terms` the magnitude of
 * what makes that up. */
double bg_slip(const bg_model *m, const bg_snapshot *now, int port, double *terms);
double bg_slip_rate(const bg_model *m, const bg_snapshot *now, int port, double *terms);

/* Below what slips count as zero after impulses at an instant: this part of their terms and of what
 * states gain. */
void bg_round_struck(const bg_model *m, const bg_snapshot *now, const double *given, double part,
                     double *near);

/* An instant at the start of a step of h, and the mode before it, if any step was. */
typedef struct {
    double t, h;
    const double *s, *w, *dw;
    const int *before;
    int started;
} bg_start;

/* port_step_task.c: where a step from t to the end is cut by the instant of a task, or the end;
 * which tasks are due at the start of a step of h, and whether any is, their latest instant; what
 * those set in s, a status. */
double bg_cut_step(const bg_model *m, double t, double end);
int bg_due_in_step(const bg_model *m, double t, double h, int *due, double *instant);
int bg_set_by_tasks_in_step(bg_model *m, const bg_start *at, const int *due, double *s);

/* model_recall.c: how late delays are at the model's parameters, and what they give first:
 * BG_NOT_LATE where that is nothing. What they read at the instant that was evaluated. */
int bg_set_lags(bg_model *m);
void bg_read_late(const bg_model *m, double *values);

/* The pieces of external inputs with what delays give of a run to `end`, from t on. */
void bg_pass_memory(bg_model *m, double t, double end, bg_span *span);

/* Of fixed steps: makes ready for one of h from t; the inputs at its start, middle and end with
 * what delays give there; takes in what these read in it. */
int bg_memory_ready(bg_model *m, double t, double h);
const double *bg_recalled(bg_model *m, double t, double h, const double *w);
int bg_remember_step(bg_model *m, double t, double h, const double *begin, const double *end,
                     const double *w, const int *mode);

/* A step's states a part of h from its begin, as its ends and the rates there, `first` and `last`,
 * tell them (Hermite's polynomial). */
void bg_between(double x, double h, const double *begin, const double *end, const double *first,
                const double *last, double *s);

/* model_step.c: inputs at a part of a step, on the parabola through their three values. */
void bg_on_parabola(double part, const double *w, double *of);

/* port_look.c: everything in a mode, in m->shot; in the first that can be of those that slip as
 * this one, which it becomes in `tried`. */
int bg_look(bg_model *m, const bg_start *at, const int *mode);
int bg_look_any(bg_model *m, const bg_start *at, const int *mode, int *tried);
int bg_look_slipping(bg_model *m, const bg_start *at, const int *mode);

/* port_response.c: what a unit of what each port gives does over a time, rates following after a
 * lag; how much slips yield to it, which it would push on, and whether none; s after what ports
 * give over that time. */
void bg_respond(bg_model *m, double time, double lag, bg_response *of);
int bg_yields(const bg_model *m, const bg_response *of, double *yields, int *reversed);
void bg_push(const bg_response *of, const double *given, double *s);

/* port_settle.c: bounds of what a switch gives in its mode, or of one that stays as it is; of
 * friction, which slips at a level and holds up to its cap, if it is at rest; modes by ways, by
 * which friction rests that is at its limit without a slip, unless that is `strict`. */
void bg_bound_switch(int port, int mode, int stays, bg_boxed *box);
void bg_bound_friction(int port, double level, double cap, int rests, bg_boxed *box);
void bg_take_ways(const bg_boxed *box, int strict, int *mode);

/* port_correct.c: counts what ports give at m->shot into the mean of a step, which is zero at
 * first, and notes slips where it begins; the end of a step, with s and m->mode after what
 * changes in it. */
void bg_note_given(bg_model *m, double part, int begins);
int bg_correct_step(bg_model *m, double t, double h, double *s, const double *w);

/* port_hang.c: the rows of jumps of second order where a step of h begins, and to what slips those
 * that hold are brought; of one where a step ends, to which it stays on its side. */
void bg_hang(bg_model *m, double h, bg_boxed *box);
void bg_hang_on(int port, bg_boxed *box);

/* port_step.c: m->mode for a step of h, and s after the impulses of switches that come to hold;
 * rates of inputs are in m->work. */
int bg_decide_step(bg_model *m, double t, double h, double *s, const double *w);

/* port_share.c: efforts of redundant ports as they share. */
int bg_fair_share(const bg_hold *held, const double *caps, double *efforts);

/* model_roots.c: a root of f between a and b, unless its signs there are the same: then 0. */
int bg_root(double (*f)(void *self, double at), void *self, double a, double b, double *found);

/* model_loops.c: inputs at `columns` for which the residual vanishes; `rows` are what they act
 * on. */
typedef struct {
    const bg_group *group; /* NULL for friction with the coupled laws */
    const int *mode;
    bg_hold *held;
    int count, checked;
    int columns[BG_ROOM(BG_LOOP)], rows[BG_ROOM(BG_LOOP)];
} bg_loop;
int bg_solve_loop(bg_model *m, const bg_loop *loop);

/* model_region.c: where the method is stable, as |h l|: on the negative axis, on the imaginary one,
 * and the least and the largest in the left half plane; the longest stable step where the roots of
 * l^2 = a l + b are the rates. */
#define BG_REAL_LIMIT 2.785293563405282
#define BG_IMAGINARY_LIMIT 2.8284271247461903
#define BG_NEAREST 2.6156
#define BG_FARTHEST 2.9603
double bg_stable_step(double a, double b);

/* model_slope.c: weights and magnitudes of the states at a step's start; the product of changes
 * whose square is twice their energy; image = J from, both times the weights, by a difference of so
 * many magnitudes. The first stage must be known. */
void bg_weigh(bg_model *m, double h);
void bg_reach(bg_model *m, double h, const double *s);
double bg_energy(const bg_model *m, const double *a, const double *b);
int bg_slope(bg_model *m, double t, const double *s, const double *w, double amount,
             const double *from, double *image);

/* model_fastest.c: BG_UNSTABLE if a step of h from t, s is beyond that. What the stages of a step
 * tell of the next. */
int bg_check_step(bg_model *m, double t, double h, const double *s, const double *w);
void bg_note_stages(bg_model *m);

/* model_level.c: of level, cap, curve and curve at rest of every port at `m->now` those become zero
 * that are below by no more than the rounding of their terms. */
void bg_without_rounding(bg_model *m, double *values);

/* Of conditions at `m->now`: the magnitude of the terms that make each up, and how fast it changes;
 * `shot`: the same instant, where the shortest time constant is `time`. */
void bg_guard_terms(bg_model *m, const bg_snapshot *shot, double time, double *terms,
                    double *slopes);

/* The first of these alone. */
void bg_told_terms(bg_model *m, double *terms);

/* Takes a vector that a run has come to into account: where it comes down to zero, it rounds. */
void bg_have_seen(bg_model *m, const double *s);

/* A step in m->mode, s in place: model_runge.c of the classical method, BG_UNSTABLE before anything
 * is changed; model_rosenbrock.c of a linearly implicit one, BG_INACCURATE after it is taken. */
int bg_runge_kutta(bg_model *m, double t, double h, double *s, const double *w);
int bg_rosenbrock(bg_model *m, double t, double h, double *s, const double *w);

/* model_evaluate.c */
void bg_give(bg_model *m, int count, const int *columns, const double *values);
int bg_residual(bg_model *m, const bg_loop *loop, double *left);
int bg_evaluate(bg_model *m, double t, const double *s, const double *w, const double *dw,
                const int *mode, int checked, bg_snapshot *shot);

#endif
