/* Steps of one length, several at a time from the same row: they don't wait for each other.
 *
 * A trigger g with its slope at both ends of a step h differs from the cubic through them by at
 * most h^4/384 max |g''''|, and the cubic stays above the least of its four Bernstein coefficients.
 * Steps that fail this test are repeated by power series. */
#include "exact_internal.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* What follows from the state in a sample: triggers, and a third of their change in a step. */
void ex_fill(const ex_stretch *stretch, double *row)
{
    const ex_entry *const e = stretch->entry;
    EX_ALIGNED double now[EX_WIDE], change[EX_WIDE];
    ex_differentiate(e, row, now);
    for (int i = 0; i < EX_Z; i++)
        now[i] += stretch->b[i];
    ex_differentiate(e, now, change);
    for (int i = 0; i < EX_T; i++) {
        row[EX_Z + i] = stretch->level[i] + now[EX_Z + i];
        row[EX_Z + EX_T + i] = e->cap[i] ? 0.0 : e->step / 3.0 * change[EX_Z + i];
    }
}

/* How far triggers may be from the cubics during the next steps. A cap that is zero is none below. */
void ex_uncertainty(const ex_stretch *stretch, const double *row, double *slack)
{
    const ex_entry *e = stretch->entry;
    double rate[EX_Z];
#pragma GCC unroll 1
    for (int i = 0; i < EX_Z; i++) {
        double sum = stretch->b[i];
#pragma GCC unroll 32
        for (int j = 0; j < EX_Z; j++)
            sum += e->M[j][i] * row[j];
        rate[i] = fabs(sum);
    }
    for (int i = 0; i < EX_T; i++) {
        double sum = 0.0;
        for (int j = 0; j < EX_Z; j++)
            sum += e->fourth[j][i] * rate[j];
        slack[i] = e->cap[i] ? -DBL_MIN : sum;
    }
}

/* By how much a step is certain: the least coefficient of all its triggers, less the slack. */
static inline double margin(const double *a, const double *b, const double *slack)
{
    double least = DBL_MAX;
    for (int i = EX_Z; i < EX_Z + EX_T; i++) {
        const double ends = bg_lesser(a[i], b[i]);
        const double inner = bg_lesser(a[i] + a[i + EX_T], b[i] - b[i + EX_T]);
        least = bg_lesser(least, bg_lesser(ends, inner) - slack[i - EX_Z]);
    }
    return least;
}

/* A row `r` steps on from where the state is `z` beyond the origin; `beyond`: before the origin is
 * added. */
static inline void leap(const double (*restrict p)[EX_ROW], const double *restrict constant,
                        const double *restrict origin, const double *restrict z,
                        double *restrict to, double *restrict beyond)
{
#pragma GCC unroll 1
    for (int i = 0; i < EX_ROW; i++) {
        double sum = constant[i];
#pragma GCC unroll 32
        for (int j = 0; j < EX_Z; j++)
            sum += p[j][i] * z[j];
        beyond[i] = sum;
        to[i] = origin[i] + sum;
    }
}

/* How many of some steps from row `at` are certain. */
static inline int certain(double (*at)[EX_ROW], const double *slack, int ahead)
{
    double sure[EX_STRIDE], least = DBL_MAX;
    for (int r = 0; r < ahead; r++) {
        sure[r] = margin(at[r], at[r + 1], slack);
        least = bg_lesser(least, sure[r]);
    }
    if (least > 0)
        return ahead;
    for (int r = 0; r < ahead; r++)
        if (!(sure[r] > 0))
            return r;
    return ahead;
}

int ex_leap(const ex_stretch *stretch, int count, double (*rows)[EX_ROW])
{
    const ex_entry *e = stretch->entry;
    double slack[EX_TRIGGERS] = {0}, z[EX_Z], beyond[EX_ROW];
    int done = 0;
    for (int j = 0; j < EX_Z; j++)
        z[j] = rows[0][j] - stretch->origin[j];
    while (done < count) {
        const int ahead = count - done < EX_STRIDE ? count - done : EX_STRIDE;
        double(*at)[EX_ROW] = rows + done;
        int sure = ahead;
        if (done % EX_RENEWAL == 0 && EX_K)
            ex_uncertainty(stretch, at[0], slack);
        for (int r = 0; r < ahead; r++)
            leap((const double(*)[EX_ROW])e->leap[r], stretch->constant[r], stretch->origin, z,
                 at[r + 1], beyond);
        memcpy(z, beyond, sizeof z);
        if (EX_K)
            sure = ahead == EX_STRIDE ? certain(at, slack, EX_STRIDE) : certain(at, slack, ahead);
        done += sure;
        if (sure < ahead)
            return done;
    }
    return done;
}
