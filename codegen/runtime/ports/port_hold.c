/* What holds ports that stick: linear equations for their efforts. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "model_internal.h"

static void copy_direct(const bg_model *m, bg_hold *held)
{
    const bg_structure *const s = &held->ranks;
    for (int r = 0; r < s->direct; r++) {
        const int row = bg_friction_readings[held->ports[s->direct_rows[r]]];
        memcpy(held->X + r * N, m->numbers.F + row * N, sizeof(double) * N);
        memcpy(held->U + r * M, m->numbers.D + row * M, sizeof(double) * M);
        memcpy(held->V + r * M, m->numbers.G + row * M, sizeof(double) * M);
    }
}

/* row += factor * a[at], `columns` wide */
static void add_row(int columns, double factor, const double *a, int at, double *row)
{
    for (int j = 0; j < columns && factor != 0; j++)
        row[j] += factor * a[at * columns + j];
}

/* What a row gains where the factors of a slip move. */
static void add_moving(const bg_numbers *a, double factor, int port, bg_hold *held, int row)
{
    if (bg_moving[port] < 0)
        return;
    add_row(N, factor, a->F, bg_moving[port], held->X + row * N);
    add_row(M, factor, a->D, bg_moving[port], held->U + row * M);
    add_row(M, factor, a->G, bg_moving[port], held->V + row * M);
}

/* The rows that rule the states: N^T y_s' = 0. */
static void rule_states(const bg_model *m, const double *null, bg_hold *held)
{
    const bg_structure *const s = &held->ranks;
    const bg_numbers *const a = &m->numbers;
    for (int k = 0; k < s->kept; k++) {
        const double *combined = null + s->kept_rows[k] * held->count;
        double *slip_x = held->slip_x + k * N, *slip_u = held->slip_u + k * M;
        double *fixed = held->fixed + k * M;
        const int row = s->direct + k;
        for (int c = 0; c < held->count; c++) {
            add_row(N, combined[c], a->F, bg_friction_readings[held->ports[c]], slip_x);
            add_row(M, combined[c], a->D, bg_friction_readings[held->ports[c]], slip_u);
        }
        memcpy(held->mix + k * held->count, combined, sizeof(double) * (size_t)held->count);
        memcpy(fixed, slip_u, sizeof(double) * M);
        memcpy(held->V + row * M, slip_u, sizeof(double) * M);
        for (int c = 0; c < held->count; c++)
            add_moving(a, combined[c], held->ports[c], held, row);
        for (int l = 0; l < N; l++) {
            add_row(N, slip_x[l], a->P, l, held->X + row * N);
            add_row(M, slip_x[l], a->Q, l, held->U + row * M);
            add_row(M, slip_x[l], a->R, l, held->V + row * M);
            if (!BG_VARYING)
                add_row(M, slip_x[l], a->R, l, fixed);
        }
    }
}

static int invert_system(bg_hold *held)
{
    const bg_structure *const s = &held->ranks;
    double system[PORTS * PORTS];
    int pivots[PORTS];
    const int count = held->count, ruled = s->direct + s->kept;
    for (int c = 0; c < count; c++) {
        for (int r = 0; r < ruled; r++)
            system[r * count + c] = held->U[r * M + bg_friction_inputs[held->ports[c]]];
        for (int r = 0; r < held->share_count; r++)
            system[(ruled + r) * count + c] = held->share[r * count + c];
    }
    return bg_inverse(count, system, pivots, held->inverse);
}

/* Directions in which efforts move nothing: combinations of slips, unless factors are others: the
 * jump of a law acts with another one than what it hangs on has. */
static void find_ways(bg_hold *held)
{
    const int count = held->count, ruled = held->ranks.direct + held->ranks.kept;
    int lopsided = 0;
    for (int r = 0; r < ruled; r++)
        for (int d = 0; d < held->share_count; d++) {
            double moved = 0.0, size = 0.0;
            for (int c = 0; c < count; c++) {
                const double term = held->U[r * M + bg_friction_inputs[held->ports[c]]]
                    * held->share[d * count + c];
                moved += term;
                size += fabs(term);
            }
            lopsided |= fabs(moved) > BG_CONSISTENT * size;
        }
    for (int d = 0; d < held->share_count; d++)
        for (int c = 0; c < count; c++)
            held->ways[d * count + c] = lopsided ? held->inverse[c * count + ruled + d]
                                                 : held->share[d * count + c];
}

/* What impulses of the ports move, by columns: whether that is another than what stops their slips
 * and moves no others, as that of jumps, which do not act as they are acted on. `by`: how those
 * impulses move the slips. */
static int is_pushed_aside(const bg_model *m, const bg_hold *held, double *by)
{
    const int count = held->count, kept = held->kept;
    int aside = 0;
    memset(by, 0, sizeof(double) * PORTS * PORTS);
    if (held->ranks.direct > 0)
        return 0;
    for (int c = 0; c < count; c++) {
        const double *const Q = m->numbers.Q + bg_friction_inputs[held->ports[c]];
        for (int k = 0; k < kept; k++)
            for (int i = 0; i < N; i++)
                by[k * count + c] += held->slip_x[k * N + i] * Q[i * M];
        for (int i = 0; i < N; i++) {
            double beside = Q[i * M], size = fabs(Q[i * M]);
            for (int k = 0; k < kept; k++) {
                beside += held->take_away[i * kept + k] * by[k * count + c];
                size += fabs(held->take_away[i * kept + k] * by[k * count + c]);
            }
            aside |= fabs(beside) > BG_CONSISTENT * size;
        }
    }
    return aside;
}

/* Those impulses stop the slips, where they can. */
static void stop_by_ports(const bg_model *m, bg_hold *held)
{
    double by[PORTS * PORTS], square[PORTS * PORTS] = {0}, inverse[PORTS * PORTS];
    int pivots[PORTS];
    const int count = held->count, kept = held->kept;
    if (!is_pushed_aside(m, held, by))
        return;
    for (int k = 0; k < kept; k++)
        for (int l = 0; l < kept; l++)
            for (int c = 0; c < count; c++)
                square[k * kept + l] += by[k * count + c] * by[l * count + c];
    if (!bg_inverse(kept, square, pivots, inverse))
        return;
    memset(held->take_away, 0, sizeof held->take_away);
    for (int c = 0; c < count; c++)
        for (int l = 0; l < kept; l++) {
            double share = 0.0;
            for (int k = 0; k < kept; k++)
                share += by[k * count + c] * inverse[k * kept + l];
            for (int i = 0; i < N; i++)
                held->take_away[i * kept + l] -=
                    m->numbers.Q[i * M + bg_friction_inputs[held->ports[c]]] * share;
        }
}

/* -A^-1 S^T (S A^-1 S^T)^-1: the impulse that stops the slips S x, and moves nothing else. */
static int find_take_away(bg_model *m, bg_hold *held)
{
    double inner[PORTS * PORTS], inverse[PORTS * PORTS], *const moved = m->work.moved;
    int pivots[PORTS];
    const int kept = held->kept;
    for (int i = 0; i < N; i++)
        for (int k = 0; k < kept; k++)
            moved[i * kept + k] = held->slip_x[k * N + i];
    bg_solve_storages(&m->numbers, kept, moved);
    memset(inner, 0, sizeof inner);
    for (int k = 0; k < kept; k++)
        for (int i = 0; i < N; i++)
            add_row(kept, held->slip_x[k * N + i], moved, i, inner + k * kept);
    if (!bg_inverse(kept, inner, pivots, inverse))
        return 0;
    for (int i = 0; i < N; i++)
        for (int k = 0; k < kept; k++)
            add_row(kept, -moved[i * kept + k], inverse, k, held->take_away + i * kept);
    stop_by_ports(m, held);
    return 1;
}

/* Refuses to stick where the slope of a law that the system rules would be needed. */
static int check_slopes(const bg_hold *held)
{
    for (int r = 0; r < held->ranks.direct + held->ranks.kept; r++)
        for (int j = 0; j < M; j++)
            if (fabs(held->V[r * M + j]) > BG_NOTHING_HELD && !bg_differentiable[j])
                return BG_NEEDS_SLOPE;
    return BG_OK;
}

/* Where matrices stay as they are. */
static void list_rules(bg_hold *held)
{
    const int ruled = held->ranks.direct + held->ranks.kept;
    BG_LIST_ENTRIES(ruled, N, held, X);
    BG_LIST_ENTRIES(ruled, M, held, U);
    BG_LIST_ENTRIES(ruled, M, held, V);
    BG_LIST_ENTRIES(held->kept, M, held, fixed);
    BG_LIST_ENTRIES(held->count, held->count, held, inverse);
    BG_LIST_ENTRIES(held->kept, N, held, slip_x);
    BG_LIST_ENTRIES(N, held->kept, held, take_away);
}

static int build(bg_model *m, bg_hold *held)
{
    const bg_structure *const s = &held->ranks;
    double null[PORTS * PORTS];
    memset(held->X, 0, sizeof *held - offsetof(bg_hold, X));
    held->share_count = 0;
    if (!bg_independent(m, held, null))
        return BG_STRUCTURE;
    held->kept = s->kept;
    held->ruled = s->ruled ? held->share_count : 0;
    copy_direct(m, held);
    rule_states(m, null, held);
    /* Where laws answer as well, all are searched for together. */
    if ((s->moved == 0 && !invert_system(held)) || !find_take_away(m, held))
        return BG_NO_HOLD;
    memcpy(held->ways, held->share, sizeof held->ways);
    if (s->moved == 0)
        find_ways(held);
    if (!BG_VARYING)
        list_rules(held);
    return check_slopes(held);
}

/* Where a set is kept, or that which was not asked for for longest. */
static bg_hold *place_of(bg_model *m, const bg_set *stuck)
{
    bg_hold *oldest = m->holds;
    for (int k = 0; k < BG_HOLDS; k++) {
        bg_hold *const one = m->holds + k;
        if (one->used && bg_is_same(&one->stuck, stuck))
            return one;
        if (m->asked - one->used > m->asked - oldest->used)
            oldest = one;
    }
    oldest->used = 0;
    return oldest;
}

/* The holding equations of the ports that stick in a mode, from before if they still hold. */
int bg_hold_of(bg_model *m, const int *mode, bg_hold **found)
{
    const bg_set stuck = bg_held_in(K, mode);
    bg_hold *const held = place_of(m, &stuck);
    const int known = held->used != 0;
    *found = held;
    m->asked += m->asked + 1 ? 1 : 2; /* 0 is that of an empty place */
    held->used = m->asked;
    if (known && held->ready)
        return BG_OK;
    if (!known) {
        held->stuck = stuck;
        held->count = 0;
        for (int i = 0; i < K; i++)
            if (mode[i] == 0)
                held->ports[held->count++] = i;
        bg_rank(m, held->count, held->ports, &held->ranks);
    }
    const int status = build(m, held);
    held->ready = status == BG_OK;
    return status;
}

/* The holding efforts at `m->now`, whose inputs hold zero at the sticking ports. */
int bg_holding_efforts(bg_model *m, const bg_hold *held, double *efforts)
{
    double right[PORTS] = {0}, caps[PORTS];
    const int ruled = held->count - held->share_count;
    bg_multiply_listed(ruled, N, held->X, held->X_list, m->now.x, right);
    bg_multiply_listed(ruled, M, held->U, held->U_list, m->now.u, right);
    bg_multiply_listed(ruled, M, held->V, held->V_list, m->du, right);
    for (int r = 0; r < held->count; r++) {
        right[r] = -right[r];
        efforts[r] = 0.0;
        caps[r] = m->caps[held->ports[r]];
    }
    bg_multiply_listed(held->count, held->count, held->inverse, held->inverse_list, right, efforts);
    if (!bg_finite(held->count, efforts))
        return BG_NOT_FINITE;
    return held->share_count == 0 || m->work.unshared ? BG_OK
                                                      : bg_fair_share(held, caps, efforts);
}

void bg_effort_terms(const bg_hold *held, const double *x, const double *u, const double *du,
                     double *sums)
{
    const int ruled = held->count - held->share_count;
    double terms[PORTS] = {0};
    for (int r = 0; r < ruled; r++) {
        for (int j = 0; j < N; j++)
            terms[r] += fabs(held->X[r * N + j]) * fabs(x[j]);
        for (int j = 0; j < M; j++)
            terms[r] += fabs(held->U[r * M + j]) * fabs(u[j])
                + fabs(held->V[r * M + j]) * fabs(du[j]);
    }
    for (int c = 0; c < held->count; c++) {
        sums[c] = 0.0;
        for (int r = 0; r < ruled; r++)
            sums[c] += fabs(held->inverse[c * held->count + r]) * terms[r];
    }
}

/* What rounding in the holding efforts adds to rates is taken away, or slips that stick would
 * drift. */
void bg_correct(const bg_hold *held, double *rate, const double *du, const double *y)
{
    double drift[PORTS] = {0};
    bg_multiply_listed(held->kept, N, held->slip_x, held->slip_x_list, rate, drift);
    bg_multiply_listed(held->kept, M, held->fixed, held->fixed_list, du, drift);
    for (int k = 0; k < held->kept; k++)
        for (int c = 0; c < held->count; c++)
            if (bg_moving[held->ports[c]] >= 0)
                drift[k] += held->mix[k * held->count + c] * y[bg_moving[held->ports[c]]];
    bg_multiply_listed(N, held->kept, held->take_away, held->take_away_list, drift, rate);
}

void bg_held_slips(const bg_hold *held, const bg_snapshot *shot, double *slips)
{
    memset(slips, 0, sizeof(double) * (size_t)held->kept);
    bg_multiply_add(held->kept, N, held->slip_x, shot->x, slips);
    bg_multiply_add(held->kept, M, held->slip_u, shot->u, slips);
}

int bg_remove_slips(bg_model *m, const int *mode, const bg_snapshot *shot, double *s)
{
    double slips[PORTS];
    bg_hold *held = NULL;
    const int status = bg_hold_of(m, mode, &held);
    if (status != BG_OK)
        return status;
    bg_held_slips(held, shot, slips);
    for (int k = 0; k < held->kept; k++)
        for (int c = 0; c < held->count; c++)
            slips[k] -= held->mix[k * held->count + c] * m->work.aim[held->ports[c]];
    memset(m->work.aim, 0, sizeof m->work.aim);
    bg_multiply_add(N, held->kept, held->take_away, slips, s);
    return BG_OK;
}
