/* A first look at the ways of switches: which contradict one, if that is sure, and what has to be so. */
#include "exact_glance.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "port_ways.h"
#include "run_pace.h"

double ex_row(const double *row, const double *v)
{
    double sum = 0.0;
    for (int j = 0; j < EX_L; j++)
        sum += row[j] * v[j];
    return sum;
}

int ex_ask(ex_glance *g, const double *row, double sign, double least)
{
    ex_choice *const to = g->to;
    int varies = 0;
    if (!(sign * ex_row(row, g->v) > least))
        return 0;
    for (int j = 0; j < EX_L - 1; j++)
        varies |= row[j] != 0.0;
    if (!varies)
        return 1;
    if (to->rows == EX_ROWS)
        return 0;
    for (int j = 0; j < EX_L; j++)
        to->row[j][to->rows] = sign * row[j];
    to->least[to->rows++] = least;
    return 1;
}

void ex_limit(const ex_glance *g, const ex_mode *mode, const double *most, ex_limits *limits)
{
    ex_context *const c = g->c;
    double *const shot = limits->shot;
    memset(shot, 0, sizeof limits->shot);
    for (int j = 0; j < EX_L; j++)
        for (int i = 0; i < EX_SHOT; i++)
            shot[i] += fabs(mode->shot[j][i]) * most[j];
    for (int i = 0; i < EX_X; i++)
        shot[EX_AT_X + i] = bg_greater(shot[EX_AT_X + i], g->to->most_x[i]);
    for (int i = 0; i < EX_U; i++)
        shot[EX_AT_U + i] = bg_greater(shot[EX_AT_U + i], g->to->most_u[i]);
    ex_round(c, shot, g->to->until, limits->ports);
    ex_limit_stay(c, mode, most, shot, g->to->until, limits->ports);
}

/* What keeps a switch as a row; how fast that changes; how its change may bend at the most. */
typedef struct {
    double row[EX_L], slope[EX_L], bend;
} keeper;

/* Whether inputs' rates alone have no part in it: these change in a way that is not known. */
static int keeper_of(const ex_glance *g, const ex_mode *mode, double (*stay)[EX_PORTS], int port,
                     const ex_limits *limits, const double *most, keeper *to)
{
    const double pace = g->c->inputs->fastest[g->c->run.span.segment];
    const double *const rate = limits->shot + EX_AT_RATE;
    int known = 1;
    memset(to, 0, sizeof *to);
    for (int j = 0; j < EX_L; j++)
        to->row[j] = stay[j][port];
    for (int i = 0; i < EX_N; i++) {
        double second = 0.0;
        for (int j = 0; j < EX_L; j++)
            to->slope[j] += to->row[i] * mode->shot[j][EX_AT_RATE + i];
        for (int j = 0; j < EX_N; j++)
            second += fabs(mode->shot[j][EX_AT_RATE + i]) * rate[j];
        for (int j = 0; j < EX_W; j++)
            second += fabs(mode->shot[EX_N + j][EX_AT_RATE + i]) * most[EX_N + EX_W + j]
                + fabs(mode->shot[EX_N + EX_W + j][EX_AT_RATE + i]) * pace * most[EX_N + EX_W + j];
        to->bend += fabs(to->row[i]) * second;
    }
    for (int j = 0; j < EX_W; j++) {
        to->slope[EX_N + EX_W + j] += to->row[EX_N + j];
        to->bend += fabs(to->row[EX_N + j]) * pace * most[EX_N + EX_W + j];
        known &= to->row[EX_N + EX_W + j] == 0.0;
    }
    return known;
}

/* Which way a switch at a tie goes a moment later, if that is sure: 1 where it stays, -1 where not. */
static int late_way(ex_glance *g, const keeper *k, double near)
{
    const double ahead = BG_LOOK_AHEAD * g->to->time;
    const double way = ex_row(k->slope, g->v) > 0.0 ? 1.0 : -1.0;
    return ex_ask(g, k->slope, way, BG_SEEN * near / ahead + 2.0 * ahead * k->bend) ? (int)way : 0;
}

/* What counts as zero of what keeps a switch, at the least, while the choice is kept. */
static double least_near(const ex_glance *g, const double *row)
{
    const ex_context *const c = g->c;
    double sum = fabs(row[EX_L - 1]);
    for (int j = 0; j < EX_X && j < EX_N; j++)
        sum += fabs(row[j]) * c->peaks.x[j];
    for (int j = 0; j < EX_W; j++)
        sum += fabs(row[EX_N + j]) * g->to->low[j];
    return BG_ROUNDING * sum;
}

/* What contradicts a mode that can be evaluated, impulses taken into account; 0 where it is not sure. */
static int contradicted(ex_glance *g, const ex_mode *mode, double (*stay)[EX_PORTS],
                        const double *most, const int *shocks, bg_set *broken)
{
    ex_limits limits;
    keeper tied[EX_PORTS];
    int ties[EX_PORTS], count = 0, sure = 1;
    ex_limit(g, mode, most, &limits);
    for (int i = 0; i < EX_K && sure; i++) {
        keeper *const k = tied + count;
        if (bg_has(&g->barred, i))
            continue;
        const double near = limits.ports[i].near_stay;
        const int known = keeper_of(g, mode, stay, i, &limits, most, k);
        const double value = ex_row(k->row, g->v), way = value > 0.0 ? 1.0 : -1.0;
        if (shocks[i] ? shocks[i] < 0 : value < -near)
            bg_add(broken, i);
        if (!shocks[i] && fabs(value) > near)
            sure = ex_ask(g, k->row, way, near);
        else if (!shocks[i]) {
            sure = known && fabs(value) <= least_near(g, k->row);
            ties[count++] = i;
        }
    }
    const int decided = !bg_is_empty(broken);
    for (int k = 0; k < count && sure; k++) {
        const double near = limits.ports[ties[k]].near_stay, low = least_near(g, tied[k].row);
        const int way = decided ? 0 : late_way(g, tied + k, near);
        sure = decided || way;
        if (way <= 0)
            sure &= ex_ask(g, tied[k].row, -1.0, -low);
        if (way >= 0)
            sure &= ex_ask(g, tied[k].row, 1.0, -low);
        if (way < 0)
            bg_add(broken, ties[k]);
    }
    return sure;
}

/* Whether slips that only inputs rule are not zero in a mode without impulses, for sure: it is none. */
static int slides_for_sure(ex_glance *g, const ex_mode *mode)
{
    ex_limits limits;
    ex_limit(g, mode, g->to->most, &limits);
    for (int r = 0; r < mode->ruled; r++) {
        double row[EX_L] = {0}, near = 0.0;
        for (int i = 0; i < EX_K; i++) {
            near += fabs(mode->ruling[r][i]) * limits.ports[i].near_slip;
            for (int j = 0; j < EX_L; j++)
                row[j] += mode->ruling[r][i] * mode->shot[j][EX_AT_SLIP + i];
        }
        if (ex_ask(g, row, ex_row(row, g->v) > 0.0 ? 1.0 : -1.0, near))
            return 1;
    }
    return 0;
}

int ex_glance_at(void *self, const bg_set *held, int *holds, bg_set *broken)
{
    ex_glance *const g = self;
    const ex_mode *mode;
    double stay[EX_L][EX_PORTS], most[EX_L];
    int tried[BG_MOST_PORTS] = {0}, shocks[EX_PORTS] = {0}, struck = 0;
    for (int i = 0; i < EX_K; i++)
        tried[i] = bg_has(&g->barred, i) ? !g->c->model->switches[i].on : !bg_has(held, i);
    const int status = ex_find(g->c, tried, &mode);
    if (status == BG_NOT_AFFINE && !bg_is_empty(held))
        return BG_OK;
    if (status)
        return BG_UNDECIDED;
    if (mode->ruled)
        return !mode->held && slides_for_sure(g, mode) ? BG_OK : BG_UNDECIDED;
    memcpy(stay, mode->stay, sizeof stay);
    memcpy(most, g->to->most, sizeof most);
    if (!ex_glance_strike(g, mode, stay, most, shocks, &struck)
        || !contradicted(g, mode, stay, most, shocks, broken))
        return BG_UNDECIDED;
    *holds = bg_is_empty(broken);
    memcpy(g->mode, tried, sizeof g->mode);
    /* What an impact does is worked out where it is consistent. */
    return *holds && struck ? BG_UNDECIDED : BG_OK;
}
