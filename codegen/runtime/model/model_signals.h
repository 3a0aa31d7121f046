/* External inputs over time: sums of polynomials times exponentials. */
#ifndef BG_MODEL_SIGNALS_H
#define BG_MODEL_SIGNALS_H

#include "model_runtime.h"
#include "run_pace.h"

/* The real part of a polynomial times an exponential, p(tau) exp(rate tau), tau = t - start; the
 * polynomial's `count` coefficients begin at place `first`, real and imaginary parts. */
typedef struct {
    int input, first, count;
    double start, rate[2];
} bg_term;

/* A part of a wave's period: where it begins, in periods; terms from place `first` on, whose starts
 * are where it begins. */
typedef struct {
    int first, count;
    double fraction;
} bg_part;

/* What repeats: period k begins at (k + phase) / frequency, a part of it at
 * (k + (phase + fraction)) / frequency. `duty`: -1, or the input of `duties` that says at each
 * period's start where the second of two parts begins. `fastest` [1/s]: the largest rate. */
typedef struct {
    int first, parts, duty;
    double frequency, phase, fastest;
} bg_wave;

/* External inputs as sums of terms. Segment k lasts to breaks[k], the last one for ever; its terms
 * are those from begins[k] up to begins[k + 1]. `fastest` [1/s]: the largest rate in a segment. The
 * terms of waves come on top, those of their `parts` in `terms` behind all segments'. */
typedef struct bg_signals {
    int segments;
    const double *breaks; /* segments - 1 times, increasing */
    const int *begins;    /* segments + 1 places */
    const bg_term *terms;
    const double (*coefficients)[2];
    const double *fastest;
    int waves;
    const bg_wave *wave;
    const bg_part *parts;
    const struct bg_signals *duties; /* one input for each wave that has a duty */
} bg_signals;

/* Below this a value is rounding of terms that cancel: of so large a sum of magnitudes, which an
 * eighth of the time's rounding, too, changes with this slope. */
double bg_cancelled(double size, double slope, double time);

/* Adds a term's value and slope at t. */
void bg_term_add(const bg_term *term, const double (*coefficients)[2], double t, double *value,
                 double *slope);

/* The time up to which breakpoints count as reached at t: times are sums of steps. */
double bg_reached(double t);

/* The pieces that hold at t and just after; their largest rate; inputs and their rates at t. */
bg_span bg_signals_span(const bg_signals *signals, double t);
double bg_signals_fastest(const bg_signals *signals, const bg_span *span);
void bg_signals_at(const bg_signals *signals, const bg_span *span, double t, double *w, double *dw);

/* model_waves.c: the part of a wave that holds at t, and when it began; when the next begins. */
int bg_wave_part(const bg_signals *signals, const bg_wave *wave, double t, double *begin);
double bg_wave_following(const bg_signals *signals, const bg_wave *wave, double t);

/* Input `at` alone at t. */
double bg_signals_one(const bg_signals *signals, int at, double t);

#endif
