/* Brent's method: R. P. Brent, Algorithms for Minimization without Derivatives, 1973, chapter 4. */
#include <float.h>
#include <math.h>

#include "model_internal.h"

enum { MOST = 200 };

/* The way to a point between by the secant or inverse quadratic interpolation; 0 if halving is
 * better. */
static double interpolated(double a, double b, double c, double fa, double fb, double fc,
                           double before)
{
    const double middle = 0.5 * (c - b), s = fb / fa;
    double p, q, r;
    if (a == c) {
        p = 2 * middle * s;
        q = 1 - s;
    } else {
        q = fa / fc;
        r = fb / fc;
        p = s * (2 * middle * q * (q - r) - (b - a) * (r - 1));
        q = (q - 1) * (r - 1) * (s - 1);
    }
    if (p > 0)
        q = -q;
    p = fabs(p);
    if (2 * p < 3 * middle * q - fabs(DBL_EPSILON * b * q) && 2 * p < fabs(before * q))
        return p / q;
    return 0.0;
}

int bg_root(double (*f)(void *self, double at), void *self, double a, double b, double *found)
{
    double fa = f(self, a), fb = f(self, b), c = a, fc = fa, step = b - a, before = step;
    if ((fa > 0 && fb > 0) || (fa < 0 && fb < 0))
        return 0;
    for (int k = 0; k < MOST && fb != 0; k++) {
        double middle, next, tolerance;
        if (fabs(fc) < fabs(fb)) {
            a = b, b = c, c = a;
            fa = fb, fb = fc, fc = fa;
        }
        tolerance = 2 * DBL_EPSILON * fabs(b) + DBL_MIN;
        middle = 0.5 * (c - b);
        if (fabs(middle) <= tolerance)
            break;
        next = fabs(before) >= tolerance && fabs(fa) > fabs(fb)
            ? interpolated(a, b, c, fa, fb, fc, before) : 0.0;
        before = next != 0 ? step : middle;
        step = next != 0 ? next : middle;
        a = b, fa = fb;
        b += fabs(step) > tolerance ? step : copysign(tolerance, middle);
        fb = f(self, b);
        if ((fb > 0) == (fc > 0)) {
            c = a, fc = fa;
            step = before = b - a;
        }
    }
    *found = b;
    return 1;
}
