/* What the files of the engine share: what each does. */
#ifndef BG_EXACT_INTERNAL_H
#define BG_EXACT_INTERNAL_H

#include "exact_context.h"

#include <string.h>

/* exact_inputs.c: what holds at t and just after, a status; the slots at t in a segment; and w and its
 * rate from them. */
int ex_span(const ex_inputs *inputs, double t, bg_span *span);
void ex_slots(const ex_inputs *inputs, int segment, double t, double *g);
void ex_given(const ex_inputs *inputs, int segment, const double *g, double *w, double *dw);

/* The magnitudes of the terms that make up w, with what rounding of t adds. */
void ex_input_sizes(const ex_inputs *inputs, int segment, double t, double *w);

/* Whether ports are in the same modes, or alike touched. */
static inline int ex_is_alike(const int *one, const int *other)
{
    int differ = 0;
    for (int i = 0; i < EX_K; i++)
        differ |= one[i] ^ other[i];
    return differ == 0;
}

/* exact_modes.c: a mode, valid until others are looked for; everything at one instant in it; a status. */
int ex_is_same(const ex_key *one, const ex_key *other);
int ex_seek(ex_context *c, const int *mode, const ex_mode **found);
void ex_evaluate(ex_context *c, double t);
int ex_rests(const ex_mode *mode, int port);
void ex_vector(ex_context *c, double t, const double *s, double *v);
int ex_look(ex_context *c, double t, const double *s, const ex_mode *mode, double *shot);
void ex_ports(const double *shot, bg_port *ports);
void ex_round(const ex_context *c, const double *shot, double t, bg_port *ports);

/* The same in the context's `shot`, once where nothing has changed since; those of its latest look. */
int ex_show(ex_context *c, double t, const double *s, const ex_mode *mode);
void ex_round_shown(ex_context *c, double t, bg_port *ports);

/* exact_switch.c: whether a port is a switch; what keeps those of a mode, at v, and below what that is
 * none, at instants whose magnitudes are below `most` and their map's `shot`, too; their impulses, as
 * a choice wants them. */
int ex_switches(const ex_context *c, int port);
void ex_keep(const ex_context *c, const ex_mode *mode, const double *v, bg_port *ports);
void ex_round_stay(const ex_context *c, const ex_mode *mode, const double *v, const double *shot,
                   double t, bg_port *ports);
void ex_limit_stay(const ex_context *c, const ex_mode *mode, const double *most, const double *shot,
                   double t, bg_port *ports);
int ex_become(void *context, const bg_instant *at, const int *mode, double *values);
int ex_strike(void *context, const bg_instant *at, const int *mode, const double *speeds,
              double *s, bg_blow *blow);

/* exact_hung.c: whether a port is a jump of second order; of those what they hang on, at v, and below
 * what that counts as zero; how far it has been. */
int ex_hangs(const ex_context *c, int port);
void ex_hang(const ex_context *c, const ex_mode *mode, const double *v, bg_port *ports);
void ex_round_hung(const ex_context *c, const ex_mode *mode, const double *v, double t,
                   bg_port *ports);
void ex_see_hung(ex_context *c, const ex_mode *mode, const double *v);

/* exact_stop.c: whether a port is a stop that is apart in the context's mode; gaps and restitutions at
 * s, and below what gaps count as closed, where s changes at these rates; where displacements have
 * been. What is watched of switches, in a column of a stretch's state; -1: in its
 * constant part. */
int ex_is_apart(const ex_context *c, int port);
void ex_gaps(const ex_context *c, const double *s, bg_port *ports);
void ex_round_gaps(const ex_context *c, const double *s, const double *rate, double t, bg_port *ports);
void ex_see_places(ex_context *c, const double *s);
void ex_watch_gaps(const ex_context *c, int column, double *stay);

/* The mode that was looked for last is at hand. */
static inline int ex_find(ex_context *c, const int *mode, const ex_mode **found)
{
    if (c->place < 0 || !ex_is_alike(c->signs, mode))
        return ex_seek(c, mode, found);
    *found = c->model->modes[c->place];
    return (*found)->supported ? BG_OK : BG_NOT_AFFINE;
}

/* Inputs are evaluated once for an instant: slots, and w and its rate. */
static inline void ex_know(ex_context *c, double t)
{
    if (!c->known || c->known_time != t || c->known_segment != c->run.span.segment)
        ex_evaluate(c, t);
}

/* exact_assemble.c: an entry of the present mode, generator told; its triggers, from rows of slips,
 * efforts, caps and what keeps switches; whether a port has one trigger, and a cap that is only looked
 * at. */
void ex_assemble(ex_context *c, ex_entry *e);
void ex_triggers(const ex_context *c, const ex_mode *record, const double *shot, const double *stay,
                 double *to);
int ex_single(const ex_context *c, const ex_mode *record, int port);

/* exact_system.c: an entry of the cache, without and with exponentials, and stretches. */
int ex_begin(ex_context *c, double stop);
void ex_leaps(ex_context *c, ex_stretch *stretch, double h, const double *row);

/* exact_ladder.c: the ladder of an entry; z after any time, and after one for which an exponential of
 * its own is kept. */
void ex_build(ex_ladder *l, const ex_entry *e);
void ex_climb(ex_ladder *l, double length, ex_pair *z);
void ex_leap_by(ex_ladder *l, double h, ex_pair *z);

/* exact_free.c: to `stop`, where nothing is watched. */
int ex_free(ex_context *c, double stop);

/* exact_bounds.c: e for steps that divide h, whose exponential goes to E; bounds on its triggers'
 * fourth derivatives; and on rows of triggers times exp(M tau) during some steps, rows lost. */
void ex_divide(ex_context *c, ex_entry *e, double h, double (*E)[EX_Z]);
void ex_bound(ex_context *c, ex_entry *e, double (*E)[EX_Z]);
void ex_extremes(ex_context *c, const ex_entry *e, double step, int steps, double (*E)[EX_Z],
                 double (*rows)[EX_TRIGGERS], double (*most)[EX_TRIGGERS]);
void ex_rows_times(double (*rows)[EX_TRIGGERS], double (*M)[EX_Z],
                   double (*restrict to)[EX_TRIGGERS]);

/* exact_exponential.c: exp(M h) and its integral. */
void ex_exponential(ex_context *c, double (*M)[EX_Z], double norm, double h, double (*E)[EX_Z],
                    double (*gather)[EX_Z]);
void ex_multiply(double (*left)[EX_Z], double (*right)[EX_Z], double (*restrict product)[EX_Z]);

/* exact_roots.c: where a polynomial falls to zero in (begin, 1]: 1 if it does, 0 if not, -1 if the
 * search has no end. Whether one that begins about zero cannot come to -2 limit, nor to zero once it is
 * above limit: 0 where that is not sure. */
int ex_first_fall(const ex_powers *p, double begin, double *root);
double ex_value(const ex_powers *p, double tau);
int ex_only_rises(const ex_powers *p, double limit);

/* exact_series.c: from t by `length`, z in place; *ports are those whose event ended it at *end. And
 * the same where none can. */
int ex_series(ex_context *c, double t, double length, double *z, double *end, bg_set *ports);
void ex_glide(ex_context *c, double length, double *z);

/* Adds rows, by columns, times z; sums stay in registers, two for each that don't wait for each other. */
static inline void ex_add_columns(int rows, int width, const double *restrict columns,
                                  const double *restrict z, double *restrict to)
{
#pragma GCC unroll 1
    for (int i = 0; i < rows; i++) {
        double sum = to[i], other = 0.0;
#pragma GCC unroll 32
        for (int j = 0; j < EX_Z / 2; j++)
            sum += columns[j * width + i] * z[j];
#pragma GCC unroll 32
        for (int j = EX_Z / 2; j < EX_Z; j++)
            other += columns[j * width + i] * z[j];
        to[i] = sum + other;
    }
}

/* Rates and triggers of a state without constant parts. */
static inline void ex_differentiate(const ex_entry *e, const double *restrict z, double *restrict to)
{
    memset(to, 0, EX_WIDE * sizeof *to);
    ex_add_columns(EX_WIDE, EX_WIDE, e->rows[0], z, to);
}

/* exact_leap.c: steps from rows[0]; how many are certain to be without an event. */
int ex_leap(const ex_stretch *stretch, int count, double (*rows)[EX_ROW]);
void ex_fill(const ex_stretch *stretch, double *row);
void ex_uncertainty(const ex_stretch *stretch, const double *row, double *slack);

/* exact_stride.c: what is known of a stretch that begins with z and has to end at `stop`; NULL if that is
 * nothing. Its ends. Takes the stretch that has ended, from t on, where slots were so, to be known next
 * time. */
ex_stride *ex_known(ex_context *c, const double *z, double stop);
void ex_ends_of(const ex_stretch *stretch, const ex_stride *k, const double *restrict z,
                ex_ends *restrict to);
void ex_notice(ex_context *c, double t, const double *slots);

/* What is done at samples: `record` takes the one that a step has come to, `leap` goes on over
 * `count` samples at distances of h; the latest with its triggers is in `row`, or that of the task. */
typedef struct {
    void *self;
    const double *row;
    int (*record)(void *self, ex_context *c, ex_place *p);
    int (*leap)(void *self, ex_context *c, ex_place *p, int count, double h);
} ex_recorder;

/* exact_advance.c: to `stop` or the first event, into the rows of the task or elsewhere; its ends. A
 * friction level below zero is refused. */
int ex_advance(ex_context *c, double stop);
int ex_advance_by(ex_context *c, double stop, const ex_recorder *to);
void ex_set_out(ex_context *c, ex_place *p, double stop);
void ex_arrive(ex_context *c, ex_place *p);
int ex_check_levels(ex_context *c, double t, double *row);

/* exact_rows.c: room for a sample, where there is none by letting those before the latest be taken; for
 * events, likewise. A status. How many samples from one on there is room for. */
int ex_make_room(ex_context *c, int sample);
int ex_make_room_for_events(ex_context *c);
int ex_room(const ex_context *c, int sample);

/* The row of a sample, and its mode. */
static inline double *ex_row_of(const ex_context *c, int sample)
{
    return c->task->rows[sample - c->taken];
}

static inline int *ex_mode_of(const ex_context *c, int sample)
{
    return c->task->modes + (sample - c->taken);
}

/* exact_run.c: points to what a run is asked; makes ready for one, whatever was before; what its loop
 * looks at and advances; a run but for its last sample, a status. */
void ex_point(ex_context *c, const ex_model *model, const ex_inputs *inputs, ex_task *task);
void ex_prepare(ex_context *c, const ex_model *model, const ex_inputs *inputs, ex_task *task);
bg_engine ex_engine(ex_context *c);
int ex_run_by(ex_context *c, const ex_model *model, const ex_inputs *inputs, ex_task *task,
              ex_advancing *advance, void *caller);

/* exact_ahead.c: whether it is known where the stretch that has begun will end, which goes to `ahead`;
 * goes there, samples on the way. Whether a sample shows the instant just after a stop: it is a rounding
 * before it at the most. */
int ex_foresee(ex_context *c, double stop);
int ex_go_ahead(ex_context *c, ex_place *p, const ex_recorder *to);
int ex_shows_after(const ex_context *c, double sample, double stop);

#endif
