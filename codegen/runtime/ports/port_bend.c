/* Impulses as storages take them: momenta pi are exchanged, pi(x+) - pi(x-) = B_S p, whatever
 * slopes A their laws have. Where these move with what jumps it is searched by Newton's steps,
 * shorter ones where what is left would not shrink. As codegen/standalone/bending.py. */
#include <math.h>
#include <string.h>

#include "model_internal.h"

enum { JUMPS = BG_ROOM(N), BENT = BG_ROOM(BG_MOMENTA > N ? BG_MOMENTA : N) };

/* A search: the instant before, what storages hold there, and the speeds to which slips are
 * brought (NULL: zero). At the state x that is tried they hold pi; what the whole strike is by the
 * slopes there, the ports' impulses and what states gain. */
typedef struct {
    bg_model *m;
    const int *mode;
    const bg_snapshot *before;
    const double *speeds;
    bg_hold *held;
    double first[BENT], x[JUMPS], pi[BENT];
    double impulses[PORTS * PORTS], struck[PORTS], jump[JUMPS];
} bg_bend;

/* What storages hold at a state. */
static void hold_at(const bg_bend *b, const double *x, double *pi)
{
    memcpy(b->m->now.x, x, sizeof(double) * N);
    bg_momenta(&b->m->now, pi);
}

/* The matrices at the model's instant, and what holds the ports with them. */
static int slopes_here(bg_bend *b)
{
    for (int i = 0; i < BG_HOLDS; i++)
        b->m->holds[i].ready = 0;
    const int status = bg_assemble(b->m);
    return status ? status : bg_impulses(b->m, b->mode, &b->held, b->impulses);
}

/* All that is struck by the slopes of one place, if it is told at another. */
static void strike_from(bg_bend *b, const double *x, const double *pi)
{
    const bg_numbers *const a = &b->m->numbers;
    const bg_hold *const h = b->held;
    double base[JUMPS], slips[PORTS] = {0};
    for (int i = 0; i < N; i++)
        base[i] = pi[i] - b->first[i];
    bg_solve_storages(a, 1, base);
    for (int i = 0; i < N; i++)
        base[i] = x[i] - base[i];
    bg_multiply_add(h->kept, N, h->slip_x, base, slips);
    bg_multiply_add(h->kept, M, h->slip_u, b->before->u, slips);
    if (b->speeds)
        bg_less_speeds(h, b->speeds, slips);
    memset(b->struck, 0, sizeof b->struck);
    for (int k = 0; k < h->kept; k++)
        for (int i = 0; i < K; i++)
            b->struck[i] += b->impulses[k * K + i] * slips[k];
    for (int i = 0; i < N; i++) {
        b->jump[i] = base[i] - b->before->x[i];
        for (int k = 0; k < K; k++)
            b->jump[i] += a->Q[i * M + bg_friction_inputs[k]] * b->struck[k];
    }
}

/* The length of a change of states, each by what it weighs. */
static double length_of(const bg_bend *b, const double *way)
{
    double sum = 0.0;
    for (int i = 0; i < N; i++) {
        const double part = way[i] / b->m->numbers.scale[i];
        sum += part * part;
    }
    return sqrt(sum);
}

/* How far it is from a state to where the latest strike leads; the way there. */
static double way_from(const bg_bend *b, const double *x, double *way)
{
    for (int i = 0; i < N; i++)
        way[i] = b->before->x[i] + b->jump[i] - x[i];
    return length_of(b, way);
}

/* What rounding is a part of: states, and what they would be by all that storages hold. */
static double size_of(const bg_bend *b)
{
    double sizes[JUMPS];
    for (int i = 0; i < N; i++) {
        const double scale = b->m->numbers.scale[i];
        sizes[i] = fabs(b->x[i]) + fabs(b->before->x[i])
            + (fabs(b->pi[i]) + fabs(b->first[i])) * scale * scale;
    }
    return length_of(b, sizes);
}

/* So far along a way that what is left shrinks, the slopes as they are. */
static int come_nearer(bg_bend *b, const double *way, double before)
{
    double x[JUMPS], pi[BENT], left[JUMPS];
    double part = 1.0;
    for (int halves = 0; halves < BG_BENT_HALVES; halves++, part /= 2.0) {
        for (int i = 0; i < N; i++)
            x[i] = b->x[i] + part * way[i];
        hold_at(b, x, pi);
        if (!bg_finite(BG_MOMENTA, pi))
            continue;
        strike_from(b, x, pi);
        if (way_from(b, x, left) <= (1.0 - part / 2.0) * before) {
            memcpy(b->x, x, sizeof x);
            memcpy(b->pi, pi, sizeof pi);
            return slopes_here(b);
        }
    }
    return BG_UNEXCHANGED;
}

static int search_strike(bg_bend *b)
{
    double way[JUMPS];
    for (int turn = 0; turn < BG_BENDS; turn++) {
        strike_from(b, b->x, b->pi);
        const double left = way_from(b, b->x, way);
        if (left <= BG_BENT * size_of(b))
            return BG_OK;
        const int status = come_nearer(b, way, left);
        if (status)
            return status;
    }
    return BG_UNEXCHANGED;
}

/* What readings receive: of those that show rates what is gained behind them. */
static void show_received(bg_bend *b, double *received)
{
    const bg_numbers *const a = &b->m->numbers;
    const bg_pattern *const shown = &bg_layout[BG_H];
    const double *entries = b->m->work.entries;
    double after[JUMPS], pi[BENT], by_slopes[BG_ROOM(ROWS)] = {0};
    for (int which = 0; which < BG_H; which++)
        entries += bg_layout[which].count;
    memset(received, 0, sizeof(double) * ROWS);
    for (int k = 0; k < K; k++) {
        const int column = bg_friction_inputs[k];
        for (int i = 0; i < ROWS && b->struck[k] != 0.0; i++)
            received[i] += a->D[i * M + column] * b->struck[k];
        for (int e = 0; e < shown->count && b->struck[k] != 0.0; e++)
            by_slopes[shown->rows[e]] +=
                entries[e] * a->Q[shown->columns[e] * M + column] * b->struck[k];
    }
    for (int i = 0; i < N; i++)
        after[i] = b->before->x[i] + b->jump[i];
    hold_at(b, after, pi);
    for (int r = N; r < BG_MOMENTA; r++) {
        const int row = bg_momenta_rows[r - N];
        received[row] += pi[r] - b->first[r] - by_slopes[row];
    }
}

/* By slopes that move: the ports' impulses, s after them, and what readings receive. */
static int bend_strike(bg_model *m, const bg_snapshot *before, const int *mode,
                       const double *speeds, double *s, double *struck, double *received)
{
    bg_bend b = {.m = m, .mode = mode, .before = before, .speeds = speeds};
    bg_values *const now = &m->now;
    const double sided = now->sided;
    memcpy(now->x, before->x, sizeof before->x);
    memcpy(now->z, before->z, sizeof before->z);
    memcpy(now->u, before->u, sizeof before->u);
    memcpy(b.x, before->x, sizeof b.x);
    now->sided = 0.0;
    hold_at(&b, b.x, b.first);
    memcpy(b.pi, b.first, sizeof b.pi);
    int status = slopes_here(&b);
    if (status == BG_OK)
        status = search_strike(&b);
    if (status == BG_OK) {
        show_received(&b, received);
        memcpy(struck, b.struck, sizeof b.struck);
        for (int i = 0; i < N; i++)
            s[i] += b.jump[i];
        for (int i = 0; i < OWN; i++)
            s[N + i] += received[bg_law_rates[i]];
    }
    now->sided = sided;
    memcpy(now->x, before->x, sizeof before->x);
    const int back = slopes_here(&b);
    return status ? status : back;
}

/* By slopes that stay. */
static void stop_at_once(bg_model *m, const bg_snapshot *before, const bg_hold *held,
                         const double *impulses, const double *speeds, double *s, double *struck,
                         double *received)
{
    double slips[PORTS];
    bg_held_slips(held, before, slips);
    if (speeds)
        bg_less_speeds(held, speeds, slips);
    for (int k = 0; k < held->kept; k++)
        for (int i = 0; i < K; i++)
            struck[i] += impulses[k * K + i] * slips[k];
    bg_pass_on(m, struck, s, received);
}

int bg_stop(bg_model *m, const bg_snapshot *before, const int *mode, const bg_hold *held,
            const double *impulses, const double *speeds, double *s, double *given, double *ways)
{
    double struck[PORTS] = {0}, received[BG_ROOM(ROWS)], gone[PORTS];
    int status = BG_OK;
    if (BG_MOMENTA > 0)
        status = bend_strike(m, before, mode, speeds, s, struck, received);
    else
        stop_at_once(m, before, held, impulses, speeds, s, struck, received);
    if (status)
        return status;
    bg_shocks(m, mode, struck, received, gone);
    for (int i = 0; i < K; i++) {
        given[i] += struck[i];
        ways[i] += gone[i];
    }
    return BG_OK;
}
