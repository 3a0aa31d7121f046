/* Numbers in twice double precision: the unevaluated sum of a double and its rest.
 *
 * Products are calls of fma alone, so that no compiler can merge one with a sum behind it. */
#ifndef BG_EXACT_PAIR_H
#define BG_EXACT_PAIR_H

#include <math.h>

typedef struct {
    double hi, lo;
} ex_pair;

/* a + b */
static inline ex_pair ex_plus(ex_pair a, ex_pair b)
{
    const double sum = a.hi + b.hi, part = sum - a.hi;
    const double low = a.lo + b.lo, less = low - a.lo;
    const double rest = ((a.hi - (sum - part)) + (b.hi - part)) + low;
    const double least = (a.lo - (low - less)) + (b.lo - less);
    const double high = sum + rest;
    const double left = (rest - (high - sum)) + least;
    const double total = high + left;
    return (ex_pair){total, left - (total - high)};
}

/* a b */
static inline ex_pair ex_times(ex_pair a, ex_pair b)
{
    const double product = fma(a.hi, b.hi, 0.0);
    const double rest = fma(a.lo, b.hi, fma(a.hi, b.lo, fma(a.hi, b.hi, -product)));
    const double total = product + rest;
    return (ex_pair){total, rest - (total - product)};
}

/* a over a small number */
static inline ex_pair ex_over(double a, double b)
{
    const double quotient = a / b;
    return (ex_pair){quotient, fma(-quotient, b, a) / b};
}

#endif
