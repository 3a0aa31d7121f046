/* Exponential steps of all lanes: judged two at a time, with samples, and what follows. */
#include <math.h>
#include <string.h>

#include "lanes_steps.h"

enum {
    AT_LEAST = 4, /* pairs between slopes that are renewed while steps are good */
    A_WHILE = 64, /* pairs after which steps that are finer than need be begin anew */
    FINEST = 8
};
static const double LARGE = 0.1; /* an error from which on the slope is renewed */

void bg_lanes_too_coarse(bg_lane_run *one)
{
    one->waits = one->patience;
    if (one->patience < LANE_NEVER / 2)
        one->patience *= 2;
}

/* The weights of a lane's slope. */
static void glide_put_weights(bg_lanes_exponential *g, int lane, const double *slope,
                        const bg_lane_weights *weights)
{
    for (int k = 0; k < BG_SIZE * BG_SIZE; k++) {
        const int i = k / BG_SIZE, j = k % BG_SIZE;
        g->slope[i][j][lane] = slope[k];
        g->E[i][j][lane] = weights->E[k];
        g->correction[i][j][lane] = weights->correction[k];
        for (int p = 0; p < LANE_PAST; p++)
            g->weight[p][i][j][lane] = weights->weight[p][k];
    }
    g->since[lane] = 0;
}

/* The slope and the weights where a lane is; whether there are any. */
static int glide_renew(bg_lanes *a, int lane)
{
    bg_lanes_exponential *const g = &a->exponential;
    bg_located *const c = g->of.run[lane]->room->run;
    double y[BG_SIZE], slope[BG_SIZE * BG_SIZE];
    bg_lane_functions functions;
    bg_lane_weights weights;
    for (int k = 0; k < BG_SIZE; k++)
        y[k] = g->y[0][k][lane];
    if (bg_located_jacobian(c, c->run.at.t, y, slope) != BG_OK
        || !bg_lanes_functions(slope, g->gap / (double)g->parts[lane], &functions))
        return 0;
    bg_lanes_weigh(&functions, &weights);
    for (int p = 0; p < LANE_PAST; p++)
        for (int k = 0; k < BG_SIZE * BG_SIZE; k++)
            g->rest[p][k / BG_SIZE][lane] +=
                (g->slope[k / BG_SIZE][k % BG_SIZE][lane] - slope[k]) * g->y[p][k % BG_SIZE][lane];
    glide_put_weights(g, lane, slope, &weights);
    return 1;
}

int bg_lanes_glide_in(bg_lanes *a, int lane, bg_lane_run *one)
{
    bg_lanes_exponential *const g = &a->exponential;
    bg_located *const c = one->room->run;
    const bg_lane_start *const start = &a->start;
    bg_lanes_load(&g->of, lane, one);
    glide_put_weights(g, lane, start->slope, &start->weights);
    for (int p = 0; p < LANE_PAST; p++)
        for (int k = 0; k < BG_SIZE; k++) {
            g->y[p][k][lane] = start->y[p][k];
            g->rest[p][k][lane] = start->rest[p][k];
        }
    for (int k = 0; k < BG_SIZE; k++)
        g->seen[k][lane] = fabs(start->y[0][k]);
    for (int i = 0; i < LANE_ROWS; i++)
        g->shot[LANE_PAIR][i][lane] = start->shot[i];
    for (int i = 0; i < BG_EXTERNAL; i++)
        g->w[LANE_PAIR][i][lane] = a->points.at.w[i][LANE_PAST];
    g->place[lane] = start->place;
    g->parts[lane] = start->parts;
    g->pairs[lane] = 0;
    c->run.at.t = c->solver.t = bg_lanes_time(a, start->place, start->parts);
    return bg_lanes_follow(&g->of, lane, c->solver.t);
}

/* Its run leaves a lane, to explicit steps from where it is. */
static bg_lane_run *glide_out(bg_lanes_exponential *g, int lane)
{
    bg_lane_run *const one = g->of.run[lane];
    bg_located *const c = one->room->run;
    bg_solver *const s = &c->solver;
    double seen[BG_SIZE];
    for (int k = 0; k < BG_SIZE; k++) {
        s->y[k] = g->y[0][k][lane];
        s->f[k] = g->shot[LANE_PAIR][BG_AT_rate + k][lane];
        seen[k] = g->seen[k][lane];
    }
    s->t_old = s->t;
    s->next = s->longest;
    s->begun = s->doubts = s->dense = 0;
    bg_have_seen(c->model, seen);
    bg_located_reach(c, s->t, s->y);
    one->seated = 0;
    one->tries = 0;
    one->by = LANE_EXPLICIT;
    g->of.run[lane] = NULL;
    return one;
}

/* To before a lane's latest pair. */
static void glide_go_back(bg_lanes_exponential *g, int lane)
{
    for (int p = 0; p < LANE_PAST; p++)
        for (int k = 0; k < BG_SIZE; k++) {
            g->y[p][k][lane] = g->y[p + LANE_PAIR][k][lane];
            g->rest[p][k][lane] = g->rest[p + LANE_PAIR][k][lane];
        }
    for (int i = 0; i < LANE_ROWS; i++)
        g->shot[LANE_PAIR][i][lane] = g->shot[0][i][lane];
    for (int i = 0; i < BG_EXTERNAL; i++)
        g->w[LANE_PAIR][i][lane] = g->w[0][i][lane];
}

/* Where a lane is after its pair, and the samples before. A status. */
static int glide_accept(bg_lanes *a, int lane)
{
    bg_lanes_exponential *const g = &a->exponential;
    bg_lane_run *const one = g->of.run[lane];
    bg_located *const c = one->room->run;
    int status = BG_OK;
    for (int n = 0; n < LANE_PAIR && status == BG_OK; n++)
        if ((g->place[lane] + n) % g->parts[lane] == 0)
            status = bg_lanes_keep(one, lane, (const bg_lane *)g->y[LANE_PAIR - n],
                                   (const bg_lane *)g->w[n], (const bg_lane *)g->shot[n]);
    g->place[lane] += LANE_PAIR;
    g->since[lane]++;
    c->run.at.t = c->solver.t = g->time[0][lane];
    return status == BG_OK && c->asked->passed ? c->asked->passed(c->asked->to, c) : status;
}

/* A run leaves a lane until it has taken so many explicit steps. */
static void glide_wait(bg_lanes_exponential *g, int lane, long steps)
{
    glide_out(g, lane)->waits = steps;
}

/* The four instants at the end of a lane's window. */
static void glide_around(const bg_lanes *a, int lane, bg_lanes_known *known)
{
    const bg_lanes_exponential *const g = &a->exponential;
    for (int j = 0; j < LANE_AROUND; j++) {
        const int n = LANE_AROUND - 1 - j;
        known->t[j] = bg_lanes_time(a, g->place[lane] + LANE_PAIR - n, g->parts[lane]);
        for (int k = 0; k < BG_SIZE; k++) {
            known->y[j][k] = g->y[n][k][lane];
            known->rate[j][k] = g->rest[n][k][lane];
            for (int l = 0; l < BG_SIZE; l++)
                known->rate[j][k] += g->slope[k][l][lane] * g->y[n][l][lane];
        }
    }
}

/* Whether nothing can happen in a lane's pair, whose end is noted then. */
static int glide_is_clear(bg_lanes *a, int lane)
{
    static const double places[LANE_AROUND] = {-1.0, 0.0, 1.0, 2.0};
    bg_lanes_exponential *const g = &a->exponential;
    bg_lane_run *const one = g->of.run[lane];
    double v[LANE_AROUND][LANE_WATCHED];
    bg_lanes_known known;
    memcpy(v, one->was, sizeof one->was);
    for (int n = 1; n <= LANE_PAIR; n++)
        bg_lanes_watched(one, &g->of.own, lane, (const bg_lane *)g->shot[n], v[n + 1]);
    if (!bg_lanes_is_clear(LANE_AROUND, places, (const double(*)[LANE_WATCHED])v)) {
        glide_around(a, lane, &known);
        if (!bg_lanes_is_clear_closely(one, &known, 1, (const double(*)[LANE_WATCHED])(v + 1)))
            return 0;
    }
    memcpy(one->was, v + LANE_AROUND - 2, sizeof one->was);
    bg_lanes_note(one, v[LANE_AROUND - 1]);
    return 1;
}

/* Whether a lane's steps have been short for a while, and may be twice as long now. */
static int glide_is_too_fine(bg_lanes *a, int lane)
{
    bg_lanes_exponential *const g = &a->exponential;
    bg_lane_run *const one = g->of.run[lane];
    bg_located *const c = one->room->run;
    double y[BG_SIZE], fastest;
    if (g->parts[lane] < 2 || ++g->pairs[lane] < A_WHILE)
        return 0;
    g->pairs[lane] = 0;
    for (int k = 0; k < BG_SIZE; k++)
        y[k] = g->y[0][k][lane];
    if (bg_located_fastest(c, c->run.at.t, y, &fastest) != BG_OK)
        return 0;
    c->stretch.fastest = fastest;
    one->finer -= one->finer / 2;
    return 2 * bg_lanes_parts(a, one) <= g->parts[lane];
}

/* What a lane's pair was. */
static void glide_judge(bg_lanes *a, int lane)
{
    bg_lanes_exponential *const g = &a->exponential;
    bg_lane_run *const one = g->of.run[lane];
    const double error = sqrt(fmax(g->error[0][lane], g->error[1][lane]) / BG_SIZE);
    if (!(error < 1.0)) {
        const int fresh = !g->since[lane];
        glide_go_back(g, lane);
        if (fresh || !glide_renew(a, lane)) {
            one->finer *= one->finer < FINEST ? 2 : 1;
            bg_lanes_too_coarse(glide_out(g, lane));
        }
        return;
    }
    if (!glide_is_clear(a, lane)) {
        one->after = g->time[0][lane];
        glide_go_back(g, lane);
        glide_wait(g, lane, 0);
        return;
    }
    const int status = glide_accept(a, lane);
    if (status != BG_OK) {
        bg_lanes_leave(glide_out(g, lane), status);
        return;
    }
    if (g->time[0][lane] >= one->room->run->stretch.stop) {
        bg_lanes_take_on(glide_out(g, lane), 0, BG_OK);
        return;
    }
    if (error > LARGE && g->since[lane] >= AT_LEAST && !glide_renew(a, lane))
        bg_lanes_too_coarse(glide_out(g, lane));
    else if (!(bg_lanes_time(a, g->place[lane] + LANE_PAIR, g->parts[lane])
               <= one->room->run->stretch.stop))
        glide_wait(g, lane, LANE_NEVER);
    else if (glide_is_too_fine(a, lane))
        glide_out(g, lane)->by = LANE_EXPONENTIAL;
}

/* When the steps of lanes end; whose inputs have no series goes on by itself. */
static void glide_set_times(bg_lanes *a)
{
    bg_lanes_exponential *const g = &a->exponential;
    for (int l = 0; l < BG_LANES; l++) {
        if (!g->of.run[l])
            continue;
        for (int n = 0; n < LANE_PAIR; n++)
            g->time[n][l] = bg_lanes_time(a, g->place[l] + LANE_PAIR - n, g->parts[l]);
        if (!bg_lanes_follow(&g->of, l, g->time[0][l]))
            bg_lanes_leave(glide_out(g, l), BG_STEPS);
    }
}

void bg_lanes_glide(bg_lanes *a)
{
    glide_set_times(a);
    bg_lanes_pair(&a->exponential);
    for (int l = 0; l < BG_LANES; l++)
        if (a->exponential.of.run[l])
            glide_judge(a, l);
}
