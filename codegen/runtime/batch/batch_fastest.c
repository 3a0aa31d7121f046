/* How fast the states of a mode are by themselves. */
#include "batch_internal.h"

#include <math.h>
#include <string.h>

enum { SQUARES = 3 };

/* The largest magnitude. */
static double largest_rate_of(double (*matrix)[EX_N])
{
    double most[EX_N] = {0}, size = 0.0;
    for (int i = 0; i < EX_N; i++)
#pragma GCC unroll 1
        for (int j = 0; j < EX_N; j++)
            most[j] = bg_greater(fabs(matrix[i][j]), most[j]);
    for (int j = 0; j < EX_N; j++)
        size = bg_greater(most[j], size);
    return size;
}

static void squared(double (*restrict matrix)[EX_N], double factor, double (*restrict to)[EX_N])
{
    for (int i = 0; i < EX_N; i++)
#pragma GCC unroll 1
        for (int j = 0; j < EX_N; j++) {
            double sum = 0.0;
#pragma GCC unroll 32
            for (int l = 0; l < EX_N; l++)
                sum += matrix[i][l] * matrix[l][j];
            to[i][j] = factor * sum;
        }
}

/* The largest magnitude of an eigenvalue, nearly: from a high power of a balanced matrix. It is
 * scaled at every second square only. */
static double spectral_radius(double (*matrix)[EX_N])
{
    double power[EX_N][EX_N], other[EX_N][EX_N];
    double size = largest_rate_of(matrix), logarithm = 0.0, share = 1.0;
    memcpy(power, matrix, sizeof power);
    for (int k = 0; k < SQUARES && size > 0.0; k++) {
        const double shrink = 1.0 / size;
        logarithm += share * log(size);
        share /= 4;
        squared(power, shrink * shrink, other);
        squared(other, 1.0, power);
        size = largest_rate_of(power);
    }
    return size > 0.0 ? exp(logarithm + share * log(size)) : 0.0;
}

/* One over the scales, powers of 2, that make rows and columns alike. */
static void balance_rates(double (*matrix)[EX_N], double *weight)
{
    double scale[EX_N];
    for (int i = 0; i < EX_N; i++)
        weight[i] = scale[i] = 1.0;
    for (int changed = 1, turn = 0; changed && turn < 50; turn++) {
        changed = 0;
        for (int i = 0; i < EX_N; i++) {
            double row = 0.0, column = 0.0, factor = 1.0;
            for (int j = 0; j < EX_N; j++) {
                row += j == i ? 0.0 : fabs(matrix[i][j]) * scale[j];
                column += j == i ? 0.0 : fabs(matrix[j][i]) * weight[j];
            }
            row *= weight[i];
            column *= scale[i];
            if (!(row > 0.0 && column > 0.0) || !isfinite(row + column))
                continue;
            const double before = row + column;
            for (; column < row / 2; column *= 2, row /= 2)
                factor *= 2;
            for (; column >= row * 2; column /= 2, row *= 2)
                factor /= 2;
            if (row + column < 0.95 * before) {
                weight[i] /= factor;
                scale[i] *= factor;
                changed = 1;
            }
        }
    }
}

double batch_fastest(double (*own)[EX_N], double *weight)
{
    balance_rates(own, weight);
    for (int i = 0; i < EX_N; i++)
        for (int j = 0; j < EX_N; j++)
            own[i][j] *= weight[i] / weight[j];
    return spectral_radius(own);
}
