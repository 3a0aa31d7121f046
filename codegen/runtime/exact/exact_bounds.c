/* The exponentials of a system's steps, and bounds on what triggers do between them. */
#include "exact_internal.h"

#include <math.h>
#include <string.h>

/* rows M, where rows are by columns, too: rows[j] is column j of all of them. */
static void rows_times(double (*rows)[EX_TRIGGERS], double (*M)[EX_Z], double (*to)[EX_TRIGGERS])
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
    rows_times(e->trigger, E, ends);
    rows_times(ends, e->M, change); /* M and its exponential commute */
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

/* Bounds on the fourth derivatives of triggers during the next EX_RENEWAL steps, as weights of the
 * magnitudes of the rates z'. With f = W M^3, f exp(M tau) is known at steps, and differs between
 * them from the straight line by at most h^2/8 |f exp(M tau) M^2|. */
void ex_bound(ex_context *c, ex_entry *e, double (*E)[EX_Z])
{
    double at[EX_Z][EX_TRIGGERS], next[EX_Z][EX_TRIGGERS], most[EX_TRIGGERS] = {0};
    const double bend = e->step * e->step / 8.0 * square_norm(c, e);
    const double scale = e->step * e->step * e->step * e->step / 384.0;
    rows_times(e->trigger, e->M, next);
    rows_times(next, e->M, at);
    rows_times(at, e->M, next);
    memset(e->fourth, 0, sizeof e->fourth);
    for (int r = 0; r <= EX_RENEWAL; r++) {
        memcpy(at, next, sizeof at);
        for (int j = 0; j < EX_Z; j++)
            for (int i = 0; i < EX_T; i++)
                e->fourth[j][i] = bg_greater(e->fourth[j][i], fabs(at[j][i]));
        if (r < EX_RENEWAL)
            rows_times(at, E, next);
    }
    for (int j = 0; j < EX_Z; j++)
        for (int i = 0; i < EX_T; i++)
            most[i] = bg_greater(most[i], e->fourth[j][i] / e->weight[j]);
    for (int j = 0; j < EX_Z; j++)
        for (int i = 0; i < EX_T; i++) {
            const double between = bend / (1.0 - bend) * most[i] * e->weight[j];
            const double bound = scale * (e->fourth[j][i] + between) * (1.0 + BG_BOUND_SLACK);
            /* Written so that what is no number is too large as well: nothing is certain then. */
            e->fourth[j][i] = bound < BG_HUGE ? bound : BG_HUGE;
        }
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
    const ex_entry *e = stretch->entry;
    double rate[EX_Z], next[EX_ROW] = {0};
    memset(stretch->origin, 0, sizeof stretch->origin);
    memcpy(stretch->origin, row, sizeof rate);
    memcpy(rate, stretch->b, sizeof rate);
    for (int j = 0; j < EX_Z; j++)
        for (int i = 0; i < EX_Z; i++)
            rate[i] += e->M[j][i] * row[j];
    for (int j = 0; j < EX_Z; j++)
        for (int i = 0; i < EX_Z; i++)
            next[i] += e->gather[j][i] * rate[j];
    for (int j = 0; j < EX_Z; j++)
        next[j] += row[j];
    ex_fill(stretch, next);
    for (int j = 0; j < EX_Z; j++)
        next[j] = 0.0;
    for (int j = 0; j < EX_Z; j++)
        for (int i = 0; i < EX_Z; i++)
            next[i] += e->gather[j][i] * rate[j];
    for (int r = 0; r < EX_STRIDE; r++) {
        double *to = stretch->constant[r];
        memcpy(to, next, sizeof next);
        for (int j = 0; r && j < EX_Z; j++)
            for (int i = 0; i < EX_ROW; i++)
                to[i] += e->leap[0][j][i] * stretch->constant[r - 1][j];
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
