/* Integrals of products of signals over a stretch, whatever its steps were. With y = (z, 1) and
 * y' = A y, P(h) is the integral of y y^T over h: by Gauss's formula on the power series over a short
 * step, then P(2h) = P(h) + E(h) P(h) E(h)^T. The integral of a product of rows a and b is a P b^T. */
#include "batch_gauss.h"
#include "batch_internal.h"

#include <string.h>

enum { WIDE = EX_Z + 1, ONE = EX_Z, MOST_DOUBLINGS = 60 };

typedef double square[WIDE][WIDE]; /* by rows */

static void multiply(const double (*left)[WIDE], const double (*right)[WIDE], double (*to)[WIDE])
{
    for (int i = 0; i < WIDE; i++)
        for (int j = 0; j < WIDE; j++) {
            double sum = 0.0;
            for (int l = 0; l < WIDE; l++)
                sum += left[i][l] * right[l][j];
            to[i][j] = sum;
        }
}

/* A times a step. */
static void system_of(const ex_stretch *stretch, double step, double (*A)[WIDE])
{
    memset(A, 0, sizeof(square));
    for (int i = 0; i < EX_Z; i++) {
        for (int j = 0; j < EX_Z; j++)
            A[i][j] = step * stretch->entry->M[j][i];
        A[i][ONE] = step * stretch->b[i];
    }
}

/* What exp(A) adds to 1, for a small A; `work` is written to. */
static void growth(const double (*A)[WIDE], double (*work)[WIDE], double (*to)[WIDE])
{
    memset(to, 0, sizeof(square));
    for (int k = BG_DEGREE; k > 0; k--) {
        for (int i = 0; i < WIDE; i++)
            to[i][i] += 1.0;
        multiply((const double(*)[WIDE])to, A, work);
        for (int i = 0; i < WIDE; i++)
            for (int j = 0; j < WIDE; j++)
                to[i][j] = work[i][j] / k;
    }
}

/* P of a short step from y on. */
static void short_step(const double (*A)[WIDE], const double *z, double step, double (*P)[WIDE])
{
    double terms[BG_DEGREE + 1][WIDE];
    memcpy(terms[0], z, sizeof(double) * EX_Z);
    terms[0][ONE] = 1.0;
    for (int k = 1; k <= BG_DEGREE; k++)
        for (int i = 0; i < WIDE; i++) {
            double sum = 0.0;
            for (int j = 0; j < WIDE; j++)
                sum += A[i][j] * terms[k - 1][j];
            terms[k][i] = sum / k;
        }
    memset(P, 0, sizeof(square));
    for (int node = 0; node < BATCH_NODES; node++) {
        double y[WIDE] = {0};
        for (int k = BG_DEGREE; k >= 0; k--)
            for (int i = 0; i < WIDE; i++)
                y[i] = y[i] * batch_nodes[node] + terms[k][i];
        for (int i = 0; i < WIDE; i++)
            for (int j = 0; j < WIDE; j++)
                P[i][j] += step * batch_weights[node] * y[i] * y[j];
    }
}

/* P and what E adds to 1, of twice the step. */
static void twice(double (*P)[WIDE], double (*added)[WIDE], double (*E)[WIDE], double (*work)[WIDE])
{
    memcpy(E, added, sizeof(square));
    for (int i = 0; i < WIDE; i++)
        E[i][i] += 1.0;
    multiply((const double(*)[WIDE])E, (const double(*)[WIDE])P, work);
    for (int i = 0; i < WIDE; i++)
        for (int j = 0; j < WIDE; j++)
            for (int l = 0; l < WIDE; l++)
                P[i][j] += work[i][l] * E[j][l];
    multiply((const double(*)[WIDE])added, (const double(*)[WIDE])added, work);
    for (int i = 0; i < WIDE; i++)
        for (int j = 0; j < WIDE; j++)
            added[i][j] = 2 * added[i][j] + work[i][j];
}

/* A row over y in the present stretch: a factor, or 1. */
static void row_of(const ex_context *c, const batch_room *room, int factor, double *row)
{
    const ex_mode *const mode = c->stretch.entry->mode;
    memset(row, 0, sizeof(double) * WIDE);
    row[ONE] = 1.0;
    if (factor >= 0)
        row[ONE] = batch_over_state(c, batch_readers(room, mode)[room->job->signals + factor], row);
}

static double between(const double *one, const double (*P)[WIDE], const double *other)
{
    double sum = 0.0;
    for (int i = 0; i < WIDE; i++)
        for (int j = 0; j < WIDE; j++)
            sum += one[i] * P[i][j] * other[j];
    return sum;
}

void batch_integrate(const ex_context *c, const batch_room *room, double t, const double *z,
                     double end)
{
    square *const squares = (square *)room->squares;
    double(*const P)[WIDE] = squares[0], (*const added)[WIDE] = squares[1];
    double(*const A)[WIDE] = squares[2], (*const work)[WIDE] = squares[3];
    double step = end - t;
    int doublings = 0;
    if (!(step > 0.0))
        return;
    for (; c->stretch.entry->norm * step > 1.0 && doublings < MOST_DOUBLINGS; step /= 2)
        doublings++;
    system_of(&c->stretch, step, A);
    short_step((const double(*)[WIDE])A, z, step, P);
    if (doublings)
        growth((const double(*)[WIDE])A, work, added);
    for (; doublings; doublings--)
        twice(P, added, A, work);
    for (int k = 0; k < room->job->products; k++) {
        double one[WIDE], other[WIDE];
        row_of(c, room, room->job->product[k].one, one);
        row_of(c, room, room->job->product[k].other, other);
        room->totals[k] += between(one, (const double(*)[WIDE])P, other);
    }
}
