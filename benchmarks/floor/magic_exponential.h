/* Exponential Adams-Bashforth steps of order 8: what is linear is exact, the rest of the tires'
 * torques goes on as the polynomial of degree 7 through its latest eight values. M. Hochbruck,
 * A. Ostermann, Exponential integrators, Acta Numerica 19, 2010, pages 209-286. */
#ifndef MAGIC_EXPONENTIAL_H
#define MAGIC_EXPONENTIAL_H

#include "magic_steps.h"

/* So much may a sub-step times a tire's slope change before exponentials are made anew: with more,
 * runs on the stiffest shafts whose clutch keeps slipping err by more than 1e-6 of range. */
#define MAGIC_CHANGE 0.007

/* A sub-step: E z + constant + the sum of weight[j][w] times what was left of tire w's torque j
 * sub-steps ago, for tires of these slopes, in this mode, under these demands; all by columns. */
typedef struct {
    magic_vector E[N], constant, weight[HISTORY][2];
    double slope[2], demand[2];
    int mode;
} magic_weights;

/* Slopes of tires where the wheels are, over their inertia [1/s]. */
static inline void magic_slopes(const magic_system *s, const double *wheel, double *slope)
{
    for (int j = 0; j < 2; j++)
        slope[j] = s->wheel_inverse * s->scale[j] * magic_slope(s, s->scale[j] * wheel[j]);
}

/* Whether they are another mode's or other demands'. */
static inline int magic_stale(const magic_run *run, const magic_weights *w)
{
    return run->mode != w->mode || run->demand[0] != w->demand[0]
           || run->demand[1] != w->demand[1];
}

/* Weights at the run's mode, demands and speeds; 0, or -1 where sub-steps are too long for them. */
int magic_weigh(magic_run *run, magic_weights *w);

#endif
