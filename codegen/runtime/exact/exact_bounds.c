/* The exponentials of a system's steps, and bounds on what triggers do between them. */
#include "exact_internal.h"

#include <math.h>
#include <string.h>

/* rows M, where rows are by columns, too: rows[j] is column j of all of them. */
void ex_rows_times(double (*rows)[EX_TRIGGERS], double (*M)[EX_Z],
                   double (*restrict to)[EX_TRIGGERS])
{
    for (int j = 0; j < EX_Z; j++) {
        double sum[EX_TRIGGERS] = {0};
        for (int l = 0; l < EX_Z; l++)
            for (int i = 0; i < EX_T; i++)
                sum[i] += rows[l][i] * M[j][l];
        memcpy(to[j], sum, sizeof sum);
    }
}

/* One step as columns of samples: the state, the triggers and a third of their change in a step. */
static void first_leap(ex_entry *e, double (*E)[EX_Z])
{
    double change[EX_Z][EX_TRIGGERS], ends[EX_Z][EX_TRIGGERS];
    memset(e->leap[0], 0, sizeof e->leap[0]);
    ex_rows_times(e->trigger, E, ends);
    ex_rows_times(ends, e->M, change); /* M and its exponential commute */
    for (int j = 0; j < EX_Z; j++) {
        memcpy(e->leap[0][j], E[j], sizeof E[j]);
        for (int i = 0; i < EX_T; i++) {
            const int watched = !e->cap[i];
            e->leap[0][j][EX_Z + i] = ends[j][i];
            e->leap[0][j][EX_Z + EX_T + i] = watched ? e->step / 3.0 * change[j][i] : 0.0;
        }
    }
}

/* A norm of M^2: the largest weighted column sum, and no more than what the norm of M allows, as
 * weights that are far apart make much of rounding. */
static double square_norm(ex_context *c, const ex_entry *e)
{
    double (*const square)[EX_Z] = c->work[0], norm = 0.0;
    ex_multiply((double(*)[EX_Z])e->M, (double(*)[EX_Z])e->M, square);
    for (int j = 0; j < EX_Z; j++) {
        double sum = 0.0;
        for (int i = 0; i < EX_Z; i++)
            sum += e->weight[i] * fabs(square[j][i]);
        norm = bg_greater(norm, sum / e->weight[j]);
    }
    return bg_lesser(norm, e->norm * e->norm);
}

/* How large rows of triggers times exp(M tau) are from now until some steps later, at the most. They
 * are known at steps, and differ between them from the straight line by at most h^2/8 |rows exp(M tau)
 * M^2|. */
void ex_extremes(ex_context *c, const ex_entry *e, double step, int steps, double (*E)[EX_Z],
                 double (*rows)[EX_TRIGGERS], double (*most)[EX_TRIGGERS])
{
    double at[EX_Z][EX_TRIGGERS], largest[EX_TRIGGERS] = {0};
    const double bend = step * step / 8.0 * square_norm(c, e);
    memset(most, 0, sizeof at);
    for (int r = 0; r <= steps; r++) {
        memcpy(at, rows, sizeof at);
        for (int j = 0; j < EX_Z; j++)
            for (int i = 0; i < EX_T; i++)
                most[j][i] = bg_greater(most[j][i], fabs(at[j][i]));
        if (r < steps)
            ex_rows_times(at, E, rows);
    }
    for (int j = 0; j < EX_Z; j++)
        for (int i = 0; i < EX_T; i++)
            largest[i] = bg_greater(largest[i], most[j][i] / e->weight[j]);
    for (int j = 0; j < EX_Z; j++)
        for (int i = 0; i < EX_T; i++) {
            most[j][i] += bend / (1.0 - bend) * largest[i] * e->weight[j];
            /* Written so that what is no number is too large as well: nothing is certain then. */
            most[j][i] = most[j][i] < BG_HUGE ? most[j][i] : BG_HUGE;
        }
}

/* Bounds on the fourth derivatives of triggers during the next EX_RENEWAL steps, as weights of the
 * magnitudes of the rates z', which exp(M tau) takes on. */
void ex_bound(ex_context *c, ex_entry *e, double (*E)[EX_Z])
{
    double rows[EX_Z][EX_TRIGGERS], next[EX_Z][EX_TRIGGERS];
    const double scale = e->step * e->step * e->step * e->step / 384.0 * (1.0 + BG_BOUND_SLACK);
    ex_rows_times(e->trigger, e->M, next);
    ex_rows_times(next, e->M, rows);
    ex_rows_times(rows, e->M, next);
    ex_extremes(c, e, e->step, EX_RENEWAL, E, next, e->fourth);
    for (int j = 0; j < EX_Z; j++)
        for (int i = 0; i < EX_T; i++)
            e->fourth[j][i] *= scale;
}

/* The product of columns with rows that samples have. */
static void leap_further(double (*leap)[EX_ROW], double (*before)[EX_ROW], double (*to)[EX_ROW])
{
    for (int j = 0; j < EX_Z; j++) {
        double sum[EX_ROW] = {0};
        for (int l = 0; l < EX_Z; l++)
#pragma GCC unroll 1
            for (int i = 0; i < EX_ROW; i++)
                sum[i] += leap[l][i] * before[j][l];
        memcpy(to[j], sum, sizeof sum);
    }
}

/* The constant parts of the next samples, which are told from an origin: so nothing large is
 * rounded again in every step. */
static void leap_constants(ex_stretch *stretch, const double *row)
{
    const ex_entry *const e = stretch->entry;
    EX_ALIGNED double rate[EX_WIDE], moved[EX_Z] = {0}, next[EX_ROW] = {0};
    memset(stretch->origin, 0, sizeof stretch->origin);
    memcpy(stretch->origin, row, sizeof moved);
    ex_differentiate(e, row, rate);
    for (int i = 0; i < EX_Z; i++)
        rate[i] += stretch->b[i];
    ex_add_columns(EX_Z, EX_Z, e->gather[0], rate, moved);
    for (int i = 0; i < EX_Z; i++)
        next[i] = row[i] + moved[i];
    ex_fill(stretch, next);
    memcpy(next, moved, sizeof moved);
    for (int r = 0; r < EX_STRIDE; r++) {
        double *const to = stretch->constant[r];
        memcpy(to, next, sizeof next);
        if (r)
            ex_add_columns(EX_ROW, EX_ROW, e->leap[0][0], stretch->constant[r - 1], to);
    }
}

void ex_divide(ex_context *c, ex_entry *e, double h, double (*E)[EX_Z])
{
    e->h = h;
    e->parts = (long long)bg_greater(ceil(e->norm * h / BG_LONGEST), 1.0);
    e->step = h / (double)e->parts;
    ex_exponential(c, e->M, e->norm, e->step, E, e->gather);
}

void ex_leaps(ex_context *c, ex_stretch *stretch, double h, const double *row)
{
    ex_entry *e = stretch->entry;
    if (e->h != h) {
        double(*E)[EX_Z] = c->work[5];
        ex_divide(c, e, h, E);
        first_leap(e, E);
        for (int r = 1; r < EX_STRIDE; r++)
            leap_further(e->leap[0], e->leap[r - 1], e->leap[r]);
        if (EX_K)
            ex_bound(c, e, E);
    }
    leap_constants(stretch, row);
    stretch->leaping = 1;
}
