/* Exponential steps of a fixed length h with a slope L: y' = L y + r(t), r a polynomial through its
 * latest values (exponential Adams-Bashforth, corrected once). */
#ifndef BG_LANES_WEIGHTS_H
#define BG_LANES_WEIGHTS_H

#include "model_internal.h"

/* So many of the latest values make a polynomial; with the one that is corrected, nodes. */
enum { LANE_PAST = 6, LANE_NODES = LANE_PAST + 1 };

/* What a step's end is: E y + sum of weight[j] r[j], newest first; plus `correction` times what r is
 * there more than the polynomial's. */
typedef struct {
    double E[BG_SIZE * BG_SIZE], weight[LANE_PAST][BG_SIZE * BG_SIZE];
    double correction[BG_SIZE * BG_SIZE];
} bg_lane_weights;

/* The factors of values at so many nodes in each derivative of their polynomial at a place, from
 * the 0th on (Fornberg, Generation of finite difference formulas on arbitrarily spaced grids,
 * Mathematics of Computation 51, 1988). */
void bg_derivatives(double at, int count, const double *nodes, double (*factor)[LANE_NODES]);

/* The weights of a step; 0 where it is too long for the slope. */
int bg_lanes_weigh(const double *slope, double h, bg_lane_weights *found);

/* The polynomial's value one step ahead: factors of the latest values. */
void bg_lanes_ahead(double *factor);

#endif
