/* External inputs over time: sums of polynomials times exponentials. */
#ifndef BG_MODEL_SIGNALS_H
#define BG_MODEL_SIGNALS_H

#include "model_runtime.h"

/* The real part of a polynomial times an exponential, p(tau) exp(rate tau), tau = t - start; the
 * polynomial's `count` coefficients begin at place `first`, real and imaginary parts. */
typedef struct {
    int input, first, count;
    double start, rate[2];
} bg_term;

/* External inputs as sums of terms. Segment k lasts to breaks[k], the last one for ever; its terms
 * are those from begins[k] up to begins[k + 1]. `fastest` [1/s]: the largest rate in a segment. */
typedef struct {
    int segments;
    const double *breaks; /* segments - 1 times, increasing */
    const int *begins;    /* segments + 1 places */
    const bg_term *terms;
    const double (*coefficients)[2];
    const double *fastest;
} bg_signals;

/* Below this a value is rounding of terms that cancel: of so large a sum of magnitudes, which an
 * eighth of the time's rounding, too, changes with this slope. */
double bg_cancelled(double size, double slope, double time);

/* Adds a term's value and slope at t. */
void bg_term_add(const bg_term *term, const double (*coefficients)[2], double t, double *value,
                 double *slope);

/* The segment that holds at t and just after; inputs and their rates at t in a segment. */
int bg_signals_segment(const bg_signals *signals, double t);
void bg_signals_at(const bg_signals *signals, int segment, double t, double *w, double *dw);

#endif
