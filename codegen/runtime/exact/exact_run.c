/* What the loop looks at and advances: affine maps of the modes, and exact stretches. */
#include "exact_internal.h"

#include <math.h>
#include <string.h>

void ex_sizes(unsigned long *sizes)
{
    sizes[0] = (unsigned long)sizeof(ex_context);
    sizes[1] = (unsigned long)sizeof(ex_model);
    sizes[2] = (unsigned long)sizeof(ex_mode);
    sizes[3] = (unsigned long)sizeof(ex_chains);
    sizes[4] = (unsigned long)(EX_ROW * sizeof(double));
}

void ex_forget(ex_context *c)
{
    c->clock = 0;
    c->place = -1;
    memset(&c->where, 0, sizeof c->where);
    memset(c->used, 0, sizeof c->used);
    memset(c->latest, 0, sizeof c->latest);
    c->ladder.known = 0;
}

/* A mode that is not affine may be looked at for what inputs rule of its slips alone. */
static int look(void *context, double t, const double *s, const int *mode)
{
    ex_context *const c = context;
    const ex_mode *found;
    const int status = ex_find(c, mode, &found);
    if (status == BG_NOT_AFFINE && found->none)
        return BG_NO_HOLD;
    if (status && !(status == BG_NOT_AFFINE && found->ruled))
        return status;
    return ex_show(c, t, s, found);
}

static void tell(void *context, const int *mode, const bg_instant *at, bg_port *ports,
                 bg_ruling *ruling)
{
    ex_context *const c = context;
    const ex_mode *found;
    ex_find(c, mode, &found);
    if (at)
        ex_round_shown(c, at->t, ports);
    else
        ex_ports(c->shot, ports);
    if (at)
        ex_round_stay(c, found, c->seen, c->shot, at->t, ports);
    else
        ex_keep(c, found, c->seen, ports);
    if (at)
        ex_round_hung(c, found, c->seen, at->t, ports);
    else
        ex_hang(c, found, c->seen, ports);
    if (!ruling)
        return;
    *ruling = (bg_ruling){.width = EX_PORTS, .count = found->ruled, .kept = found->held,
                          .unknown = found->supported ? BG_OK : BG_NOT_AFFINE,
                          .rows = found->ruling[0], .mix = found->mix[0]};
}

static int couple(void *context, const int *mode, bg_set *touched)
{
    ex_context *const c = context;
    const ex_model *const m = c->model;
    const ex_mode *found;
    const int status = ex_find(c, mode, &found);
    if (!found || found->none)
        return status;
    for (int i = 0; i < EX_K; i++)
        for (int j = 0; j < EX_K; j++)
            if (mode[i] == 0 && mode[j] == 0
                && (m->FQ[m->own[j]][i] != 0.0 || m->D[m->own[j]][i] != 0.0
                    || (found->joined[i] && found->joined[i] == found->joined[j])))
                bg_add(touched + i, j);
    return BG_OK;
}

/* What was kept of a segment is not of the one that bears its number once others are written. */
static int pass(void *context, double t, bg_span *span)
{
    ex_context *const c = context;
    const double since = c->inputs->since;
    const int status = ex_span(c->inputs, t, span);
    if (c->inputs->since != since) {
        c->runs++;
        c->known = 0;
        c->shown = NULL;
        for (int n = 0; n < c->decided; n++)
            c->choices[n].steady = -1;
    }
    return status;
}

/* States, and the terms that make up inputs. */
static void see(void *context, const int *slipping)
{
    ex_context *const c = context;
    const ex_mode *mode;
    ex_find(c, slipping, &mode);
    double v[EX_L], terms[EX_U] = {0};
    c->rounded = 0;
    ex_vector(c, c->run.at.t, c->s, v);
    for (int j = 0; j < EX_L; j++) {
        const double size = j >= EX_N + EX_W && j < EX_L - 1 ? 0.0 : fabs(v[j]);
        for (int i = 0; i < EX_U; i++)
            terms[i] += fabs(mode->shot[j][EX_AT_U + i]) * size;
    }
    for (int i = 0; i < EX_X; i++)
        c->peaks.x[i] = bg_greater(c->peaks.x[i], fabs(c->shot[EX_AT_X + i]));
    for (int i = 0; i < EX_U; i++)
        c->peaks.u[i] = bg_greater(c->peaks.u[i], terms[i]);
    ex_see_places(c, c->s);
    ex_see_hung(c, mode, v);
}

static int fastest(void *context, double *fastest)
{
    ex_context *const c = context;
    const ex_mode *mode;
    const int status = ex_find(c, c->run.mode, &mode);
    if (status == BG_OK)
        *fastest = bg_greater(mode->fastest, c->inputs->fastest[c->run.span.segment]);
    return status;
}

/* Removes the slip that is left at sticking ports: no energy but the slip's own. */
static int rest(void *context)
{
    ex_context *const c = context;
    const ex_mode *mode;
    double v[EX_L];
    const int status = ex_find(c, c->run.mode, &mode);
    if (status || mode->held == 0)
        return status;
    ex_vector(c, c->run.at.t, c->s, v);
    for (int k = 0; k < mode->held; k++) {
        double slip = 0.0;
        for (int j = 0; j < EX_L; j++)
            slip += mode->left[j][k] * v[j];
        for (int i = 0; i < EX_N; i++)
            c->s[i] += mode->take_away[k][i] * slip;
    }
    return BG_OK;
}

static int advance(void *context, double stop)
{
    ex_context *const c = context;
    const double begin = c->run.at.t;
    double slots[EX_G];
    int status = ex_begin(c, stop);
    if (status)
        return status;
    ex_know(c, begin);
    memcpy(slots, c->slots, sizeof slots);
    status = c->advance(c, stop);
    if (status == BG_OK && !c->stretch.foreseen)
        ex_notice(c, begin, slots);
    return status;
}

/* What is kept of strides and choices is of one run, which so is the same whatever was before. */
static void start_anew(ex_context *c)
{
    c->glancing = c->model->switched && !BG_RESETS;
    for (int i = 0; i < EX_K; i++)
        c->glancing &= ex_switches(c, i);
    c->stridden = c->decided = c->chosen = c->looked = c->vain = 0;
    c->runs++;
    c->place = -1;
    c->began = c->looks;
    c->met = 0;
}

bg_engine ex_engine(ex_context *c)
{
    const ex_model *const model = c->model;
    const bg_sight sight = {c, EX_N, EX_K, model->switched ? model->switches : NULL,
                            model->switches, model->stopping, model->coupled,
                            c->shot + EX_AT_RATE, c->point, c->struck, look, tell, ex_strike, couple,
                            BG_RESETS, model->resets, ex_become, model->clocks};
    return (bg_engine){sight, c, pass, see, fastest, ex_choose, rest, advance};
}

void ex_point(ex_context *c, const ex_model *model, const ex_inputs *inputs, ex_task *task)
{
    c->model = model;
    c->inputs = inputs;
    c->task = task;
    c->taken = c->unasked = 0;
    c->shown = NULL;
    c->advance = ex_advance;
    c->run.log.events = task->events;
    c->run.log.capacity = task->capacity;
}

void ex_prepare(ex_context *c, const ex_model *model, const ex_inputs *inputs, ex_task *task)
{
    ex_point(c, model, inputs, task);
    start_anew(c);
    c->known = c->next = 0;
    memcpy(c->s, task->start, sizeof c->s);
    memset(&c->peaks, 0, sizeof c->peaks);
    memset(c->farthest, 0, sizeof c->farthest);
}

int ex_run_by(ex_context *c, const ex_model *model, const ex_inputs *inputs, ex_task *task,
              ex_advancing *how, void *caller)
{
    ex_prepare(c, model, inputs, task);
    const bg_engine engine = ex_engine(c);
    c->advance = how;
    c->caller = caller;
    bg_set_out(&c->run, task->times[0], task->times[task->samples - 1], c->s, task->first);
    c->run.log.emptied = task->full != NULL;
    int status = bg_run(&engine, &c->run);
    task->count = c->run.log.count;
    if (status != BG_NEGATIVE)
        task->time = c->run.at.t;
    if (status)
        task->where = c->where;
    for (int i = 0; !status && i < EX_N; i++)
        if (!isfinite(c->s[i]))
            status = BG_NOT_FINITE;
    return status;
}

int ex_run(ex_context *c, const ex_model *model, const ex_inputs *inputs, ex_task *task)
{
    const int end = task->samples - 1;
    const ex_mode *last;
    int status = ex_run_by(c, model, inputs, task, ex_advance, 0);
    if (status == BG_OK)
        status = ex_make_room(c, end);
    if (status == BG_OK) {
        memcpy(ex_row_of(c, end), c->s, sizeof c->s);
        ex_find(c, c->run.mode, &last);
        *ex_mode_of(c, end) = c->place;
    }
    return status;
}

int ex_run_often(ex_context *c, const ex_model *model, const ex_inputs *inputs, ex_task *task,
                 int repeats, int anew)
{
    int status = BG_OK;
    for (int k = 0; k < repeats && !status; k++) {
        if (anew)
            ex_forget(c);
        status = ex_run(c, model, inputs, task);
    }
    return status;
}
