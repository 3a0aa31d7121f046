/* What happens to states as switches come to hold: the impulses that stop what they must not let
 * through. Friction takes no part: what it gives is finite. */
#include <math.h>
#include <string.h>

#include "model_internal.h"

/* The right null space of D_ss over the ports' own inputs, a direction in each row of `free`: so
 * many. Where a law would have to answer with an impulse of its own there is no such direction. */
static int free_directions(const bg_model *m, const bg_structure *s, const bg_hold *held,
                           double *free)
{
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
static void reach(const bg_model *m, const bg_hold *held, const double *free, int count,
                  double *moved)
{
    const double *const Q = m->numbers.Q;
    for (int k = 0; k < held->kept; k++)
        for (int d = 0; d < count; d++) {
            double sum = 0.0;
            for (int c = 0; c < held->count; c++) {
                const double way = free[d * held->count + c];
                for (int i = 0; i < N && way != 0.0; i++)
                    sum += held->slip_x[k * N + i] * way * Q[i * M + bg_friction_inputs[held->ports[c]]];
            }
            moved[k * count + d] = sum;
        }
}

/* What s, readings and ports have of the impulses `given`. */
static void pass_on(const bg_model *m, const double *given, double *s, double *received)
{
    const bg_numbers *const a = &m->numbers;
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

int bg_strike(bg_model *m, const int *mode, const bg_snapshot *shot, const double *near, double *s,
              double *given, double *received, int *struck)
{
    double slips[PORTS] = {0}, free[PORTS * PORTS], moved[PORTS * PORTS], amounts[PORTS];
    int holding[PORTS] = {0}, any = 0, jumps = 0;
    bg_hold *held = NULL;
    *struck = 0;
    for (int i = 0; i < K; i++) {
        holding[i] = bg_switches[i].kind == BG_RUBS ? 1 : mode[i];
        any |= holding[i] == 0;
    }
    if (!any)
        return BG_OK;
    const int status = bg_hold_of(m, holding, &held);
    if (status != BG_OK)
        return status;
    bg_multiply_add(held->kept, N, held->slip_x, shot->x, slips);
    bg_multiply_add(held->kept, M, held->slip_u, shot->u, slips);
    for (int k = 0; k < held->kept; k++) {
        double least = 0.0;
        for (int c = 0; c < held->count; c++)
            least += fabs(held->mix[k * held->count + c]) * near[held->ports[c]];
        jumps |= fabs(slips[k]) > BG_WIDE * least;
    }
    if (!jumps)
        return BG_OK;
    const int count = free_directions(m, &bg_structures[held->stuck], held, free);
    reach(m, held, free, count, moved);
    if (!least_amounts(held->kept, count, moved, slips, amounts))
        return BG_NO_HOLD;
    memset(given, 0, sizeof(double) * K);
    memset(received, 0, sizeof(double) * ROWS);
    for (int d = 0; d < count; d++)
        for (int c = 0; c < held->count; c++)
            given[held->ports[c]] += free[d * held->count + c] * amounts[d];
    pass_on(m, given, s, received);
    *struck = 1;
    return BG_OK;
}
