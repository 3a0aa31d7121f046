/* Where a polynomial on the unit interval first falls to zero, decided by Bernstein coefficients. */
#include "exact_internal.h"

#include <math.h>
#include <string.h>

enum { EX_MOST_PARTS = 4000, EX_DEEP = 64, EX_TRIES = 160 };

double ex_value(const ex_powers *p, double tau)
{
    double sum = p->at[p->degree];
    for (int k = p->degree - 1; k >= 0; k--)
        sum = sum * tau + p->at[k];
    return sum;
}

/* The same, its slope, and half of what changes that. */
static void values(const ex_powers *p, double tau, double *v)
{
    v[0] = p->at[p->degree];
    v[1] = v[2] = 0.0;
    for (int k = p->degree - 1; k >= 0; k--) {
        v[2] = v[2] * tau + v[1];
        v[1] = v[1] * tau + v[0];
        v[0] = v[0] * tau + p->at[k];
    }
}

/* The Bernstein coefficients over [low, high]. */
static void shape(const ex_powers *p, double low, double high, double *b)
{
    const int degree = p->degree;
    double factor = 1.0;
    memcpy(b, p->at, (size_t)(degree + 1) * sizeof *b);
    if (low > 0.0)
        for (int k = 0; k < degree; k++)
            for (int j = degree - 1; j >= k; j--)
                b[j] += low * b[j + 1];
    for (int k = 1; k <= degree; k++) {
        /* over the binomial coefficient */
        factor *= (high - low) * k / (degree + 1 - k);
        b[k] *= factor;
    }
    for (int k = 1; k <= degree; k++)
        for (int j = degree; j >= k; j--)
            b[j] += b[j - 1];
}

/* The root where p falls from low to high: Newton, kept inside, from where a line would fall. */
static double polish(const ex_powers *p, double low, double high)
{
    const double above = ex_value(p, low), below = ex_value(p, high);
    if (above <= 0)
        return low;
    if (below > 0)
        return high;
    double t = low + (high - low) * (above / (above - below));
    for (int tries = 0; tries < EX_TRIES; tries++) {
        double v[3];
        values(p, t, v);
        if (v[0] > 0)
            low = t;
        else
            high = t;
        double next = t - v[0] / v[1];
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
static void judge(int degree, const double *b, double *least, int *falls, int *rises)
{
    *least = b[0];
    *falls = *rises = 1;
    for (int k = 1; k <= degree; k++) {
        *least = bg_lesser(*least, b[k]);
        *falls &= b[k] < b[k - 1];
        *rises &= b[k] >= b[k - 1];
    }
}

/* Between what a cubic is on all of the interval, by its Bernstein coefficients. */
static void enclose(double p0, double p1, double p2, double p3, double *least, double *most)
{
    const double b1 = p0 + p1 / 3.0, b2 = b1 + (p1 + p2) / 3.0, b3 = p0 + p1 + p2 + p3;
    *least = bg_lesser(bg_lesser(p0, b3), bg_lesser(b1, b2));
    *most = bg_greater(bg_greater(p0, b3), bg_greater(b1, b2));
}

/* Whether a polynomial is above zero on all of the interval by its cubic part alone. */
static int clear(const ex_powers *p)
{
    double least, most, rest = 0.0;
    enclose(p->at[0], p->at[1], p->at[2], p->at[3], &least, &most);
    for (int k = 4; k <= p->degree; k++)
        rest += fabs(p->at[k]);
    return least > rest;
}

/* The sign that the slope of a polynomial, or what changes that (`order` 2), has on all of the interval,
 * by its cubic part alone; else 0. */
static int way_of(const ex_powers *p, int order)
{
    double q[EX_LEAST_DEGREE - 1], least, most, rest = 0.0;
    for (int k = 0; k < EX_LEAST_DEGREE - 1; k++)
        q[k] = (k + 1) * (order > 1 ? k + 2 : 1) * p->at[k + order];
    enclose(q[0], q[1], q[2], q[3], &least, &most);
    for (int k = 4 + order; k <= p->degree; k++)
        rest += k * (order > 1 ? k - 1 : 1) * fabs(p->at[k]);
    return least > rest ? 1 : -most > rest ? -1 : 0;
}

int ex_only_rises(const ex_powers *p, double limit)
{
    const double drop = bg_lesser(p->at[1], 0.0);
    return p->at[0] > -limit && drop > -limit && (way_of(p, 1) > 0 || way_of(p, 2) > 0);
}

/* Whether one that bends upwards, and is above zero at `begin`, falls below: its least value is there
 * where its slope vanishes, and no value is below a tangent. */
static int dips(const ex_powers *p, double begin, double *root)
{
    double low = begin, high = 1.0, t = begin, v[3];
    values(p, begin, v);
    if (v[1] >= 0.0)
        return 0;
    while (high - low > BG_NARROW) {
        const double next = t - 0.5 * v[1] / v[2];
        t = next > low && next < high ? next : next >= high && high == 1.0 ? 1.0 : 0.5 * (low + high);
        values(p, t, v);
        if (v[0] <= 0.0) {
            *root = polish(p, begin, t);
            return 1;
        }
        if (v[0] > v[1] * (v[1] < 0.0 ? t - high : t - low))
            return 0;
        if (v[1] < 0.0)
            low = t;
        else
            high = t;
    }
    return 0;
}

/* The same as ex_first_fall for what only rises or falls, or bends one way; -1 if it is none of these. */
static int fall_of_simple(const ex_powers *p, double begin, double *root)
{
    const int way = way_of(p, 1);
    if (way > 0)
        return 0;
    const int bend = way ? 0 : way_of(p, 2);
    if ((!way && !bend) || (bend && ex_value(p, begin) <= 0.0))
        return -1;
    if (bend > 0)
        return dips(p, begin, root);
    if (ex_value(p, 1.0) > 0.0)
        return 0;
    *root = polish(p, begin, 1.0);
    return 1;
}

int ex_first_fall(const ex_powers *p, double begin, double *root)
{
    if (clear(p))
        return 0;
    const int simple = fall_of_simple(p, begin, root), degree = p->degree;
    if (simple >= 0)
        return simple;
    double lows[EX_DEEP], highs[EX_DEEP], b[BG_POWERS + 1], least;
    int pending = 1, falls, rises;
    lows[0] = begin;
    highs[0] = 1.0;
    for (int parts = 0; pending > 0; parts++) {
        if (parts >= EX_MOST_PARTS || pending > EX_DEEP - 2)
            return -1;
        const double low = lows[--pending], high = highs[pending];
        shape(p, low, high, b);
        judge(degree, b, &least, &falls, &rises);
        if (least > 0 || (!falls && rises) || (falls && b[degree] > 0))
            continue;
        if (falls) {
            *root = polish(p, low, high);
            return 1;
        }
        if (high - low <= BG_NARROW) {
            if (b[degree] > 0)
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
