/* Numbers in twice double precision: the unevaluated sum of a double and its rest.
 *
 * Products are calls of fma alone, so that no compiler can merge one with a sum behind it. */
#ifndef BG_PAIR_H
#define BG_PAIR_H

#include <math.h>

typedef struct {
    double hi, lo;
} bg_pair;

/* a + b */
static inline bg_pair bg_plus(bg_pair a, bg_pair b)
{
    const double sum = a.hi + b.hi, part = sum - a.hi;
    const double low = a.lo + b.lo, less = low - a.lo;
    const double rest = ((a.hi - (sum - part)) + (b.hi - part)) + low;
    const double least = (a.lo - (low - less)) + (b.lo - less);
    const double high = sum + rest;
    const double left = (rest - (high - sum)) + least;
    const double total = high + left;
    return (bg_pair){total, left - (total - high)};
}

/* a b */
static inline bg_pair bg_times(bg_pair a, bg_pair b)
{
    const double product = fma(a.hi, b.hi, 0.0);
    const double rest = fma(a.lo, b.hi, fma(a.hi, b.lo, fma(a.hi, b.hi, -product)));
    const double total = product + rest;
    return (bg_pair){total, rest - (total - product)};
}

/* a over a small number */
static inline bg_pair bg_over(double a, double b)
{
    const double quotient = a / b;
    return (bg_pair){quotient, fma(-quotient, b, a) / b};
}

#endif
