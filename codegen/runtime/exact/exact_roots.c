/* Where a polynomial on the unit interval first falls to zero, decided by Bernstein coefficients. */
#include "exact_internal.h"

#include <math.h>
#include <string.h>

enum { EX_MOST_PARTS = 4000, EX_DEEP = 64, EX_TRIES = 160 };

double ex_value(const double *p, double tau)
{
    double sum = p[BG_DEGREE];
    for (int k = BG_DEGREE - 1; k >= 0; k--)
        sum = sum * tau + p[k];
    return sum;
}

static double slope(const double *p, double tau)
{
    double sum = BG_DEGREE * p[BG_DEGREE];
    for (int k = BG_DEGREE - 1; k > 0; k--)
        sum = sum * tau + k * p[k];
    return sum;
}

/* The Bernstein coefficients over [low, high]. */
static void shape(const double *p, double low, double high, double *b)
{
    double factor = 1.0;
    memcpy(b, p, (BG_DEGREE + 1) * sizeof *b);
    if (low > 0.0)
        for (int k = 0; k < BG_DEGREE; k++)
            for (int j = BG_DEGREE - 1; j >= k; j--)
                b[j] += low * b[j + 1];
    for (int k = 1; k <= BG_DEGREE; k++) {
        /* over the binomial coefficient */
        factor *= (high - low) * k / (BG_DEGREE + 1 - k);
        b[k] *= factor;
    }
    for (int k = 1; k <= BG_DEGREE; k++)
        for (int j = BG_DEGREE; j >= k; j--)
            b[j] += b[j - 1];
}

/* The root where p falls from low to high: Newton, kept inside. */
static double polish(const double *p, double low, double high)
{
    if (ex_value(p, low) <= 0)
        return low;
    if (ex_value(p, high) > 0)
        return high;
    double t = 0.5 * (low + high);
    for (int tries = 0; tries < EX_TRIES; tries++) {
        const double at = ex_value(p, t);
        if (at > 0)
            low = t;
        else
            high = t;
        double next = t - at / slope(p, t);
        /* Newton crawls along a root of many folds: halves in turn with it end there, too. */
        if (!(next >= low && next <= high) || (tries > 8 && tries % 2))
            next = 0.5 * (low + high);
        if (fabs(next - t) <= BG_POLISHED * t || high - low <= BG_HALVED * high)
            return next;
        t = next;
    }
    return t;
}

/* What the coefficients tell: the least, whether they all fall, whether none does. */
static void judge(const double *b, double *least, int *falls, int *rises)
{
    *least = b[0];
    *falls = *rises = 1;
    for (int k = 1; k <= BG_DEGREE; k++) {
        *least = bg_lesser(*least, b[k]);
        *falls &= b[k] < b[k - 1];
        *rises &= b[k] >= b[k - 1];
    }
}

/* Whether a polynomial is above zero on all of the interval by its cubic part alone. */
static int clear(const double *p)
{
    const double b1 = p[0] + p[1] / 3.0, b2 = b1 + (p[1] + p[2]) / 3.0;
    double rest = 0.0;
    for (int k = 4; k <= BG_DEGREE; k++)
        rest += fabs(p[k]);
    const double ends = bg_lesser(p[0], p[0] + p[1] + p[2] + p[3]);
    return bg_lesser(ends, bg_lesser(b1, b2)) > rest;
}

int ex_first_fall(const double *p, double begin, double *root)
{
    if (clear(p))
        return 0;
    double lows[EX_DEEP], highs[EX_DEEP], b[BG_DEGREE + 1], least;
    int pending = 1, falls, rises;
    lows[0] = begin;
    highs[0] = 1.0;
    for (int parts = 0; pending > 0; parts++) {
        if (parts >= EX_MOST_PARTS || pending > EX_DEEP - 2)
            return -1;
        const double low = lows[--pending], high = highs[pending];
        shape(p, low, high, b);
        judge(b, &least, &falls, &rises);
        if (least > 0 || (!falls && rises) || (falls && b[BG_DEGREE] > 0))
            continue;
        if (falls) {
            *root = polish(p, low, high);
            return 1;
        }
        if (high - low <= BG_NARROW) {
            if (b[BG_DEGREE] > 0)
                continue;
            *root = high;
            return 1;
        }
        lows[pending] = 0.5 * (low + high);
        highs[pending++] = high;
        highs[pending] = lows[pending - 1];
        lows[pending++] = low;
    }
    return 0;
}
