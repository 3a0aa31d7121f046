/* The weights of exponential steps: functions of a matrix, times factors of a polynomial. */
#include <math.h>
#include <string.h>

#include "lanes_weights.h"

/* From a norm of 2.5 on a series of so many terms is not exact to rounding. */
enum { WEIGH_TERMS = 20, WEIGH_SWEEPS = 4 };
static const double LARGEST = 2.5;

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
            for (int p = i; p >= 0 && j == i - 1; p--) {
                const double lower = p ? p * factor[p - 1][j] : 0.0;
                factor[p][i] = before / all * (lower - last * factor[p][j]);
            }
            for (int p = i; p >= 0; p--)
                factor[p][j] = (to * factor[p][j] - (p ? p * factor[p - 1][j] : 0.0)) / apart;
        }
        before = all;
    }
}

/* The largest sum of a column's sizes, with states scaled so that rows and columns are alike. */
static double weigh_norm(const bg_lane_columns M)
{
    double size[BG_SIZE][BG_SIZE], norm = 0.0;
    for (int i = 0; i < BG_SIZE; i++)
        for (int j = 0; j < BG_SIZE; j++)
            size[i][j] = fabs(M[i][j]);
    for (int k = 0; k < WEIGH_SWEEPS * BG_SIZE; k++) {
        const int i = k % BG_SIZE;
        double one = 0.0, other = 0.0;
        for (int j = 0; j < BG_SIZE; j++) {
            one += j == i ? 0.0 : size[i][j];
            other += j == i ? 0.0 : size[j][i];
        }
        const double scale = one > 0.0 && other > 0.0 ? sqrt(one / other) : 1.0;
        for (int j = 0; j < BG_SIZE; j++) {
            size[i][j] /= j == i ? 1.0 : scale;
            size[j][i] *= j == i ? 1.0 : scale;
        }
    }
    for (int i = 0; i < BG_SIZE; i++) {
        double sum = 0.0;
        for (int j = 0; j < BG_SIZE; j++)
            sum += size[i][j];
        norm = sum <= norm ? norm : sum;
    }
    return norm;
}

/* to = M of + part I; functions of one matrix do not mind the order of factors. */
static void weigh_times_plus(const bg_lane_columns M, const bg_lane_columns of, double part,
                             bg_lane_columns to)
{
    for (int j = 0; j < BG_SIZE; j++) {
        double column[LANE_ROW] = {0};
        column[j] = part;
        bg_lanes_add_product(M, of[j], column);
        memcpy(to[j], column, sizeof column);
    }
}

/* The last function as a series, each other as M times the next plus I / q!. */
int bg_lanes_functions(const double *slope, double h, bg_lane_functions *found)
{
    double inverse[WEIGH_TERMS + LANE_NODES + 1] = {1.0};
    bg_lane_columns M = {{0}};
    found->h = h;
    for (int k = 0; k < BG_SIZE * BG_SIZE; k++)
        M[k % BG_SIZE][k / BG_SIZE] = h * slope[k];
    if (!(weigh_norm(M) <= LARGEST))
        return 0;
    for (int l = 1; l <= WEIGH_TERMS + LANE_NODES; l++)
        inverse[l] = inverse[l - 1] / l;
    memset(found->of[LANE_NODES], 0, sizeof M);
    for (int l = WEIGH_TERMS; l >= 0; l--) {
        bg_lane_columns next;
        weigh_times_plus(M, found->of[LANE_NODES], inverse[l + LANE_NODES], next);
        memcpy(found->of[LANE_NODES], next, sizeof next);
    }
    for (int q = LANE_NODES - 1; q >= 0; q--)
        weigh_times_plus(M, found->of[q + 1], inverse[q], found->of[q]);
    return 1;
}

static void weigh_pack(const bg_lane_columns of, double *found)
{
    for (int k = 0; k < BG_SIZE * BG_SIZE; k++)
        found[k] = of[k % BG_SIZE][k / BG_SIZE];
}

/* h times the sum of so many functions, from the first on, each times its factor. */
static void weigh_add_up(const bg_lane_functions *functions, int count,
                         const double (*factor)[LANE_NODES], int node, double *found)
{
    bg_lane_columns sum = {{0}};
    for (int p = 0; p < count; p++)
        for (int i = 0; i < BG_SIZE; i++)
            for (int j = 0; j < LANE_ROW; j++)
                sum[i][j] += functions->h * factor[p][node] * functions->of[p + 1][i][j];
    weigh_pack(sum, found);
}

void bg_lanes_weigh(const bg_lane_functions *functions, bg_lane_weights *found)
{
    double nodes[LANE_NODES], factor[LANE_NODES][LANE_NODES];
    weigh_pack(functions->of[0], found->E);
    for (int j = 0; j < LANE_NODES; j++)
        nodes[j] = 1.0 - j;
    bg_derivatives(0.0, LANE_NODES, nodes, factor);
    weigh_add_up(functions, LANE_NODES, (const double(*)[LANE_NODES])factor, 0, found->correction);
    bg_derivatives(0.0, LANE_PAST, nodes + 1, factor);
    for (int j = 0; j < LANE_PAST; j++)
        weigh_add_up(functions, LANE_PAST, (const double(*)[LANE_NODES])factor, j,
                     found->weight[j]);
}

void bg_lanes_ahead(double *of)
{
    double nodes[LANE_PAST], factor[LANE_NODES][LANE_NODES];
    for (int j = 0; j < LANE_PAST; j++)
        nodes[j] = -j;
    bg_derivatives(1.0, LANE_PAST, nodes, factor);
    memcpy(of, factor[0], sizeof nodes);
}
