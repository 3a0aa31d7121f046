/* The weights of exponential steps: functions of a matrix, times factors of a polynomial. */
#include <math.h>
#include <string.h>

#include "lanes_weights.h"

/* From a norm of 2.5 on a series of so many terms is not exact to rounding. */
enum { TERMS = 20, SWEEPS = 4 };
static const double LARGEST = 2.5;

typedef double square[BG_SIZE][BG_SIZE];

void bg_derivatives(double at, int count, const double *nodes, double (*factor)[LANE_NODES])
{
    double before = 1.0, to = nodes[0] - at;
    memset(factor, 0, sizeof *factor * (size_t)count);
    factor[0][0] = 1.0;
    for (int i = 1; i < count; i++) {
        const double last = to;
        double all = 1.0;
        to = nodes[i] - at;
        for (int j = 0; j < i; j++) {
            const double apart = nodes[i] - nodes[j];
            all *= apart;
            for (int p = i; p >= 0 && j == i - 1; p--)
                factor[p][i] = before / all * ((p ? p * factor[p - 1][j] : 0.0) - last * factor[p][j]);
            for (int p = i; p >= 0; p--)
                factor[p][j] = (to * factor[p][j] - (p ? p * factor[p - 1][j] : 0.0)) / apart;
        }
        before = all;
    }
}

/* The largest sum of a row's sizes, with states scaled so that rows and columns are alike. */
static double balanced_norm(const square M)
{
    square size;
    double norm = 0.0;
    for (int i = 0; i < BG_SIZE; i++)
        for (int j = 0; j < BG_SIZE; j++)
            size[i][j] = fabs(M[i][j]);
    for (int k = 0; k < SWEEPS * BG_SIZE; k++) {
        const int i = k % BG_SIZE;
        double row = 0.0, column = 0.0;
        for (int j = 0; j < BG_SIZE; j++) {
            row += j == i ? 0.0 : size[i][j];
            column += j == i ? 0.0 : size[j][i];
        }
        const double scale = row > 0.0 && column > 0.0 ? sqrt(row / column) : 1.0;
        for (int j = 0; j < BG_SIZE; j++) {
            size[i][j] /= j == i ? 1.0 : scale;
            size[j][i] *= j == i ? 1.0 : scale;
        }
    }
    for (int i = 0; i < BG_SIZE; i++) {
        double row = 0.0;
        for (int j = 0; j < BG_SIZE; j++)
            row += size[i][j];
        norm = row <= norm ? norm : row;
    }
    return norm;
}

/* to = M of + part I */
static void times_plus(const square M, const square of, double part, square to)
{
    for (int i = 0; i < BG_SIZE; i++) {
        double row[BG_SIZE] = {0};
        row[i] = part;
        for (int l = 0; l < BG_SIZE; l++)
            for (int j = 0; j < BG_SIZE; j++)
                row[j] += M[i][l] * of[l][j];
        memcpy(to[i], row, sizeof row);
    }
}

/* The sums of M^l / (l + q)! for q = 0, 1, .. LANE_NODES: the last as a series, of which each other
 * is M times the next plus I / q!. */
static void functions_of(const square M, square *phi)
{
    double inverse[TERMS + LANE_NODES + 1] = {1.0};
    for (int l = 1; l <= TERMS + LANE_NODES; l++)
        inverse[l] = inverse[l - 1] / l;
    memset(phi[LANE_NODES], 0, sizeof *phi);
    for (int l = TERMS; l >= 0; l--) {
        square next;
        times_plus(M, phi[LANE_NODES], inverse[l + LANE_NODES], next);
        memcpy(phi[LANE_NODES], next, sizeof next);
    }
    for (int q = LANE_NODES - 1; q >= 0; q--)
        times_plus(M, phi[q + 1], inverse[q], phi[q]);
}

/* h times the sum of so many functions, from the first on, each times its factor. */
static void add_up(square *phi, int count, const double (*factor)[LANE_NODES], int node, double h,
                   double *sum)
{
    for (int k = 0; k < BG_SIZE * BG_SIZE; k++)
        sum[k] = 0.0;
    for (int p = 0; p < count; p++)
        for (int k = 0; k < BG_SIZE * BG_SIZE; k++)
            sum[k] += h * factor[p][node] * phi[p + 1][k / BG_SIZE][k % BG_SIZE];
}

int bg_lanes_weigh(const double *slope, double h, bg_lane_weights *found)
{
    double nodes[LANE_NODES], factor[LANE_NODES][LANE_NODES];
    square M, phi[LANE_NODES + 1];
    for (int k = 0; k < BG_SIZE * BG_SIZE; k++)
        M[k / BG_SIZE][k % BG_SIZE] = h * slope[k];
    if (!(balanced_norm(M) <= LARGEST))
        return 0;
    functions_of(M, phi);
    memcpy(found->E, phi[0], sizeof found->E);
    for (int j = 0; j < LANE_NODES; j++)
        nodes[j] = 1.0 - j;
    bg_derivatives(0.0, LANE_NODES, nodes, factor);
    add_up(phi, LANE_NODES, (const double(*)[LANE_NODES])factor, 0, h, found->correction);
    bg_derivatives(0.0, LANE_PAST, nodes + 1, factor);
    for (int j = 0; j < LANE_PAST; j++)
        add_up(phi, LANE_PAST, (const double(*)[LANE_NODES])factor, j, h, found->weight[j]);
    return 1;
}

void bg_lanes_ahead(double *of)
{
    double nodes[LANE_PAST], factor[LANE_NODES][LANE_NODES];
    for (int j = 0; j < LANE_PAST; j++)
        nodes[j] = -j;
    bg_derivatives(1.0, LANE_PAST, nodes, factor);
    memcpy(of, factor[0], sizeof nodes);
}
