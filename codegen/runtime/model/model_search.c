/* Laws turned round: Newton's method between two places that hold the answer. As
 * bondgraph/inverses/searching.py: equal steps, equal numbers. */
#include <math.h>

#include "model_internal.h"

enum {
    STEPS = 1200, /* halvings that find a double between any two others */
    POWERS = 1000
};

static const double LEAST = 0x1p-52; /* a relative distance that rounding alone may make */

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

/* Where the law has a value. */
static double beginning(const bg_sought *of)
{
    double slope = NAN, off = off_at(of, 0.0, &slope);
    if (off == off)
        return 0.0;
    for (int power = 0; power < POWERS; power++) {
        const double small = ldexp(1.0, -power), large = ldexp(1.0, power);
        const double places[] = {small, large, -small, -large};
        for (int at = 0; at < 4; at++) {
            off = off_at(of, places[at], &slope);
            if (off == off)
                return places[at];
        }
    }
    return NAN;
}

/* The answer between a place where the law is not there yet and one where it is past. */
static double between(const bg_sought *of, double near, double far)
{
    double slope = NAN, x = far, last = fabs(far - near);
    const int before = off_at(of, near, &slope) > 0.0;
    for (int step = 0; step < STEPS; step++) {
        const double off = off_at(of, x, &slope);
        if (fabs(off) <= LEAST * fabs(of->value))
            return x;
        if ((off > 0.0) == before)
            near = x;
        else
            far = x;
        double move = slope != 0.0 ? -off / slope : HUGE_VAL, next = x + move;
        if (!(fmin(near, far) < next && next < fmax(near, far)) || 2.0 * fabs(move) > last) {
            next = near + 0.5 * (far - near);
            move = next - x;
        }
        if (fabs(move) <= LEAST * fabs(next) || next == near || next == far)
            return next;
        x = next;
        last = fabs(move);
    }
    return x;
}

double bg_searched(bg_law law, double value, const double *a)
{
    const bg_sought of = {law, a, value};
    double slope = NAN, near = beginning(&of), off = off_at(&of, near, &slope), beyond = NAN;
    if (off == 0.0 || off != off)
        return off == 0.0 ? near : NAN;
    const double way = (slope < 0.0) == (off < 0.0) ? -1.0 : 1.0;
    double move = slope != 0.0 ? fabs(off / slope) : 0.0;
    if (!(move > 0.0 && move - move == 0.0))
        move = 1.0;
    for (int step = 0; step < STEPS; step++) {
        const double far = near + way * move;
        if (far == near || far - far != 0.0)
            return NAN;
        const double there = off_at(&of, far, &slope);
        if (there != there)
            beyond = far;
        else if ((there > 0.0) != (off > 0.0))
            return there != 0.0 ? between(&of, near, far) : far;
        else {
            near = far;
            off = there;
            move = 2.0 * move;
        }
        if (beyond == beyond)
            move = fmin(move, 0.5 * fabs(beyond - near));
    }
    return NAN;
}
