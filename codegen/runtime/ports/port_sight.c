/* A generated model as a choice of mode sees it: its ports, and what counts as zero of them. */
#include <stddef.h>
#include <string.h>

#include "port_sight.h"

int bg_view_look(void *view, double t, const double *s, const int *mode)
{
    bg_view *const v = view;
    double w[BG_ROOM(BG_EXTERNAL)], dw[BG_ROOM(BG_EXTERNAL)];
    const int checked = v->given(v->self, t, w, dw);
    v->t = t;
    return bg_evaluate(v->model, t, s, w, dw, mode, checked, &v->shot);
}

void bg_measure(const bg_numbers *a, const bg_magnitudes *to)
{
    for (int i = 0; i < N; i++) {
        for (int j = 0; j < N; j++)
            to->P[j * N + i] = fabs(a->P[i * N + j]);
        for (int j = 0; j < M; j++)
            to->Q[j * N + i] = fabs(a->Q[i * M + j]);
    }
    for (int k = 0; k < K; k++) {
        const double *const F = a->F + bg_friction_readings[k] * N;
        const double *const D = a->D + bg_friction_readings[k] * M;
        const int own = bg_friction_inputs[k];
        for (int j = 0; j < N; j++) {
            double moved = 0.0;
            for (int l = 0; l < N; l++)
                moved += F[l] * a->P[l * N + j];
            to->F[j * K + k] = fabs(F[j]);
            to->FP[j * K + k] = fabs(moved);
        }
        for (int j = 0; j < M; j++) {
            double moved = 0.0;
            for (int l = 0; l < N; l++)
                moved += F[l] * a->Q[l * M + j];
            to->D[j * K + k] = fabs(D[j]);
            to->FQ[j * K + k] = fabs(moved);
        }
        to->inertia[k] = to->FQ[own * K + k] + to->D[own * K + k];
    }
}

/* The ports of the latest look, without what counts as zero. */
static void show_ports(const bg_view *v, bg_port *ports)
{
    const bg_snapshot *const now = &v->shot;
    double terms;
    for (int i = 0; i < K; i++)
        ports[i] = (bg_port){
            .slip = now->y[bg_friction_readings[i]], .effort = now->u[bg_friction_inputs[i]],
            .cap = now->caps[i], .push = bg_slip_rate(v->model, now, i, &terms),
        };
}

void bg_view_ports(bg_view *v, const int *mode, double time, bg_port *ports)
{
    const bg_magnitudes sizes = {v->F, v->D, v->FP, v->FQ, v->P, v->Q, v->inertia};
    double x[BG_ROOM(N)], u[BG_ROOM(M)], rate[BG_ROOM(N)];
    if (BG_VARYING || !v->measured)
        bg_measure(&v->model->numbers, &sizes);
    v->measured = 1;
    for (int i = 0; i < N; i++)
        x[i] = fmax(fabs(v->shot.x[i]), v->peaks->x[i]);
    for (int j = 0; j < M; j++)
        u[j] = fmax(fabs(v->shot.u[j]), v->peaks->u[j]);
    show_ports(v, ports);
    bg_round_ports(N, M, K, &sizes, v->t, time, x, u, rate, ports);
    if (BG_SWITCHES || BG_HUNG)
        bg_view_stay(v, mode, time, x, u, ports);
}

/* What only other inputs rule of slips that stick, of a mode that has been evaluated. */
static void rule(bg_model *m, const int *mode, bg_ruling *ruling)
{
    int sticking = 0;
    bg_hold *held = NULL;
    for (int i = 0; i < K; i++)
        sticking |= mode[i] == 0;
    if (!sticking || bg_hold_of(m, mode, &held) != BG_OK)
        return;
    *ruling = (bg_ruling){.width = held->count, .count = held->ruled, .kept = held->kept,
                          .ports = held->ports, .rows = held->share, .mix = held->mix};
}

static void tell_ports(void *view, const int *mode, const bg_instant *at, bg_port *ports,
                 bg_ruling *ruling)
{
    bg_view *const v = view;
    if (at)
        bg_view_ports(v, mode, at->time, ports);
    else {
        show_ports(v, ports);
        if (BG_SWITCHES || BG_HUNG)
            bg_view_keep(v, mode, ports);
    }
    if (ruling)
        rule(v->model, mode, ruling);
}

static int couple_ports(void *view, const int *mode, bg_set *touched)
{
    bg_view *const v = view;
    bg_hold *held = NULL;
    const int status = BG_JOINT ? BG_NO_SOLUTION : bg_hold_of(v->model, mode, &held);
    if (status != BG_OK)
        return status;
    for (int c = 0; c < held->count; c++)
        for (int d = 0; d < held->count; d++) {
            const int i = held->ports[c], j = held->ports[d];
            const int at = bg_friction_inputs[j] * K + i;
            int joined = v->FQ[at] != 0.0 || v->D[at] != 0.0;
            for (int r = 0; r < held->share_count; r++)
                joined |= held->share[r * held->count + c] != 0.0
                    && held->share[r * held->count + d] != 0.0;
            if (joined)
                bg_add(touched + i, j);
        }
    return BG_OK;
}

/* What inputs that drive dependent storages add to states stays. */
static int become(void *view, const bg_instant *at, const int *mode, double *values)
{
    bg_view *const v = view;
    double guards[BG_ROOM(BG_GUARDS)];
    const int status = bg_view_look(view, at->t, at->s, mode);
    if (status)
        return status;
    bg_guards(&v->model->now, guards);
    for (int r = 0; r < BG_RESETS; r++) {
        const int place = bg_resets[r].place;
        const double state = place < N ? v->shot.x[place] : at->s[place];
        values[r] = guards[bg_resets[r].value] + (at->s[place] - state);
    }
    return BG_OK;
}

bg_sight bg_view_sight(bg_view *v)
{
    return (bg_sight){v, BG_SIZE, K, BG_SWITCHES ? bg_switches : NULL, bg_switches, BG_STOPPING,
                      bg_beside, v->shot.rate, v->point, v->struck, bg_view_look, tell_ports,
                      bg_view_strike, couple_ports, BG_RESETS, bg_resets, become, bg_clocks};
}

/* A term is the effect of a small relative change of a state. */
void bg_view_see(bg_view *v, const double *s, const int *slipping)
{
    const bg_snapshot seen = v->shot;
    double moved[BG_SIZE], terms[BG_ROOM(M)];
    for (int i = 0; i < N; i++)
        v->peaks->x[i] = fmax(v->peaks->x[i], fabs(seen.x[i]));
    for (int i = 0; i < M; i++)
        terms[i] = fabs(seen.u[i]);
    memcpy(moved, s, sizeof moved);
    for (int j = 0; j < BG_SIZE; j++) {
        if (s[j] == 0.0)
            continue;
        moved[j] = s[j] * (1.0 + BG_TERM);
        const int known = bg_view_look(v, v->t, moved, slipping) == BG_OK;
        moved[j] = s[j];
        for (int i = 0; i < M && known; i++)
            terms[i] += fabs(v->shot.u[i] - seen.u[i]) / BG_TERM;
    }
    for (int i = 0; i < M; i++)
        v->peaks->u[i] = fmax(v->peaks->u[i], terms[i]);
    v->shot = seen;
}
