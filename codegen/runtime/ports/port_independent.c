/* Which slips of a set of sticking ports are independent, and the combinations that are not. Which
 * rows that is has been decided exactly; here only numbers are solved for. */
#include <math.h>
#include <string.h>

#include "model_internal.h"

#define ANSWERING BG_TABLE(BG_FRICTION, BG_FRICTION + BG_COUPLED)

/* factors[j]: row `row` of a as a combination of `count` independent rows; 0 unless it is one.
 * `sizes`: of the terms that make up the entries. */
static int combination(int columns, const double *a, const double *sizes, int count,
                       const int *rows, const int *pivot_columns, int row, double *factors)
{
    double system[PORTS * PORTS];
    int pivots[PORTS];
    for (int j = 0; j < count; j++) {
        for (int i = 0; i < count; i++)
            system[i * count + j] = a[rows[j] * columns + pivot_columns[i]];
        factors[j] = a[row * columns + pivot_columns[j]];
    }
    if (!bg_factor(count, system, pivots))
        return 0;
    bg_solve(count, system, pivots, 1, factors);
    for (int c = 0; c < columns; c++) {
        double left = a[row * columns + c], size = fabs(sizes[row * columns + c]);
        for (int j = 0; j < count; j++) {
            left -= factors[j] * a[rows[j] * columns + c];
            size += fabs(factors[j] * sizes[rows[j] * columns + c]);
        }
        if (fabs(left) > BG_CONSISTENT * size)
            return 0;
    }
    return 1;
}

/* null x count: combinations of slips that efforts do not change at once. */
static int null_rows(const bg_structure *s, int count, const double *D, double *null)
{
    const int columns = count + s->moved;
    double factors[PORTS];
    memset(null, 0, sizeof(double) * PORTS * PORTS);
    for (int r = 0; r < s->null; r++) {
        if (!combination(columns, D, D, s->direct, s->direct_rows, s->direct_columns,
                         s->null_rows[r], factors))
            return 0;
        null[r * count + s->null_rows[r]] = 1.0;
        for (int j = 0; j < s->direct; j++)
            null[r * count + s->direct_rows[j]] = -factors[j];
    }
    return 1;
}

/* held->share: combinations that the states do not see either. */
static int share_rows(const bg_structure *s, const double *null, const double *seen,
                      const double *sizes, bg_hold *held)
{
    double factors[PORTS];
    const int count = held->count;
    for (int r = 0; r < s->null; r++) {
        double *row = held->share + held->share_count * count;
        int kept = 0;
        for (int j = 0; j < s->kept; j++)
            kept |= s->kept_rows[j] == r;
        if (kept)
            continue;
        if (!combination(N, seen, sizes, s->kept, s->kept_rows, s->kept_columns, r, factors))
            return 0;
        for (int c = 0; c < count; c++) {
            row[c] = null[r * count + c];
            for (int j = 0; j < s->kept; j++)
                row[c] -= factors[j] * null[s->kept_rows[j] * count + c];
        }
        held->share_count++;
    }
    return 1;
}

/* D of the slips of a set over what answers at once: its own efforts, and the laws they move. */
static void answering(const bg_model *m, const bg_hold *held, double *D)
{
    const bg_structure *const s = &held->ranks;
    const int count = held->count;
    for (int i = 0; i < count; i++) {
        const double *row = m->numbers.slip_D + held->ports[i] * (K + BG_COUPLED);
        for (int j = 0; j < count; j++)
            *D++ = row[held->ports[j]];
        for (int j = 0; j < s->moved; j++)
            *D++ = row[K + s->moved_laws[j]];
    }
}

/* In `null` combinations of slips that efforts do not change at once, in held->share those that
 * the states do not see either; 0 where the numbers have other ranks. */
int bg_independent(const bg_model *m, bg_hold *held, double *null)
{
    const bg_structure *const s = &held->ranks;
    double D[ANSWERING];
    double *const seen = held->take_away, *const sizes = held->slip_x; /* not in use yet */
    const int count = held->count;
    answering(m, held, D);
    if (!null_rows(s, count, D, null))
        return 0;
    for (int r = 0; r < s->null; r++)
        for (int c = 0; c < count; c++)
            for (int j = 0; j < N; j++) {
                const double term = null[r * count + c] * m->numbers.slip_F[held->ports[c] * N + j];
                seen[r * N + j] += term;
                sizes[r * N + j] += fabs(term);
            }
    if (!share_rows(s, null, seen, sizes, held))
        return 0;
    memset(held->take_away, 0, sizeof held->take_away);
    memset(held->slip_x, 0, sizeof held->slip_x);
    return 1;
}

/* Whether redundant ports share a load; one that nothing can load gives nothing. */
int bg_shares(const bg_hold *held)
{
    int loaded = 0;
    for (int c = 0; c < held->count; c++) {
        int any = 0;
        for (int r = 0; r < held->share_count; r++)
            any |= held->share[r * held->count + c] != 0.0;
        loaded += any;
    }
    return loaded > held->share_count;
}

/* Of 1 at zero and 0 where slips that only other inputs rule have left zero, at `near` of each
 * port: the least that a sticking port has part in. */
double bg_room(const bg_hold *held, int port, const bg_snapshot *shot, const double *near)
{
    double least = 1.0;
    for (int r = 0; r < held->ruled; r++) {
        double slip = 0.0, size = 0.0;
        int part = 0;
        for (int c = 0; c < held->count; c++) {
            const double weight = held->share[r * held->count + c];
            slip += weight * shot->y[bg_friction_readings[held->ports[c]]];
            size += fabs(weight) * near[held->ports[c]];
            part |= held->ports[c] == port && weight != 0.0;
        }
        if (part)
            least = fmin(least, 1.0 - fmin(fabs(slip) / size, 2.0));
    }
    return least;
}
