/* How far the stability of Runge's and Kutta's classical method of fourth order reaches. */
#include <float.h>
#include <math.h>

#include "model_internal.h"

/* What a step makes of z = h l, squared: |1 + z + z^2/2 + z^3/6 + z^4/24|^2. */
static double amplified(double re, double im)
{
    double x = 1.0, y = 0.0;
    for (int k = 4; k > 0; k--) {
        const double turned = (x * im + y * re) / k;
        x = 1.0 + (x * re - y * im) / k;
        y = turned;
    }
    return x * x + y * y;
}

/* Of l = re + i im. What grows by itself is no fault of the step, but must not turn too fast. */
static double step_of(double re, double im)
{
    const double size = sqrt(re * re + im * im);
    double low = BG_NEAREST - BG_BRACKET, high = BG_FARTHEST + BG_BRACKET;
    if (re >= 0)
        return im != 0 ? BG_IMAGINARY_LIMIT / fabs(im) : DBL_MAX;
    for (int k = 0; k < 40; k++) {
        const double middle = (low + high) / 2;
        if (amplified(middle * re / size, middle * im / size) > 1)
            high = middle;
        else
            low = middle;
    }
    return low / size;
}

double bg_stable_step(double a, double b)
{
    const double squared = a * a / 4 + b, apart = sqrt(fabs(squared));
    if (squared < 0)
        return step_of(a / 2, apart);
    return fmin(step_of(a / 2 - apart, 0.0), step_of(a / 2 + apart, 0.0));
}
