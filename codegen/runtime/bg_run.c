/* The event-driven loop: stretches between breakpoints, sticking, release and zero crossings. */
#include "bg_internal.h"

#include <math.h>
#include <string.h>

void bg_sizes(unsigned long *sizes)
{
    sizes[0] = (unsigned long)sizeof(bg_context);
    sizes[1] = (unsigned long)sizeof(bg_model);
    sizes[2] = (unsigned long)sizeof(bg_mode);
    sizes[3] = (unsigned long)sizeof(bg_chains);
    sizes[4] = (unsigned long)(BG_ROW * sizeof(double));
}

void bg_forget(bg_context *c)
{
    c->clock = 0;
    memset(c->used, 0, sizeof c->used);
    c->ladder.known = 0;
}

/* Removes the slip that is left at sticking ports: no energy but the slip's own. */
static int come_to_rest(bg_context *c)
{
    const bg_mode *mode;
    double v[BG_L];
    const int status = bg_find(c, bg_number(c->mode), &mode);
    if (status)
        return status;
    if (mode->held == 0)
        return BG_OK;
    bg_vector(c, c->t, c->s, v);
    for (int k = 0; k < mode->held; k++) {
        double slip = 0.0;
        for (int j = 0; j < BG_L; j++)
            slip += mode->left[j][k] * v[j];
        for (int i = 0; i < BG_N; i++)
            c->s[i] += mode->take_away[k][i] * slip;
    }
    return BG_OK;
}

/* Takes the present instant into account, decides the mode there and removes slips that stick. */
static int settle(bg_context *c, int started)
{
    const bg_mode *mode;
    signed char before[BG_PORTS], touched = 0;
    int status = BG_OK;
    memcpy(before, c->mode, sizeof before);
    status = bg_find(c, bg_number(c->mode), &mode);
    if (status || BG_K == 0)
        return status;
    for (int i = 0; i < BG_K; i++)
        touched |= c->touched[i];
    const double fastest = bg_greater(mode->fastest, c->inputs->fastest[c->segment]);
    status = bg_decide(c, bg_time_constant(fastest, c->t - c->began));
    if (status == BG_OK && started) {
        bg_task *const task = c->task;
        if (bg_note(task->events, &task->count, task->capacity, c->t, BG_K, before, c->mode))
            status = BG_FULL;
        else if (touched && bg_stalls(&c->rounds, c->t, c->peaks.time))
            status = BG_STALLS;
    }
    return status ? status : come_to_rest(c);
}

static void begin(bg_context *c, const bg_model *model, const bg_inputs *inputs, bg_task *task)
{
    c->model = model;
    c->inputs = inputs;
    c->task = task;
    c->t = c->began = task->times[0];
    c->known = 0;
    c->rounds.next = c->rounds.full = 0;
    memcpy(c->s, task->start, sizeof c->s);
    memset(&c->peaks, 0, sizeof c->peaks);
    memset(c->touched, 0, sizeof c->touched);
    memset(c->mode, 1, sizeof c->mode);
    task->count = 0;
    task->where = -1;
}

/* At the end of a run: whether there is something to decide. The search may have missed an event
 * there by a rounding: what slips and is at rest, or sticks and is at its limit, counts as one. */
static int come_to_end(bg_context *c, int *undecided)
{
    const bg_mode *mode;
    bg_shot shot;
    bg_scales size;
    *undecided = c->segment > 0 && c->inputs->breaks[c->segment - 1] == c->t;
    int status = bg_find(c, bg_number(c->mode), &mode);
    if (status == BG_OK && BG_K > 0)
        status = bg_look(c, c->t, c->s, mode, shot);
    if (status || BG_K == 0)
        return status;
    bg_scale(c, shot, c->t, &size);
    for (int i = 0; i < BG_K; i++) {
        const double slip = fabs(shot[BG_AT_SLIP + i]), effort = fabs(shot[BG_AT_EFFORT + i]);
        if (c->mode[i] == 0)
            c->touched[i] |= shot[BG_AT_CAP + i] - effort <= BG_AT_REST * size.effort[i];
        else if (!c->model->coupled[i])
            c->touched[i] |= slip <= BG_AT_REST * size.slip[i];
        *undecided |= c->touched[i];
    }
    return BG_OK;
}

static int run(bg_context *c)
{
    const double end = c->task->times[c->task->samples - 1];
    const double most = 16.0 * c->task->capacity + c->inputs->segments + 1000.0;
    int status = BG_OK, at = 0;
    for (double turns = 0.0; !status && turns < most; turns += 1.0) {
        c->segment = bg_segment(c->inputs, c->t);
        int undecided = 1;
        if (turns > 0 && c->t >= end)
            status = come_to_end(c, &undecided);
        if (status || !undecided)
            return status;
        status = settle(c, turns > 0);
        if (status || c->t >= end)
            return status;
        double stop = end;
        if (c->segment + 1 < c->inputs->segments)
            stop = bg_lesser(c->inputs->breaks[c->segment], end);
        status = bg_begin(c, stop);
        if (status == BG_OK)
            status = c->advance(c, &at, stop);
    }
    return status ? status : BG_FULL;
}

int bg_run_by(bg_context *c, const bg_model *model, const bg_inputs *inputs, bg_task *task,
              bg_advancing *advance, void *caller)
{
    begin(c, model, inputs, task);
    c->advance = advance;
    c->caller = caller;
    int status = run(c);
    if (status != BG_NEGATIVE)
        task->time = c->t;
    if (status)
        task->where = c->where;
    for (int i = 0; !status && i < BG_N; i++)
        if (!isfinite(c->s[i]))
            status = BG_UNUSABLE;
    return status;
}

int bg_run(bg_context *c, const bg_model *model, const bg_inputs *inputs, bg_task *task)
{
    const int status = bg_run_by(c, model, inputs, task, bg_advance, 0);
    if (status == BG_OK) {
        memcpy(task->rows[task->samples - 1], c->s, sizeof c->s);
        task->modes[task->samples - 1] = bg_number(c->mode);
    }
    return status;
}

int bg_run_often(bg_context *c, const bg_model *model, const bg_inputs *inputs, bg_task *task,
                 int repeats, int anew)
{
    int status = BG_OK;
    for (int k = 0; k < repeats && !status; k++) {
        if (anew)
            bg_forget(c);
        status = bg_run(c, model, inputs, task);
    }
    return status;
}
