/* What happens to states as switches come to hold: the impulses that stop what they must not let
 * through. Friction takes no part: what it gives is finite. */
#include <math.h>
#include <string.h>

#include "model_internal.h"

/* The right null space of D_ss over the ports' own inputs, a direction in each row of `free`: so
 * many. Where a law would have to answer with an impulse of its own there is no such direction. */
static int free_directions(const bg_model *m, const bg_hold *held, double *free)
{
    const bg_structure *const s = &held->ranks;
    double system[PORTS * PORTS];
    int pivots[PORTS], count = 0;
    const int columns = held->count;
    for (int c = 0; c < columns; c++) {
        double right[PORTS];
        int dependent = 0, answered = 0;
        for (int j = 0; j < s->direct; j++)
            dependent |= s->direct_columns[j] == c;
        if (dependent)
            continue;
        for (int i = 0; i < s->direct; i++) {
            const double *row =
                m->numbers.slip_D + held->ports[s->direct_rows[i]] * (K + BG_COUPLED);
            right[i] = -row[held->ports[c]];
            for (int j = 0; j < s->direct; j++) {
                const int at = s->direct_columns[j];
                system[i * s->direct + j] =
                    row[at < columns ? held->ports[at] : K + s->moved_laws[at - columns]];
            }
        }
        if (s->direct > 0 && !bg_factor(s->direct, system, pivots))
            continue;
        bg_solve(s->direct, system, pivots, 1, right);
        double *const way = free + count * columns;
        memset(way, 0, sizeof(double) * (size_t)columns);
        way[c] = 1.0;
        for (int j = 0; j < s->direct; j++) {
            if (s->direct_columns[j] < columns)
                way[s->direct_columns[j]] = right[j];
            else
                answered |= right[j] != 0.0;
        }
        count += !answered;
    }
    return count;
}

/* amounts of the directions for which moved (kept x count) makes up for the slips: the least. */
static int least_amounts(int kept, int count, const double *moved, const double *slips,
                         double *amounts)
{
    double square[PORTS * PORTS], inverse[PORTS * PORTS], weights[PORTS] = {0};
    int pivots[PORTS];
    for (int i = 0; i < kept; i++)
        for (int j = 0; j < kept; j++) {
            square[i * kept + j] = 0.0;
            for (int c = 0; c < count; c++)
                square[i * kept + j] += moved[i * count + c] * moved[j * count + c];
        }
    if (!bg_inverse(kept, square, pivots, inverse))
        return 0;
    bg_multiply_add(kept, kept, inverse, slips, weights);
    for (int c = 0; c < count; c++) {
        amounts[c] = 0.0;
        for (int i = 0; i < kept; i++)
            amounts[c] -= moved[i * count + c] * weights[i];
    }
    return 1;
}

/* slip_x A^-1 B of each direction. */
static void slips_by(const bg_model *m, const bg_hold *held, const double *free, int count,
                  double *moved)
{
    const double *const Q = m->numbers.Q;
    for (int k = 0; k < held->kept; k++)
        for (int d = 0; d < count; d++) {
            double sum = 0.0;
            for (int c = 0; c < held->count; c++) {
                const double way = free[d * held->count + c];
                for (int i = 0; i < N && way != 0.0; i++)
                    sum += held->slip_x[k * N + i] * way
                        * Q[i * M + bg_friction_inputs[held->ports[c]]];
            }
            moved[k * count + d] = sum;
        }
}

int bg_impulses(bg_model *m, const int *mode, bg_hold **held, double *impulses)
{
    double free[PORTS * PORTS], moved[PORTS * PORTS], amounts[PORTS], unit[PORTS];
    int holding[PORTS] = {0}, any = 0;
    *held = NULL;
    for (int i = 0; i < K; i++) {
        holding[i] = bg_switches[i].kind == BG_RUBS ? 1 : mode[i];
        any |= holding[i] == 0;
    }
    if (!any)
        return BG_OK;
    const int status = bg_hold_of(m, holding, held);
    if (status != BG_OK)
        return status;
    const bg_hold *const h = *held;
    const int count = free_directions(m, h, free);
    slips_by(m, h, free, count, moved);
    memset(impulses, 0, sizeof(double) * (size_t)(h->kept * K));
    for (int k = 0; k < h->kept; k++) {
        for (int l = 0; l < h->kept; l++)
            unit[l] = l == k;
        if (!least_amounts(h->kept, count, moved, unit, amounts))
            return BG_NO_HOLD;
        for (int d = 0; d < count; d++)
            for (int c = 0; c < h->count; c++)
                impulses[k * K + h->ports[c]] += free[d * h->count + c] * amounts[d];
    }
    return BG_OK;
}

void bg_pass_on(const bg_model *m, const double *given, double *s, double *received)
{
    const bg_numbers *const a = &m->numbers;
    memset(received, 0, sizeof(double) * ROWS);
    for (int k = 0; k < K; k++) {
        const int column = bg_friction_inputs[k];
        for (int i = 0; i < N && given[k] != 0.0; i++)
            s[i] += a->Q[i * M + column] * given[k];
        for (int i = 0; i < ROWS && given[k] != 0.0; i++)
            received[i] += a->D[i * M + column] * given[k];
    }
    for (int i = 0; i < OWN; i++)
        s[N + i] += received[bg_law_rates[i]];
}

/* What conditions gain by impulses: as values so much larger than all others. */
static void push_guards(bg_model *m, const double *given, const double *received, double size,
                        double *pushed)
{
    bg_values *const now = &m->now;
    double before[BG_ROOM(BG_GUARDS)] = {0}, after[BG_ROOM(BG_GUARDS)] = {0};
    double u[BG_ROOM(M)], y[BG_ROOM(ROWS)];
    memcpy(u, now->u, sizeof u);
    memcpy(y, now->y, sizeof y);
    const double most = ldexp(1.0 + bg_largest(ROWS, y), 40), far = most / size;
    bg_guards(now, before);
    for (int k = 0; k < K; k++)
        now->u[bg_friction_inputs[k]] += far * given[k];
    for (int i = 0; i < ROWS; i++)
        now->y[i] += far * received[i];
    bg_guards(now, after);
    memcpy(now->u, u, sizeof u);
    memcpy(now->y, y, sizeof y);
    for (int g = 0; g < BG_GUARDS; g++)
        pushed[g] = (after[g] - before[g]) / most * size;
}

void bg_shocks(bg_model *m, const int *mode, const double *given, const double *received,
               double *ways)
{
    double pushed[BG_ROOM(BG_GUARDS)] = {0};
    const double largest = bg_largest(K, given);
    const double size = fmax(largest, bg_largest(ROWS, received));
    if (BG_GUARDS && size > 0.0)
        push_guards(m, given, received, size, pushed);
    for (int i = 0; i < K; i++) {
        const bg_switch *const w = bg_switches + i;
        const double *const D = m->numbers.D + bg_friction_readings[i] * M;
        double terms = 0.0;
        /* They are solved for together: one that is the rounding of none counts as the largest. */
        for (int k = 0; k < K; k++)
            terms += given[k] != 0.0 ? fabs(D[bg_friction_inputs[k]]) * largest : 0.0;
        ways[i] = w->kind == BG_TOLD ? -pushed[bg_condition(w, mode[i])]
            : mode[i]                ? w->side * received[bg_friction_readings[i]]
                                     : -w->side * given[i];
        const double least = w->kind == BG_TOLD ? size : mode[i] ? terms : largest;
        if (w->kind == BG_RUBS || fabs(ways[i]) <= BG_ROUNDING * least)
            ways[i] = 0.0;
    }
}

int bg_have_slips(const bg_hold *held, const double *slips, const double *near)
{
    for (int k = 0; k < held->kept; k++) {
        double least = 0.0;
        for (int c = 0; c < held->count; c++)
            least += fabs(held->mix[k * held->count + c]) * near[c];
        if (fabs(slips[k]) > least)
            return 1;
    }
    return 0;
}

void bg_less_speeds(const bg_hold *held, const double *speeds, double *slips)
{
    for (int k = 0; k < held->kept; k++)
        for (int c = 0; c < held->count; c++)
            slips[k] -= held->mix[k * held->count + c] * speeds[held->ports[c]];
}
