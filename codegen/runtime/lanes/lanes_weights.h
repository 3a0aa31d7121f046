/* Exponential steps of a fixed length h with a slope L: y' = L y + r(t), r a polynomial through its
 * latest values (exponential Adams-Bashforth, corrected once). */
#ifndef BG_LANES_WEIGHTS_H
#define BG_LANES_WEIGHTS_H

#include "model_internal.h"

/* So many of the latest values make a polynomial; with the one that is corrected, nodes. */
enum { LANE_PAST = 6, LANE_NODES = LANE_PAST + 1, LANE_ROW = (BG_SIZE + 7) / 8 * 8 };

/* The sums of M^l / (l + q)! for q = 0, 1, .. LANE_NODES, where M is h times the slope: column by
 * column, each as long as vectors are, and zero beyond its numbers. */
typedef double bg_lane_columns[BG_SIZE][LANE_ROW];
typedef struct {
    double h;
    bg_lane_columns of[LANE_NODES + 1];
} bg_lane_functions;

/* What a step's end is: E y + sum of weight[j] r[j], newest first; plus `correction` times what r
 * is there more than the polynomial's. */
typedef struct {
    double E[BG_SIZE * BG_SIZE], weight[LANE_PAST][BG_SIZE * BG_SIZE];
    double correction[BG_SIZE * BG_SIZE];
} bg_lane_weights;

/* The factors of values at so many nodes in each derivative of their polynomial at a place, from
 * the 0th on (Fornberg, Generation of finite difference formulas on arbitrarily spaced grids,
 * Mathematics of Computation 51, 1988). */
void bg_derivatives(double at, int count, const double *nodes, double (*factor)[LANE_NODES]);

/* The functions of a step; 0 where it is too long for the slope. Its weights. */
int bg_lanes_functions(const double *slope, double h, bg_lane_functions *found);
void bg_lanes_weigh(const bg_lane_functions *functions, bg_lane_weights *found);

/* sum += matrix times of */
static inline void bg_lanes_add_product(const bg_lane_columns columns, const double *of,
                                        double *sum)
{
    double total[LANE_ROW];
    for (int k = 0; k < LANE_ROW; k++)
        total[k] = sum[k];
    for (int j = 0; j < BG_SIZE; j++)
        for (int k = 0; k < LANE_ROW; k++)
            total[k] += columns[j][k] * of[j];
    for (int k = 0; k < LANE_ROW; k++)
        sum[k] = total[k];
}

/* The polynomial's value one step ahead: factors of the latest values. */
void bg_lanes_ahead(double *factor);

#endif
