/* Choices of mode that are made again. */
#include "exact_glance.h"

#include <math.h>
#include <string.h>

#include "port_ways.h"
#include "run_pace.h"

/* Whether magnitudes are still those that what counts as zero was bounded for. */
static int in_bounds(const ex_context *c, const ex_choice *k, const double *v)
{
    double w[EX_W];
    int in = 1;
    for (int i = 0; i < EX_X; i++)
        in &= c->peaks.x[i] <= k->most_x[i];
    for (int i = 0; i < EX_U; i++)
        in &= c->peaks.u[i] <= k->most_u[i];
    for (int j = 0; j < EX_N; j++)
        in &= fabs(v[j]) <= k->most[j];
    for (int i = 0; i < EX_K && c->model->stopping; i++)
        in &= c->farthest[i] <= k->farthest[i];
    if (k->steady == c->run.span.segment)
        return in;
    ex_input_sizes(c->inputs, c->run.span.segment, c->run.at.t, w);
    for (int j = 0; j < EX_W; j++)
        in &= w[j] <= k->most[EX_N + j] && w[j] >= k->low[j];
    for (int j = EX_N; j < EX_L; j++)
        in &= fabs(v[j]) <= k->most[j];
    return in;
}

/* Whether all rows are above what they have to be. */
static int holds(const ex_choice *k, const double *v)
{
    int all = 1;
    for (int first = 0; first < k->rows; first += EX_LANE) {
        double over[EX_LANE];
#pragma GCC unroll 1
        for (int i = 0; i < EX_LANE; i++) {
            double sum = 0.0;
#pragma GCC unroll 32
            for (int j = 0; j < EX_L; j++)
                sum += k->row[j][first + i] * v[j];
            over[i] = sum - k->least[first + i];
        }
        for (int i = 0; i < EX_LANE; i++)
            all &= over[i] > 0.0;
    }
    return all;
}

/* Whether ties are decided as late as those of a choice were. */
static int is_as_late(const ex_context *c, const ex_choice *k)
{
    const bg_instant *const at = &c->run.at;
    return at->time == k->time && at->t <= k->until && c->inputs->fastest[c->run.span.segment] <= k->pace
        && bg_look_ahead(at->time, at->t, at->following) == BG_LOOK_AHEAD * at->time;
}

/* The mode by a choice that is made again; 0 if there is none. */
static int is_made(ex_context *c)
{
    double v[EX_L];
    ex_vector(c, c->run.at.t, c->s, v);
    for (int n = 0; n < c->decided; n++) {
        ex_choice *const k = c->choices + n;
        if (!ex_is_alike(k->before, c->run.mode)
            || !ex_is_alike(k->touched, c->run.at.touched)
            || !is_as_late(c, k) || !holds(k, v) || !in_bounds(c, k, v))
            continue;
        k->used = ++c->chosen;
        memcpy(c->run.mode, k->after, EX_K * sizeof *k->after);
        return 1;
    }
    return 0;
}

/* Whether all inputs of a segment but their constant parts turn as they are. */
static int is_steady(const ex_inputs *inputs, int segment)
{
    const ex_chains *const chains = inputs->structures + inputs->chains[segment];
    int steady = 1;
    for (int i = 0; i < chains->count; i++)
        steady &= chains->rate[i][0] == 0.0 && chains->depth[i] == 1;
    return steady;
}

/* What sizes a choice may be kept for: twice those at hand. */
static void allow(ex_glance *g)
{
    const ex_context *const c = g->c;
    ex_choice *const to = g->to;
    const double pace = to->pace = c->inputs->fastest[c->run.span.segment];
    double w[EX_W], later[EX_W];
    to->until = 2.0 * fabs(c->run.at.t);
    to->steady = is_steady(c->inputs, c->run.span.segment) ? c->run.span.segment : -1;
    ex_input_sizes(c->inputs, c->run.span.segment, c->run.at.t, w);
    ex_input_sizes(c->inputs, c->run.span.segment, to->until, later);
    for (int i = 0; i < EX_X; i++)
        to->most_x[i] = 2.0 * c->peaks.x[i];
    for (int i = 0; i < EX_U; i++)
        to->most_u[i] = 2.0 * c->peaks.u[i];
    for (int j = 0; j < EX_L; j++)
        to->most[j] = 2.0 * fabs(g->v[j]);
    for (int j = 0; j < EX_N && j < EX_X; j++)
        to->most[j] = bg_greater(to->most[j], to->most_x[j]);
    for (int i = 0; i < EX_K && c->model->stopping; i++) {
        double *const own = to->most + c->model->switches[i].place;
        to->farthest[i] = 2.0 * c->farthest[i];
        if (c->model->switches[i].kind == BG_STOPS)
            *own = bg_greater(*own, to->farthest[i]);
    }
    for (int j = 0; j < EX_W; j++) {
        to->low[j] = 0.5 * w[j];
        later[j] = bg_greater(to->steady < 0 ? 0.0 : later[j], w[j]);
        to->most[EX_N + j] = bg_greater(to->most[EX_N + j], 2.0 * later[j]);
        to->most[EX_N + EX_W + j] = bg_greater(to->most[EX_N + EX_W + j], 2.0 * pace * later[j]);
    }
}

/* What slips of a mode in which all is let go count as zero below, at the most and at the least. */
static int look_loose(ex_glance *g)
{
    const ex_mode *loose;
    int all[BG_MOST_PORTS];
    ex_limits limits;
    for (int i = 0; i < EX_K; i++)
        all[i] = 1;
    if (ex_find(g->c, all, &loose))
        return 0;
    ex_limit(g, loose, g->to->most, &limits);
    for (int i = 0; i < EX_K; i++) {
        g->near[i] = limits.ports[i].near_slip;
        g->rate[i] = limits.shot[EX_AT_RATE + g->c->model->switches[i].place];
        g->low[i] = 0.0;
        for (int j = 0; j < EX_X; j++)
            g->low[i] += BG_ROUNDING * g->c->model->F[j][i] * g->c->peaks.x[j];
    }
    return 1;
}

/* Keeps a choice from a mode to the present one, if it can be told at a first look. */
static void keep(ex_context *c, const int *before)
{
    ex_choice *to = c->choices + (c->decided < EX_CHOICES ? c->decided : 0);
    bg_set switches = {{0}}, guarded = {{0}};
    int found = 0;
    for (int n = 1; c->decided == EX_CHOICES && n < EX_CHOICES; n++)
        if (c->choices[n].used < to->used)
            to = c->choices + n;
    ex_glance g = {.c = c, .to = to};
    to->used = to->rows = 0;
    to->before[0] = EX_NEVER;
    to->time = c->run.at.time;
    ex_vector(c, c->run.at.t, c->s, g.v);
    allow(&g);
    if (!is_as_late(c, to) || !look_loose(&g) || !ex_bar_stops(&g, before))
        return;
    for (int i = 0; i < EX_K; i++) {
        if (bg_has(&g.barred, i))
            continue;
        bg_add(&switches, i);
        if (c->model->switches[i].kind == BG_TOLD)
            bg_add(&guarded, i);
    }
    bg_set first = bg_held_in(EX_K, before);
    for (int k = 0; k < BG_SET_WORDS; k++)
        first.bits[k] &= switches.bits[k];
    if (bg_try_ways(EX_K, &switches, &guarded, first, ex_glance_at, &g, &found) || !found
        || !ex_is_alike(g.mode, c->run.mode))
        return;
    for (; to->rows % EX_LANE; to->rows++) {
        for (int j = 0; j < EX_L; j++)
            to->row[j][to->rows] = 0.0;
        to->least[to->rows] = -1.0;
    }
    memcpy(to->before, before, EX_K * sizeof *before);
    memcpy(to->touched, c->run.at.touched, EX_K * sizeof *to->touched);
    memcpy(to->after, c->run.mode, EX_K * sizeof *to->after);
    to->used = ++c->chosen;
    c->decided += c->decided < EX_CHOICES;
}

int ex_choose(void *context, const bg_sight *sight)
{
    ex_context *const c = context;
    int before[BG_MOST_PORTS];
    double s[EX_N];
    if (c->glancing && is_made(c)) {
        c->vain = 0;
        return BG_OK;
    }
    memcpy(before, c->run.mode, sizeof before);
    memcpy(s, c->s, sizeof s);
    const int status = bg_choose(sight, &c->run.at, c->run.mode);
    if (status || !c->glancing || memcmp(s, c->s, sizeof s) != 0)
        return status;
    /* What is never made again is looked at more and more rarely. */
    if (c->looked++ % (c->vain + 1) == 0) {
        c->vain = c->vain < EX_VAIN ? 2 * c->vain + 1 : c->vain;
        keep(c, before);
    }
    return status;
}
