/* Looking up in tables, and the corners of these. As bondgraph/tables/looking.py and edges.py. */
#include <math.h>

#include "model_internal.h"

enum {
    ORDERS = 4,
    HALVES = 20 /* that leave nothing of the points that a table may have at the most */
};

/* The cell in which x is, the first or the last where it is beyond. */
static int cell_of(const double *breaks, int cells, double x)
{
    int low = 0, high = cells + 1;
    for (int half = 0; half < HALVES && low < high; half++) {
        const int middle = (low + high) / 2;
        if (x < breaks[middle])
            high = middle;
        else
            low = middle + 1;
    }
    return low < 1 ? 0 : low > cells ? cells - 1 : low - 1;
}

/* The cell along one axis, the distance from its beginning, and whether the end's value is held. */
static int placed(const bg_table *of, int axis, double x, double region, double *u, int *held)
{
    const double *const breaks = of->breaks[axis];
    const int cells = of->cells[axis], ends = of->outside != BG_TABLE_EXTENDS;
    const int free = region < 0.0, top = cells + 1;
    /* On its end a table that refuses what is beyond has a value, on whichever side of it. */
    const int always = of->outside == BG_TABLE_HOLDS && !free;
    const double nothing = of->outside == BG_TABLE_HOLDS ? 0.0 * x : NAN;
    int at = 0;
    if (ends && (free || region < 0.5) && (x < breaks[0] || always)) {
        *held = 1;
        *u = nothing;
        return 0;
    }
    if (ends && (free || region > top - 0.5) && (x > breaks[cells] || always)) {
        *held = 1;
        *u = breaks[cells] - breaks[cells - 1] + nothing;
        return cells - 1;
    }
    if (free)
        at = cell_of(breaks, cells, x);
    else
        at = (int)(region + 0.5) - ends;
    at = at < 0 ? 0 : at < cells ? at : cells - 1;
    *u = x - breaks[at];
    return at;
}

/* The derivative of an order of a polynomial, its highest power first. */
static double polynomial(const double *factors, int degree, int order, double u)
{
    double total = 0.0;
    for (int power = degree; power >= order; power--) {
        double times = 1.0;
        for (int k = 0; k < order; k++)
            times *= power - k;
        total = total * u + times * factors[degree - power];
    }
    return total;
}

/* What a cubic is above where a cell begins, and its slope; no number where that has turned. */
static double cubic_above(double w, const double *factors, double *slope)
{
    const double above[] = {factors[0], factors[1], factors[2], 0.0};
    *slope = polynomial(above, 3, 1, w);
    return *slope * factors[2] > 0.0 ? polynomial(above, 3, 0, w) : NAN;
}

/* The place where a cubic is so far above where its cell begins, or a derivative of that place. As
 * bondgraph/tables/backward.py. */
static double solved_back(const double *factors, int order, double above)
{
    const double w = bg_searched(cubic_above, 0.0, above, factors);
    const double cubic[] = {factors[0], factors[1], factors[2], 0.0};
    const double slope = polynomial(cubic, 3, 1, w), bend = polynomial(cubic, 3, 2, w);
    if (order == 0)
        return factors[3] + w;
    if (order == 1)
        return 1.0 / slope;
    if (order == 2)
        return -bend / slope / slope / slope;
    return (3.0 * bend * bend / slope - polynomial(cubic, 3, 3, w)) / slope / slope / slope / slope;
}

double bg_interpolate(const bg_table *of, int order, double x, double region)
{
    double u = 0.0;
    int held = 0;
    const int at = placed(of, 0, x, region, &u, &held);
    if (held && order > 0 && u == u)
        return 0.0;
    if (of->degree < 0)
        return solved_back(of->factors + 4 * at, order, u);
    return polynomial(of->factors + at * (of->degree + 1), of->degree, order, u);
}

double bg_interpolate_over(const bg_table *of, int order_x, int order_y, double x, double y,
                           double region_x, double region_y)
{
    const int size = of->degree + 1;
    double u = 0.0, v = 0.0, rows[ORDERS];
    int level_x = 0, level_y = 0;
    const int i = placed(of, 0, x, region_x, &u, &level_x);
    const int j = placed(of, 1, y, region_y, &v, &level_y);
    const double *const factors = of->factors + (i * of->cells[1] + j) * size * size;
    if (u != u || v != v)
        return NAN;
    if ((level_x && order_x > 0) || (level_y && order_y > 0))
        return 0.0;
    for (int k = 0; k < size; k++)
        rows[k] = polynomial(factors + k * size, of->degree, order_y, v);
    return polynomial(rows, of->degree, order_x, u);
}

static double corner_at(const bg_table *of, int axis, int at)
{
    return of->breaks[axis][of->outside == BG_TABLE_EXTENDS ? at + 1 : at];
}

static int corners_of(const bg_table *of, int axis)
{
    const int ends = of->outside != BG_TABLE_EXTENDS;
    return of->cells[axis] - 1 + 2 * ends;
}

static int corners_below(const bg_table *of, int axis, double x)
{
    int low = 0, high = corners_of(of, axis);
    for (int half = 0; half < HALVES && low < high; half++) {
        const int middle = (low + high) / 2;
        if (x < corner_at(of, axis, middle))
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

/* The distance to the nearest corner at which the bit changes, that is a multiple of `step` and no
 * multiple of twice that, counted from 1. */
static double nearest(const bg_table *of, int axis, int step, int below, double x)
{
    const int whole = below / step, low = whole % 2 ? whole : whole - 1;
    double found = INFINITY;
    if (low > 0)
        found = x - corner_at(of, axis, low * step - 1);
    if ((low + 2) * step <= corners_of(of, axis))
        found = bg_min(corner_at(of, axis, (low + 2) * step - 1) - x, found);
    return found;
}

/* The stretch between corners in which x is, or that of a region. */
static int stretch_of(const bg_table *of, int axis, double x, double region)
{
    const int count = corners_of(of, axis);
    const int at = region < 0.0 ? corners_below(of, axis, x) : (int)(region + 0.5);
    return at < count ? at : count;
}

/* 1, or -1 where the bit of this stretch's number is on. */
static double gray_sign(int at, int bit)
{
    return ((at ^ (at >> 1)) >> bit) & 1 ? -1.0 : 1.0;
}

double bg_edge(const bg_table *of, int axis, int bit, double x, double region)
{
    const int count = corners_of(of, axis), step = 1 << bit;
    const int at = stretch_of(of, axis, x, region);
    const double sign = gray_sign(at, bit);
    if (region < 0.0)
        return sign * nearest(of, axis, step, at, x);
    if (at > 0 && (at & -at) == step)
        return sign * (x - corner_at(of, axis, at - 1));
    if (at < count && ((at + 1) & -(at + 1)) == step)
        return sign * (corner_at(of, axis, at) - x);
    return sign * (of->breaks[axis][of->cells[axis]] - of->breaks[axis][0]) + 0.0 * x;
}

/* The bit that changes at a corner, by its number from 1 on. */
static int bit_at(int corner)
{
    int bit = 0;
    for (int half = 0; half < HALVES && !((corner >> bit) & 1); half++)
        bit++;
    return bit;
}

void bg_edges(const bg_table *of, int axis, int bits, double x, double region, double *out)
{
    const int count = corners_of(of, axis), at = stretch_of(of, axis, x, region);
    const double whole = of->breaks[axis][of->cells[axis]] - of->breaks[axis][0];
    if (region < 0.0) {
        for (int bit = 0; bit < bits; bit++)
            out[bit] = gray_sign(at, bit) * nearest(of, axis, 1 << bit, at, x);
        return;
    }
    /* Of a stretch two corners count, which change different bits. */
    for (int bit = 0; bit < bits; bit++)
        out[bit] = gray_sign(at, bit) * whole + 0.0 * x;
    if (at > 0)
        out[bit_at(at)] = gray_sign(at, bit_at(at)) * (x - corner_at(of, axis, at - 1));
    if (at < count)
        out[bit_at(at + 1)] = gray_sign(at, bit_at(at + 1)) * (corner_at(of, axis, at) - x);
}
