/* What keeps the switches of a generated model, what counts as none of that, and their impulses. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "port_sight.h"

enum { GUARDS = BG_ROOM(BG_GUARDS) };

void bg_view_keep(const bg_view *v, const int *mode, bg_port *ports)
{
    double guards[GUARDS] = {0};
    bg_guards(&v->model->now, guards);
    for (int i = 0; i < K; i++)
        if (bg_switches[i].kind != BG_RUBS)
            ports[i].stay =
                bg_stay(bg_switches + i, mode[i], ports[i].slip, ports[i].effort, guards);
}

/* Of efforts that hold: the rounding of the equations that they follow from. */
static void round_held(const bg_view *v, const int *mode, const double *x, const double *u,
                       bg_port *ports)
{
    bg_hold *held = NULL;
    int any = 0;
    for (int i = 0; i < K; i++)
        any |= mode[i] == 0;
    if (!any || bg_hold_of(v->model, mode, &held) != BG_OK)
        return;
    const int ruled = held->count - held->share_count;
    double terms[PORTS] = {0};
    for (int r = 0; r < ruled; r++) {
        for (int j = 0; j < N; j++)
            terms[r] += fabs(held->X[r * N + j]) * x[j];
        for (int j = 0; j < M; j++)
            terms[r] += fabs(held->U[r * M + j]) * u[j]
                + fabs(held->V[r * M + j]) * fabs(v->shot.du[j]);
    }
    for (int c = 0; c < held->count; c++) {
        double sum = 0.0;
        for (int r = 0; r < ruled; r++)
            sum += fabs(held->inverse[c * held->count + r]) * terms[r];
        bg_port *const port = ports + held->ports[c];
        port->near_effort = fmax(port->near_effort, BG_ROUNDING * sum);
    }
}

void bg_view_stay(bg_view *v, const int *mode, double time, const double *x, const double *u,
                  bg_port *ports)
{
    double terms[GUARDS] = {0}, slopes[GUARDS] = {0};
    const double spacing = nextafter(fabs(v->t), INFINITY) - fabs(v->t);
    bg_view_keep(v, mode, ports);
    round_held(v, mode, x, u, ports);
    if (BG_GUARDS)
        bg_guard_terms(v->model, &v->shot, time, terms, slopes);
    for (int i = 0; i < K; i++) {
        const bg_switch *const s = bg_switches + i;
        const int at = s->guard + (s->on == (mode[i] == 0));
        if (s->kind == BG_TOLD)
            ports[i].near_stay =
                BG_ROUNDING * terms[at] + BG_LATE * spacing * slopes[at] + DBL_MIN;
        else
            ports[i].near_stay = mode[i] ? ports[i].near_slip : ports[i].near_effort;
    }
}

/* What conditions gain by impulses, per unit of the largest: as values so much larger than others. */
static void push_guards(bg_model *m, const double *given, const double *received, double *pushed)
{
    bg_values *const now = &m->now;
    double before[GUARDS] = {0}, after[GUARDS] = {0}, size = 0.0, most = 0.0;
    double u[BG_ROOM(M)], y[BG_ROOM(ROWS)];
    memcpy(u, now->u, sizeof u);
    memcpy(y, now->y, sizeof y);
    size = fmax(bg_largest(K, given), bg_largest(ROWS, received));
    most = 1.0 + bg_largest(ROWS, y);
    const double far = ldexp(most, 40) / size;
    bg_guards(now, before);
    for (int k = 0; k < K; k++)
        now->u[bg_friction_inputs[k]] += far * given[k];
    for (int i = 0; i < ROWS; i++)
        now->y[i] += far * received[i];
    bg_guards(now, after);
    memcpy(now->u, u, sizeof u);
    memcpy(now->y, y, sizeof y);
    for (int g = 0; g < BG_GUARDS; g++)
        pushed[g] = (after[g] - before[g]) / ldexp(most, 40);
}

static int sign_of(double way, double least)
{
    return fabs(way) <= least ? 0 : way > 0 ? 1 : -1;
}

int bg_view_strike(void *view, const bg_instant *at, const int *mode, double *s, int *shocks,
                   int *struck)
{
    bg_view *const v = view;
    double given[PORTS] = {0}, received[BG_ROOM(ROWS)] = {0}, near[PORTS] = {0};
    double pushed[GUARDS] = {0};
    bg_port ports[PORTS];
    int loose[BG_MOST_PORTS];
    *struck = 0;
    for (int i = 0; i < K; i++)
        loose[i] = 1;
    const bg_sight sight = bg_view_sight(v);
    int status = bg_evaluated(&sight, at, 1, loose);
    if (status)
        return status;
    bg_view_ports(v, loose, at->time, ports);
    for (int i = 0; i < K; i++)
        near[i] = ports[i].near_slip;
    status = bg_strike(v->model, mode, &v->shot, near, s, given, received, struck);
    if (status || !*struck)
        return status;
    if (BG_GUARDS)
        push_guards(v->model, given, received, pushed);
    for (int i = 0; i < K; i++) {
        const bg_switch *const w = bg_switches + i;
        double least = BG_ROUNDING * bg_largest(K, given), terms = 0.0;
        for (int k = 0; k < K; k++)
            terms += fabs(v->model->numbers.D[bg_friction_readings[i] * M + bg_friction_inputs[k]]
                          * given[k]);
        if (w->kind == BG_TOLD)
            shocks[i] = sign_of(-pushed[w->guard + (w->on == (mode[i] == 0))], BG_ROUNDING);
        else if (w->kind == BG_ONE_SIDED && mode[i])
            shocks[i] = sign_of(w->side * received[bg_friction_readings[i]], BG_ROUNDING * terms);
        else if (w->kind == BG_ONE_SIDED)
            shocks[i] = sign_of(-w->side * given[i], least);
    }
    return BG_OK;
}
