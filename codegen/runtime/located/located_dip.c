/* Where what is above zero at three points dips to zero between them: by chords, ever closer.
 * A function that bends upwards lies, between two points, above the chords beside them drawn on. */
#include <math.h>

#include "located_internal.h"

enum { MOST = 3 + BG_DIP_LOOKS };

/* The least that chords leave between two points, and where to look between them. */
typedef struct {
    double least, t;
    int k;
} place;

/* Whether the parabola through three points falls to half of the lowest of them, or below. */
static int promising(const double *values)
{
    const double a = values[0], b = values[1], c = values[2], least = fmin(a, fmin(b, c));
    const double curve = a - 2 * b + c, slope = (c - a) / 2;
    if (least <= 0 || curve <= 0 || fabs(slope) > 1.25 * curve)
        return 0;
    return b - slope * slope / (2 * curve) <= 0.5 * least;
}

/* Between points k and k + 1; a chord beside which the function bends downwards tells nothing. */
static place place_between(const double *t, const double *f, int count, int k)
{
    const double h = t[k + 1] - t[k], chord = (f[k + 1] - f[k]) / h;
    const double before = k > 0 ? (f[k] - f[k - 1]) / (t[k] - t[k - 1]) : chord;
    const double after =
        k + 2 < count ? (f[k + 2] - f[k + 1]) / (t[k + 2] - t[k + 1]) : chord;
    const double inside = BG_DIP_INSIDE * h;
    place found = {fmin(f[k], f[k + 1]), t[k] + h / 2, k};
    if (before < chord && chord < after) {
        const double meet = (f[k + 1] - f[k] - after * h) / (before - after);
        if (before < 0 && after > 0)
            found.least = f[k] + before * meet;
        found.t = t[k] + fmin(fmax(meet, inside), h - inside);
    } else if (before < chord) {
        found.least = fmin(found.least, f[k] + before * h);
    } else if (chord < after) {
        found.least = fmin(found.least, f[k + 1] - after * h);
    }
    return found;
}

static place lowest_of(const double *t, const double *f, int count)
{
    place found = place_between(t, f, count, 0);
    for (int k = 1; k + 1 < count; k++) {
        const place one = place_between(t, f, count, k);
        if (one.least < found.least)
            found = one;
    }
    return found;
}

int bg_dip(double (*above)(void *self, double at), void *self, const double *times,
           const double *values, double *found)
{
    const double width = BG_DIP * (times[2] - times[0]);
    double t[MOST], f[MOST];
    for (int k = 0; k < 3; k++) {
        t[k] = times[k];
        f[k] = values[k];
    }
    for (int count = 3; promising(values) && count < MOST; count++) {
        const place next = lowest_of(t, f, count);
        if (next.least > 0 || t[next.k + 1] - t[next.k] <= width)
            return 0;
        *found = next.t;
        const double value = above(self, next.t);
        if (value <= 0)
            return 1;
        for (int k = count; k > next.k + 1; k--) {
            t[k] = t[k - 1];
            f[k] = f[k - 1];
        }
        t[next.k + 1] = next.t;
        f[next.k + 1] = value;
    }
    return 0;
}
