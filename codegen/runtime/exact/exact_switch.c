/* Ideal switches of affine modes: what keeps them, and the impulses with which they come to hold. */
#include "exact_internal.h"

#include <float.h>
#include <math.h>
#include <string.h>

int ex_switches(const ex_context *c, int port)
{
    return c->model->switched && c->model->switches[port].kind != BG_RUBS;
}

void ex_keep(const ex_context *c, const ex_mode *mode, const double *v, bg_port *ports)
{
    for (int i = 0; i < EX_K; i++) {
        if (!ex_switches(c, i))
            continue;
        ports[i].stay = 0.0;
        for (int j = 0; j < EX_L; j++)
            ports[i].stay += mode->stay[j][i] * v[j];
    }
    ex_gaps(c, v, ports);
}

/* How large what maps act on has been; at rest a state is rounding itself, of what moves it within a
 * time constant. */
static void sizes_of(const ex_context *c, const ex_mode *mode, const double *v, double t,
                     double *size)
{
    ex_input_sizes(c->inputs, c->run.span.segment, t, size + EX_N);
    for (int j = EX_N + EX_W; j < EX_L; j++)
        size[j] = fabs(v[j]);
    for (int i = 0; i < EX_N; i++) {
        double moved = 0.0;
        for (int j = 0; j < EX_L; j++)
            moved += fabs(mode->shot[j][EX_AT_RATE + i] * v[j]);
        size[i] = bg_greater(fabs(v[i]), c->run.at.time * moved);
        if (i < EX_X)
            size[i] = bg_greater(size[i], c->peaks.x[i]);
    }
}

/* By how much what keeps a switch may be off: of its terms, and as an event's time may be. What time
 * alone rules has been through no integration: its terms round as numbers do. */
static double near_of(const ex_mode *mode, int port, double terms, double slope, double t)
{
    const double spacing = nextafter(fabs(t), INFINITY) - fabs(t);
    int moved = 0;
    for (int j = 0; j < EX_N; j++)
        moved |= mode->stay[j][port] != 0.0;
    return (moved ? BG_ROUNDING : BG_TIMED) * terms + BG_LATE * spacing * fabs(slope) + DBL_MIN;
}

void ex_round_stay(const ex_context *c, const ex_mode *mode, const double *v, const double *shot,
                   double t, bg_port *ports)
{
    double size[EX_L];
    if (!c->model->switched)
        return;
    sizes_of(c, mode, v, t, size);
    ex_keep(c, mode, v, ports);
    for (int i = 0; i < EX_K; i++) {
        double terms = 0.0, slope = 0.0;
        for (int j = 0; j < EX_L; j++)
            terms += fabs(mode->stay[j][i]) * size[j];
        for (int j = 0; j < EX_N; j++)
            slope += mode->stay[j][i] * shot[EX_AT_RATE + j];
        for (int j = 0; j < EX_W; j++)
            slope += mode->stay[EX_N + j][i] * v[EX_N + EX_W + j];
        ports[i].near_stay = near_of(mode, i, terms, slope, t);
    }
    ex_round_gaps(c, v, shot + EX_AT_RATE, t, ports);
}

void ex_limit_stay(const ex_context *c, const ex_mode *mode, const double *most, const double *shot,
                   double t, bg_port *ports)
{
    double size[EX_L];
    sizes_of(c, mode, most, t, size);
    for (int i = 0; i < EX_K; i++) {
        double terms = 0.0, slope = 0.0;
        for (int j = 0; j < EX_L; j++) {
            const double moved = j < EX_N ? c->run.at.time * shot[EX_AT_RATE + j] : 0.0;
            terms += fabs(mode->stay[j][i]) * bg_greater(bg_greater(size[j], most[j]), moved);
        }
        for (int j = 0; j < EX_N; j++)
            slope += fabs(mode->stay[j][i]) * shot[EX_AT_RATE + j];
        for (int j = 0; j < EX_W; j++)
            slope += fabs(mode->stay[EX_N + j][i]) * most[EX_N + EX_W + j];
        ports[i].near_stay = near_of(mode, i, terms, slope, t) * (1.0 + BG_BOUND_SLACK);
    }
}

/* The mode whose friction slips forwards, with switches as they are or all let go. */
static int find_way(ex_context *c, const int *mode, int loose, const ex_mode **found)
{
    int other[BG_MOST_PORTS] = {0};
    for (int i = 0; i < EX_K; i++)
        other[i] = loose || !ex_switches(c, i) ? 1 : mode[i];
    const int status = ex_find(c, other, found);
    return status == BG_NOT_AFFINE && (*found)->none ? BG_NO_HOLD : status;
}

/* Whether the slips that a mode would stop are more than rounding: `real` without those that are none;
 * *status of a look where all is let go. */
static int would_jump(ex_context *c, const bg_instant *at, const int *mode, const ex_mode *holding,
                      const double *slips, double *real, int *status)
{
    const ex_mode *loose;
    bg_port ports[EX_PORTS];
    int any = 0;
    *status = find_way(c, mode, 1, &loose);
    if (*status == BG_OK)
        *status = ex_look(c, at->t, at->s, loose, c->shot);
    if (*status)
        return 0;
    ex_round(c, c->shot, at->t, ports);
    for (int k = 0; k < holding->held; k++) {
        double near = 0.0;
        for (int i = 0; i < EX_K; i++)
            near += fabs(holding->mix[k][i]) * ports[i].near_slip;
        real[k] = fabs(slips[k]) > BG_WIDE * near ? slips[k] : 0.0;
        any |= real[k] != 0.0;
    }
    return any;
}

/* The slips that are to be stopped: what ports have beyond the speeds that they are to have. */
static void slips_beyond(const ex_mode *holding, const double *v, const double *speeds, double *slips)
{
    for (int k = 0; k < holding->held; k++) {
        slips[k] = 0.0;
        for (int j = 0; j < EX_L; j++)
            slips[k] += holding->left[j][k] * v[j];
        for (int i = 0; i < EX_K && speeds; i++)
            slips[k] -= holding->mix[k][i] * speeds[i];
    }
}

/* Below what slips are rounding after ports have given these impulses: of their terms with all let
 * go, and of what states gain. */
static int round_struck(ex_context *c, const bg_instant *at, const int *mode, bg_blow *blow)
{
    const ex_model *const a = c->model;
    const ex_mode *loose;
    int status = find_way(c, mode, 1, &loose);
    if (status == BG_OK)
        status = ex_look(c, at->t, at->s, loose, c->shot);
    if (status)
        return status;
    memset(blow->near, 0, sizeof blow->near);
    for (int j = 0; j < EX_X; j++) {
        double size = bg_greater(fabs(c->shot[EX_AT_X + j]), c->peaks.x[j]);
        for (int k = 0; k < EX_K; k++)
            size += a->Q[a->own[k]][j] * fabs(blow->given[k]);
        for (int i = 0; i < EX_K; i++)
            blow->near[i] += BG_ROUNDING * a->F[j][i] * size;
    }
    for (int j = 0; j < EX_U; j++)
        for (int i = 0; i < EX_K; i++)
            blow->near[i] += BG_ROUNDING * a->D[j][i] * fabs(c->shot[EX_AT_U + j]);
    return BG_OK;
}

int ex_strike(void *context, const bg_instant *at, const int *mode, const double *speeds,
              double *s, bg_blow *blow)
{
    ex_context *const c = context;
    const ex_mode *holding;
    double v[EX_L], slips[EX_PORTS] = {0}, real[EX_PORTS] = {0};
    blow->struck = 0;
    int status = find_way(c, mode, 0, &holding);
    if (status)
        return status;
    ex_vector(c, at->t, at->s, v);
    slips_beyond(holding, v, speeds, slips);
    if (holding->held == 0 || (!speeds && !would_jump(c, at, mode, holding, slips, real, &status)))
        return status;
    if (speeds)
        memcpy(real, slips, sizeof real);
    blow->struck = 1;
    for (int i = 0; i < EX_K; i++) {
        double way = 0.0, terms = 0.0;
        blow->given[i] = 0.0;
        for (int k = 0; k < holding->held; k++) {
            blow->given[i] += holding->blow[k][i] * slips[k];
            way += holding->shock[k][i] * real[k];
            terms += fabs(holding->shock[k][i] * real[k]);
        }
        blow->shocks[i] = fabs(way) <= BG_ROUNDING * terms ? 0 : way > 0.0 ? 1 : -1;
    }
    for (int k = 0; k < holding->held; k++)
        for (int i = 0; i < EX_N; i++)
            s[i] += holding->jump[k][i] * slips[k];
    return speeds ? round_struck(c, at, mode, blow) : BG_OK;
}

int ex_become(void *context, const bg_instant *at, const int *mode, double *values)
{
    ex_context *const c = context;
    const ex_mode *here;
    double v[EX_L];
    const int status = ex_find(c, mode, &here);
    if (status)
        return status;
    ex_vector(c, at->t, at->s, v);
    for (int r = 0; r < BG_RESETS; r++) {
        values[r] = 0.0;
        for (int j = 0; j < EX_L; j++)
            values[r] += here->become[j][r] * v[j];
    }
    return BG_OK;
}
