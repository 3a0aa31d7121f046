/* Exact runs that pause. */
#include "exact_paused.h"

#include <math.h>
#include <string.h>

#include "exact_internal.h"
#include "run_paused.h"

typedef struct {
    bg_kept run;
    double s[EX_N], farthest[EX_PORTS];
    ex_peaks peaks;
} ex_kept;

/* `v`: what affine maps act on at the present instant; where it was arrived at, and as it was decided.
 */
struct ex_paused {
    double v[EX_L], times[2];
    ex_kept arrived, present;
};

enum { EX_KEPT_WIDTH = BG_KEPT_WIDTH + EX_N + EX_PORTS + EX_X + EX_U };

void ex_paused_sizes(unsigned long *sizes)
{
    sizes[0] = (unsigned long)sizeof(ex_paused);
    sizes[1] = (unsigned long)(2 * EX_KEPT_WIDTH * sizeof(double));
}

static void keep_exact(const ex_context *c, ex_kept *to)
{
    bg_keep(&c->run, &to->run);
    memcpy(to->s, c->s, sizeof to->s);
    memcpy(to->farthest, c->farthest, sizeof to->farthest);
    to->peaks = c->peaks;
}

static void take_up_exact(ex_context *c, const ex_kept *from, double stop)
{
    memcpy(c->s, from->s, sizeof c->s);
    memcpy(c->farthest, from->farthest, sizeof c->farthest);
    c->peaks = from->peaks;
    c->shown = NULL;
    bg_take_up(&c->run, &from->run, stop, c->s);
}

/* What is known of segments is not of those that bear their numbers once others are written. */
static void renew_inputs(ex_context *c)
{
    c->runs++;
    c->known = 0;
    c->shown = NULL;
    for (int n = 0; n < c->decided; n++)
        c->choices[n].steady = -1;
}

/* The present instant for the caller; a status. */
static int show_present(ex_context *c, ex_paused *p)
{
    const ex_mode *mode;
    int finite = 1;
    const int status = ex_find(c, c->run.mode, &mode);
    ex_vector(c, c->run.at.t, c->s, p->v);
    for (int j = 0; j < EX_L; j++)
        finite &= isfinite(p->v[j]) != 0;
    c->task->modes[0] = c->place;
    return status ? status : finite ? BG_OK : BG_NOT_FINITE;
}

/* To the end of the course, and what is just after it. */
static int go_exact(ex_context *c, ex_paused *to)
{
    const bg_engine engine = ex_engine(c);
    int status = bg_arrive(&engine, &c->run);
    keep_exact(c, &to->arrived);
    if (status == BG_OK)
        status = bg_finish(&engine, &c->run);
    keep_exact(c, &to->present);
    if (status == BG_OK)
        status = show_present(c, to);
    c->task->count = c->run.log.count;
    if (status != BG_NEGATIVE)
        c->task->time = c->run.at.t;
    c->task->where = c->where;
    if (status)
        c->decided = 0; /* what choices tell of magnitudes is not of those before */
    return status;
}

int ex_pause_first(ex_context *c, const ex_model *model, const ex_inputs *inputs, ex_task *task,
                   ex_paused *to)
{
    ex_prepare(c, model, inputs, task);
    bg_set_out(&c->run, task->times[0], task->times[0], c->s, task->first);
    return go_exact(c, to);
}

int ex_pause_next(ex_context *c, const ex_model *model, const ex_inputs *inputs, ex_task *task,
                  const ex_paused *from, ex_paused *to, double stop, int how, int renewed)
{
    const int again = how == BG_GO_ANEW || !from->present.run.decided;
    to->times[0] = from->present.run.t;
    to->times[1] = stop;
    ex_point(c, model, inputs, task);
    task->times = to->times;
    if (renewed)
        renew_inputs(c);
    take_up_exact(c, again ? &from->arrived : &from->present, stop);
    c->next = 1; /* the begin is no sample any more, and the end is before none */
    return go_exact(c, to);
}

int ex_pause_look(ex_context *c, const ex_model *model, const ex_inputs *inputs, ex_task *task,
                  ex_paused *p)
{
    ex_prepare(c, model, inputs, task);
    take_up_exact(c, &p->present, p->present.run.t);
    const bg_engine engine = ex_engine(c);
    const int status = bg_arrive(&engine, &c->run);
    return status ? status : show_present(c, p);
}

static void carry_exact(bg_carrier *by, ex_kept *kept)
{
    bg_carry_kept(by, &kept->run);
    bg_carry(by, kept->s, EX_N);
    bg_carry(by, kept->peaks.x, EX_X);
    bg_carry(by, kept->peaks.u, EX_U);
    bg_carry(by, kept->farthest, EX_PORTS);
}

void ex_pause_carry(ex_paused *p, double *numbers, int back)
{
    bg_carrier by = {numbers, back};
    carry_exact(&by, &p->arrived);
    carry_exact(&by, &p->present);
}
