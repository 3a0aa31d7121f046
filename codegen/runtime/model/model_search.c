/* Laws turned round: Newton's method between two places that hold the answer. As
 * bondgraph/searching.py: equal steps, equal numbers. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "model_internal.h"

enum {
    STEPS = 200, /* halving the doubles between two places takes 64, and Newton's no more between */
    FREE = 8,    /* of Newton's steps that may be as long as they come */
    POWERS = 1000
};

static const double LEAST = 0x1p-52; /* a relative distance that rounding alone may make */
static const double OVER = 8.0;       /* so many times that far a step goes that is to pass */

typedef struct {
    bg_law law;
    const double *a;
    double value;
} bg_sought;

/* How far the law is beyond the value, and its slope; no numbers where it has none. */
static double off_at(const bg_sought *of, double x, double *slope)
{
    const double found = of->law(x, of->a, slope);
    if (found - found == 0.0)
        return found - of->value;
    *slope = NAN;
    return NAN;
}

/* A place at which the law has a value, how far that is beyond the one sought, and the slope. */
static double beginning(const bg_sought *of, double begin, double *off, double *slope)
{
    *off = off_at(of, begin, slope);
    if (*off == *off)
        return begin;
    for (int power = 0; power < POWERS; power++) {
        const double small = ldexp(1.0, -power), large = ldexp(1.0, power);
        const double places[] = {small, large, -small, -large};
        for (int at = 0; at < 4; at++) {
            *off = off_at(of, places[at], slope);
            if (*off == *off)
                return places[at];
        }
    }
    return NAN;
}

/* The number of a double among all, zero having 0. */
static int64_t order_of(double x)
{
    const double size = fabs(x);
    int64_t bits = 0;
    memcpy(&bits, &size, sizeof bits);
    return x < 0.0 ? -bits : bits;
}

/* The double with as many doubles between it and either; one of both where there is none. */
static double middle(double a, double b)
{
    const int64_t order = order_of(a) / 2 + order_of(b) / 2;
    const int64_t bits = order < 0 ? -order : order;
    double size = 0.0;
    memcpy(&size, &bits, sizeof size);
    return order < 0 ? -size : size;
}

double bg_searched(bg_law law, double begin, double value, const double *a)
{
    const bg_sought of = {law, a, value};
    if (value - value != 0.0)
        return NAN;
    double off = NAN, slope = NAN;
    double near = beginning(&of, begin, &off, &slope), x = near;
    const int below = off < 0.0, rises = slope > 0.0;
    double far = rises == below ? HUGE_VAL : -HUGE_VAL, last = HUGE_VAL;
    int there = 0;
    if (off - off != 0.0)
        return NAN;
    for (int step = 0; step < STEPS; step++) {
        if (fabs(off) <= LEAST * fabs(value))
            return x;
        const double move = slope != 0.0 ? -off / slope : HUGE_VAL;
        double onto = x + move;
        if (fabs(move) <= LEAST * fabs(x)) {
            if (there)
                return onto;
            /* Close by what holds the answer it has to be shown that the law comes to it. */
            onto = x + copysign(OVER * LEAST * x, move);
        }
        const int inside = fmin(near, far) < onto && onto < fmax(near, far);
        if (!inside || (step > FREE && 4.0 * fabs(move) > last)) {
            onto = middle(near, far);
            if (onto == near || onto == far)
                return there ? onto : NAN;
        }
        last = fabs(onto - x);
        x = onto;
        off = off_at(&of, x, &slope);
        if (off == off && (off < 0.0) == below) {
            near = x;
        } else {
            far = x;
            there = there || off == off;
        }
    }
    return NAN;
}
