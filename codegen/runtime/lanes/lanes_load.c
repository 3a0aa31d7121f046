/* From a run to its lane and back. */
#include <string.h>

#include "lanes.h"

/* How holding efforts follow from states, inputs and their rates: X x + U u + V u' = 0 solved. */
static void load_held(bg_lanes_own *own, int lane, const bg_hold *held)
{
    for (int r = 0; r < held->count; r++)
        for (int q = 0; q < held->count; q++) {
            bg_lane *const to = own->held + held->ports[r] * LANE_WIDE;
            const double part = -held->inverse[r * held->count + q];
            for (int j = 0; j < N; j++)
                to[j][lane] += part * held->X[q * N + j];
            for (int j = 0; j < M; j++)
                to[N + j][lane] += part * held->U[q * M + j];
            for (int j = 0; j < BG_OUTSIDE; j++)
                to[N + M + j][lane] += part * held->V[q * M + bg_outside_inputs[j]];
        }
}

/* Ports that hold may share a load, or inputs may rule whether they do: these runs go alone. */
int bg_lanes_load_mode(bg_lanes_own *own, int lane, const bg_located *c)
{
    bg_hold *held = NULL;
    int sticking = 0;
    for (int i = 0; i < K; i++) {
        own->signs[i][lane] = c->run.mode[i];
        sticking |= c->run.mode[i] == 0;
    }
    for (int i = 0; i < BG_CORNERS; i++)
        own->sides[i][lane] = c->model->now.side[i];
    for (int i = 0; i < K * LANE_WIDE; i++)
        own->held[i][lane] = 0.0;
    if (!sticking)
        return 1;
    if (bg_hold_of(c->model, c->run.mode, &held) != BG_OK || held->share_count || held->ruled)
        return 0;
    load_held(own, lane, held);
    return 1;
}

int bg_lanes_load(bg_lanes *a, int lane)
{
    bg_lane_run *const one = a->lane + lane;
    bg_located *const c = one->room->run;
    if (c->stretch.method != BG_DOP853 || !bg_lanes_load_mode(&a->own, lane, c))
        return 0;
    if (BG_CORNERS && !(c->model->now.sided > 0.0))
        return 0; /* over corners that it does not get past */
    for (int k = 0; k < BG_SIZE; k++) {
        a->y[k][lane] = c->solver.y[k];
        a->f[k][lane] = c->solver.f[k];
    }
    one->reach = -1.0;
    one->tries = 0;
    c->turns.patience = BG_PATIENCE * BG_LANES; /* an explicit step costs so much less */
    return bg_lanes_follow(a, lane, c->solver.t);
}

int bg_lanes_follow(bg_lanes *a, int lane, double end)
{
    bg_lane_run *const one = a->lane + lane;
    bg_located *const c = one->room->run;
    const double t = c->solver.t;
    double series[BG_ROOM(BG_EXTERNAL)][LANE_SERIES];
    if (fmax(fabs(t - a->origin[lane]), fabs(end - a->origin[lane])) <= one->reach)
        return 1;
    const double fastest = bg_signals_fastest(c->signals, &c->run.span);
    one->reach = fastest > 0.0 ? LANE_REACH / fastest : INFINITY;
    a->origin[lane] = fastest > 0.0 ? t + one->reach : t;
    const int terms = bg_lanes_series(c->signals, &c->run.span, a->origin[lane], series);
    a->terms = terms > a->terms ? terms : a->terms;
    for (int i = 0; i < BG_EXTERNAL; i++)
        for (int k = 0; k < LANE_SERIES; k++)
            a->series[i][k][lane] = series[i][k];
    return terms > 0;
}

void bg_lanes_unload(const bg_lanes *a, int lane)
{
    bg_solver *const s = &a->lane[lane].room->run->solver;
    for (int k = 0; k < BG_SIZE; k++) {
        s->y_old[k] = a->y_old[k][lane];
        s->y[k] = a->y[k][lane];
        s->f_old[k] = a->stage[0][k][lane];
        s->f[k] = a->stage[LANE_LAST][k][lane];
        for (int i = 0; i < BG_EXPLICIT_STAGES; i++)
            s->stage[i][k] = a->stage[i][k][lane];
        for (int i = 0; i < 7; i++)
            s->interpolation[i][k] = a->interpolation[i][k][lane];
    }
    s->dense = 1;
}
