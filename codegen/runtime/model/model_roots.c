/* A root of a function between two points of different sign, however flat the function is there:
 * inverse quadratic interpolation where three points promise it, else halves (T. R. Chandrupatla, A
 * new hybrid quadratic/bisection algorithm, Advances in Engineering Software 28 (1997) 145-149).
 * Halving is enforced where interpolation crawls, as along a root of many folds: it always ends. */
#include <float.h>
#include <math.h>

#include "model_internal.h"

enum { SLOW = 3 };                /* after so many steps that did not halve the interval, it is */

/* How far from a to b interpolation leads, where it is sure to; else a half. */
static double share_of(double a, double b, double c, double fa, double fb, double fc)
{
    if (fc == fa || fc == fb || fa == fb)
        return 0.5;
    const double xi = (a - b) / (c - b), phi = (fa - fb) / (fc - fb);
    if (!(phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi))
        return 0.5;
    return fa / (fb - fa) * fc / (fb - fc)
        + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb);
}

int bg_root(double (*f)(void *self, double at), void *self, double a, double b, double *found)
{
    double fa = f(self, a), fb = f(self, b), share = 0.5;
    const double floor = BG_LEAST_INTERVAL * fabs(b - a) + DBL_MIN;
    int slow = 0;
    if ((fa > 0 && fb > 0) || (fa < 0 && fb < 0))
        return 0;
    *found = fa == 0 ? a : b;
    for (int turn = 0; turn < BG_ROOT_TURNS && fa != 0 && fb != 0; turn++) {
        const double width = fabs(b - a), t = a + share * (b - a), ft = f(self, t);
        double c = a, fc = fa;
        if ((ft > 0) != (fa > 0)) {
            c = b, fc = fb;
            b = a, fb = fa;
        }
        a = t, fa = ft;
        *found = fabs(fa) <= fabs(fb) ? a : b;
        const double least = a != b ? (DBL_EPSILON * fabs(*found) + floor) / fabs(b - a) : 1.0;
        if (least > 0.5)
            break;
        slow = fabs(b - a) > 0.5 * width ? slow + 1 : 0;
        share = slow >= SLOW ? 0.5 : share_of(a, b, c, fa, fb, fc);
        slow = slow >= SLOW ? 0 : slow;
        share = fmin(fmax(share, least), 1 - least);
    }
    return 1;
}
