/* Dense linear systems by rows: factors with pivots, products. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "model_internal.h"

static void swap_rows(int columns, double *a, double *b)
{
    for (int j = 0; j < columns; j++) {
        const double kept = a[j];
        a[j] = b[j];
        b[j] = kept;
    }
}

/* Below this fraction of the largest entry a pivot is rounding. */
static double negligible(int n, const double *a)
{
    return 2 * DBL_EPSILON * bg_largest(n * n, a);
}

/* a becomes its factors L (unit diagonal) and U; 0 if it has no inverse. */
int bg_factor(int n, double *a, int *pivots)
{
    const double least = negligible(n, a);
    for (int k = 0; k < n; k++) {
        int best = k;
        for (int i = k + 1; i < n; i++)
            if (fabs(a[i * n + k]) > fabs(a[best * n + k]))
                best = i;
        pivots[k] = best;
        if (!(fabs(a[best * n + k]) > least))
            return 0;
        if (best != k)
            swap_rows(n, a + k * n, a + best * n);
        for (int i = k + 1; i < n; i++) {
            double *row = a + i * n;
            const double factor = row[k] / a[k * n + k];
            row[k] = factor;
            if (factor == 0)
                continue;
            for (int j = k + 1; j < n; j++)
                row[j] -= factor * a[k * n + j];
        }
    }
    return 1;
}

static void subtract(int columns, double factor, const double *from, double *row)
{
    if (factor == 0)
        return;
    for (int j = 0; j < columns; j++)
        row[j] -= factor * from[j];
}

/* right, n rows of `columns`, becomes the solution. */
void bg_solve(int n, const double *a, const int *pivots, int columns, double *right)
{
    for (int k = 0; k < n; k++)
        if (pivots[k] != k)
            swap_rows(columns, right + k * columns, right + pivots[k] * columns);
    for (int i = 1; i < n; i++)
        for (int k = 0; k < i; k++)
            subtract(columns, a[i * n + k], right + k * columns, right + i * columns);
    for (int i = n - 1; i >= 0; i--) {
        double *row = right + i * columns;
        for (int k = i + 1; k < n; k++)
            subtract(columns, a[i * n + k], right + k * columns, row);
        for (int j = 0; j < columns; j++)
            row[j] /= a[i * n + i];
    }
}

/* a is lost; 0 if it has no inverse. Rows are scaled first. */
int bg_inverse(int n, double *a, int *pivots, double *inverse)
{
    for (int i = 0; i < n; i++) {
        const double largest = bg_largest(n, a + i * n);
        if (!(largest > 0) || !isfinite(largest))
            return 0;
        for (int j = 0; j < n; j++) {
            a[i * n + j] /= largest;
            inverse[i * n + j] = i == j ? 1.0 / largest : 0.0;
        }
    }
    if (!bg_factor(n, a, pivots))
        return 0;
    bg_solve(n, a, pivots, n, inverse);
    return 1;
}

/* y += a x */
void bg_multiply_add(int rows, int columns, const double *a, const double *x, double *y)
{
    for (int i = 0; i < rows; i++) {
        double sum = 0.0;
        for (int j = 0; j < columns; j++)
            sum += a[i * columns + j] * x[j];
        y[i] += sum;
    }
}

void bg_list_entries(int rows, int columns, const double *a, int room, int *list)
{
    int end = rows + 1;
    for (int i = 0; i < rows && room > 1; i++) {
        list[i] = end;
        for (int j = 0; j < columns; j++)
            if (a[i * columns + j] != 0.0) {
                if (end == room) {
                    list[0] = 0;
                    return;
                }
                list[end++] = j;
            }
    }
    list[room > 1 ? rows : 0] = room > 1 ? end : 0;
}

void bg_multiply_listed(int rows, int columns, const double *a, const int *list, const double *x,
                        double *y)
{
    if (!list[0]) {
        bg_multiply_add(rows, columns, a, x, y);
        return;
    }
    for (int i = 0; i < rows; i++) {
        const double *const row = a + i * columns;
        double sum = 0.0;
        for (int k = list[i]; k < list[i + 1]; k++)
            sum += row[list[k]] * x[list[k]];
        y[i] += sum;
    }
}

int bg_finite(int count, const double *values)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(values[i]))
            return 0;
    return 1;
}

double bg_largest(int count, const double *values)
{
    double most = 0.0;
    for (int i = 0; i < count; i++)
        most = fabs(values[i]) > most ? fabs(values[i]) : most; /* what is no number is not */
    return most;
}

double *bg_put(double *to, int count, const double *from)
{
    memcpy(to, from, sizeof(double) * (size_t)count);
    return to + count;
}
