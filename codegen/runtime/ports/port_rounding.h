/* What counts as zero at friction ports: the rounding to be expected, from the magnitude of the
 * terms that cancel, and of the time's. */
#ifndef BG_PORT_ROUNDING_H
#define BG_PORT_ROUNDING_H

#include <float.h>
#include <math.h>

#include "port_choose.h"
#include "run_extremes.h"

/* Magnitudes of matrices, by columns: of slips by states (F) and inputs (D); of what moves them
 * (FP, FQ); of the rates of states (P, Q). `inertia`: how a port's own effort moves its slip. */
typedef struct {
    double *F, *D, *FP, *FQ, *P, *Q, *inertia;
} bg_magnitudes;

/* The near values of `count` ports whose others are known, from the largest magnitudes x, u seen,
 * where `time` is the shortest time constant; `rate` is room for the states. In line, so that sizes
 * are known when it is compiled. */
static inline void bg_round_ports(int states, int inputs, int count, const bg_magnitudes *a,
                                  double t, double time, const double *x, const double *u,
                                  double *rate, bg_port *ports)
{
    const double spacing = nextafter(fabs(t), INFINITY) - fabs(t);
    double slip[BG_MOST_PORTS] = {0}, moved[BG_MOST_PORTS] = {0};
    for (int i = 0; i < states; i++)
        rate[i] = 0.0;
    for (int j = 0; j < states; j++) {
        for (int i = 0; i < count; i++)
            slip[i] += a->F[j * count + i] * x[j];
        for (int i = 0; i < states; i++)
            rate[i] += a->P[j * states + i] * x[j];
    }
    for (int j = 0; j < inputs; j++) {
        for (int i = 0; i < count; i++) {
            slip[i] += a->D[j * count + i] * u[j];
            moved[i] += a->FQ[j * count + i] * u[j];
        }
        for (int i = 0; i < states; i++)
            rate[i] += a->Q[j * states + i] * u[j];
    }
    /* At rest states are rounding themselves: of what moves them within a time constant. */
    for (int j = 0; j < states; j++)
        for (int i = 0; i < count; i++)
            moved[i] += a->FP[j * count + i] * bg_greater(x[j], time * rate[j]);
    for (int i = 0; i < count; i++) {
        const double driven = a->inertia[i] > 0.0 ? moved[i] / a->inertia[i] : 0.0;
        const double late = BG_LATE * spacing * fabs(ports[i].push);
        const double effort = fabs(ports[i].effort) + ports[i].cap;
        ports[i].near_slip = BG_ROUNDING * (slip[i] + moved[i] * time) + late + DBL_MIN;
        ports[i].near_effort = BG_ROUNDING * (effort + driven) + DBL_MIN;
        ports[i].near_push = BG_ROUNDING * BG_PUSHES * moved[i] + DBL_MIN;
    }
}

/* Of a jump of second order, where `inertia` is how its effort moves its slip: what counts as zero
 * of what it hangs on, whose terms have been so large; and slips that leap no higher than that, by
 * v^2/2 over what its whole height throws back. */
static inline void bg_count_leaps(bg_port *port, double terms, double inertia, double spacing)
{
    port->near_gap = BG_TOGETHER * terms + BG_LATE * spacing * fabs(port->slip) + DBL_MIN;
    port->unseen = sqrt(2.0 * BG_LEAP * port->near_gap * inertia * port->cap) / BG_WIDE;
    port->near_slip = bg_greater(port->near_slip, port->unseen);
}

/* Below this the gap of a stop counts as closed, where its displacement, which changes at a rate,
 * has been as far as `seen`; `spacing`: of the time. */
static inline double bg_gap_rounding(const bg_switch *s, double gap, double displacement,
                                     double rate, double seen, double spacing)
{
    const double size = fabs(displacement), fixed = fabs(gap - s->opening * displacement);
    return BG_ROUNDING * (size + fixed) + BG_LATE * spacing * fabs(rate)
        + BG_TOGETHER * bg_greater(size, seen) + DBL_MIN;
}

#endif
