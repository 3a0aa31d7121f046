/* Where what is above zero at several points dips to zero between two of them: by chords, ever
 * closer, as numbers/dips.py, which says more. A function that bends upwards lies, between two
 * points, above the chords beside them drawn on; one that bends downwards beside them may go on
 * to. */
#include <math.h>
#include <string.h>

#include "located_internal.h"

enum { MOST = BG_CHECKS + 2 + BG_DIP_LOOKS };

/* The points that are known, and room for those of a search. */
typedef struct {
    int count;
    const double *t, *f;
} polygon;

typedef struct {
    int count;
    double t[MOST], f[MOST];
} searched;

/* The least that chords leave between points k and k + 1, and where to look between them. */
typedef struct {
    double least, t;
    int k;
} place;

static double chord_at(const polygon *p, int k)
{
    return (p->f[k + 1] - p->f[k]) / (p->t[k + 1] - p->t[k]);
}

/* The change of slope at point k, over the distance in which it changes. */
static double bend_at(const polygon *p, int k)
{
    return 2 * (chord_at(p, k) - chord_at(p, k - 1)) / (p->t[k + 1] - p->t[k - 1]);
}

/* How much a function bends downwards, told on its own side or by the size on the other. */
static double downwards(int known, double own, double other)
{
    return known ? fmax(0.0, -own) : fabs(other);
}

/* The slopes with which the chords beside points k and k + 1 go on between them at the most; that
 * of the two where there is none. */
static void drawn_on(const polygon *p, int k, double *left, double *right)
{
    const int before = k > 1, after = k + 3 < p->count;
    const double h = p->t[k + 1] - p->t[k];
    const double own = before ? bend_at(p, k - 1) : 0.0, other = after ? bend_at(p, k + 2) : 0.0;
    *left = *right = chord_at(p, k);
    if (k > 0) {
        const double reach = (h + p->t[k] - p->t[k - 1]) / 2;
        *left = chord_at(p, k - 1) - reach * downwards(before, own, other);
    }
    if (k + 2 < p->count) {
        const double reach = (h + p->t[k + 2] - p->t[k + 1]) / 2;
        *right = chord_at(p, k + 1) + reach * downwards(after, other, own);
    }
}

static place place_between(const polygon *p, int k)
{
    const double a = p->f[k], b = p->f[k + 1], h = p->t[k + 1] - p->t[k];
    const double chord = chord_at(p, k), inside = BG_DIP_INSIDE * h;
    place found = {fmin(a, b), p->t[k] + h / 2, k};
    double left, right;
    drawn_on(p, k, &left, &right);
    if (left < chord && chord < right) {
        const double meet = (b - a - right * h) / (left - right);
        if (left < 0 && right > 0)
            found.least = a + left * meet;
        found.t = p->t[k] + fmin(fmax(meet, inside), h - inside);
    } else if (left < chord) {
        found.least = fmin(found.least, a + left * h);
    } else if (chord < right) {
        found.least = fmin(found.least, b - right * h);
    }
    return found;
}

static place lowest_between(const polygon *p, int k, int end)
{
    place found = place_between(p, k);
    while (++k < end) {
        const place one = place_between(p, k);
        if (one.least < found.least)
            found = one;
    }
    return found;
}

static void insert_after(searched *p, int k, double t, double f)
{
    const size_t beyond = sizeof(double) * (size_t)(p->count - k - 1);
    memmove(p->t + k + 2, p->t + k + 1, beyond);
    memmove(p->f + k + 2, p->f + k + 1, beyond);
    p->t[k + 1] = t;
    p->f[k + 1] = f;
    p->count++;
}

int bg_dip(double (*above)(void *self, double at), void *self, int count, const double *times,
           const double *values, int k, double *found)
{
    const double width = BG_DIP * (times[count - 1] - times[0]);
    const polygon given = {count, times, values};
    place next = place_between(&given, k);
    searched p;
    if (!(next.least <= 0))
        return 0; /* as a rule */
    p.count = count;
    memcpy(p.t, times, sizeof(double) * (size_t)count);
    memcpy(p.f, values, sizeof(double) * (size_t)count);
    for (int end = k + 1; p.count < count + BG_DIP_LOOKS; end++) {
        const polygon known = {p.count, p.t, p.f};
        next = lowest_between(&known, k, end);
        if (!(next.least <= 0) || p.t[next.k + 1] - p.t[next.k] <= width)
            return 0;
        *found = next.t;
        const double value = above(self, next.t);
        if (value <= 0)
            return 1;
        insert_after(&p, next.k, next.t, value);
    }
    return 0;
}
