/* How rates change with the states, and the shortest time constant. */
#include <math.h>
#include <string.h>

#include "located_internal.h"

enum { SQUARINGS = 8, PRODUCTS = 1 << SQUARINGS };

/* How far state j is moved for a difference: far where rates are affine, as slopes do not round
 * then. */
static double reach_of(const bg_located *c, double t, const double *s, const double *base, int j)
{
    const double past = bg_longest_step(t - c->run.began);
    const double reach = BG_SLOPE_FLOOR * fabs(base[j]) * past + BG_SLOPE_FLOOR;
    return BG_AFFINE ? BG_FAR : BG_SLOPE * fabs(s[j]) + reach;
}

/* Rates with state j moved, less far where laws have no values there. */
static int rate_beside(bg_located *c, double t, double *moved, int j, double step, double *rate)
{
    const double own = moved[j];
    int status = BG_OK;
    for (int tries = 0; tries < 12; tries++, step *= BG_SLOPE_SHORTER) {
        moved[j] = own + step;
        status = bg_located_rate(c, t, moved, rate);
        if (status == BG_OK)
            break;
    }
    return status;
}

/* A column of differences; whether it is one of numbers. */
static int column_of(int j, double step, const double *base, const double *rate, double *jacobian)
{
    int finite = 1;
    for (int i = 0; i < BG_SIZE; i++) {
        jacobian[i * BG_SIZE + j] = (rate[i] - base[i]) / step;
        finite &= isfinite(jacobian[i * BG_SIZE + j]) != 0;
    }
    return finite;
}

/* Several columns at once, by what works several points out; whether it could. */
static int columns_at_once(bg_located *c, double t, const double *s, double side, int first,
                           const double *base, double *jacobian)
{
    const int count = BG_SIZE - first < BG_AT_ONCE ? BG_SIZE - first : BG_AT_ONCE;
    double moved[BG_AT_ONCE][BG_SIZE], rate[BG_AT_ONCE][BG_SIZE];
    int fine = 1;
    for (int k = 0; k < count; k++) {
        memcpy(moved[k], s, sizeof moved[k]);
        moved[k][first + k] += side * reach_of(c, t, s, base, first + k);
    }
    if (!c->together->rates(c->together->self, t, count, moved, rate))
        return 0;
    for (int k = 0; k < count; k++) {
        const int j = first + k;
        fine &= column_of(j, moved[k][j] - s[j], base, rate[k], jacobian);
    }
    return fine;
}

/* How rates change with the states, by rows, from differences that stay where laws have values;
 * downwards where `side` is -1. */
static int slopes(bg_located *c, double t, const double *s, double side, double *jacobian)
{
    double base[BG_SIZE], rate[BG_SIZE], moved[BG_SIZE];
    int status = bg_located_rate(c, t, s, base), j = 0;
    memcpy(moved, s, sizeof moved);
    while (status == BG_OK && c->together && j < BG_SIZE
           && columns_at_once(c, t, s, side, j, base, jacobian))
        j += BG_AT_ONCE;
    for (; j < BG_SIZE && status == BG_OK; j++) {
        status = rate_beside(c, t, moved, j, side * reach_of(c, t, s, base, j), rate);
        column_of(j, moved[j] - s[j], base, rate, jacobian);
        moved[j] = s[j];
    }
    return status;
}

int bg_located_jacobian(bg_located *c, double t, const double *s, double *jacobian)
{
    return slopes(c, t, s, 1.0, jacobian);
}

static void square_of(const double *a, double *product)
{
    memset(product, 0, sizeof(double) * BG_SIZE * BG_SIZE);
    for (int i = 0; i < BG_SIZE; i++)
        for (int l = 0; l < BG_SIZE; l++) {
            const double factor = a[i * BG_SIZE + l];
            for (int j = 0; j < BG_SIZE && factor != 0.0; j++)
                product[i * BG_SIZE + j] += factor * a[l * BG_SIZE + j];
        }
}

/* The largest rate of the model linearised in squares[0], from a high power of the matrix, scaled
 * as it grows; `size`: the largest entry. */
static double from_squares(bg_located *c, double size)
{
    double *power = c->squares[0], *next = c->squares[1], logarithm = 0.0, share = 1.0;
    for (int k = 0; k < SQUARINGS && size > 0.0; k++) {
        double *const done = power;
        logarithm += share * log(size);
        share /= 2;
        for (int i = 0; i < BG_SIZE * BG_SIZE; i++)
            power[i] /= size;
        square_of(power, next);
        power = next;
        next = done;
        size = bg_largest(BG_SIZE * BG_SIZE, power);
    }
    return size > 0.0 ? exp(logarithm + share * log(size)) : 0.0;
}

/* The same of a large model, whose powers take long: by as many products with a vector that no
 * structure is blind to. */
static double from_products(bg_located *c)
{
    double v[BG_SIZE], next[BG_SIZE], logarithm = 0.0;
    unsigned noise = 0;
    bg_list_entries(BG_SIZE, BG_SIZE, c->squares[0], BG_LIST(BG_SIZE, BG_SIZE), c->list);
    for (int i = 0; i < BG_SIZE; i++)
        v[i] = bg_stir(&noise);
    for (int k = 0; k < PRODUCTS; k++) {
        memset(next, 0, sizeof next);
        bg_multiply_listed(BG_SIZE, BG_SIZE, c->squares[0], c->list, v, next);
        const double size = bg_largest(BG_SIZE, next);
        if (!(size > 0.0))
            return 0.0;
        logarithm += log(size);
        for (int i = 0; i < BG_SIZE; i++)
            v[i] = next[i] / size;
    }
    return exp(logarithm / PRODUCTS);
}

/* The largest rate [1/s] of the model linearised in squares[0] and of the inputs. */
static int largest_rate(bg_located *c, double *fastest)
{
    const double size = bg_largest(BG_SIZE * BG_SIZE, c->squares[0]);
    if (!isfinite(size))
        return BG_NOT_FINITE;
    c->own = BG_LISTED(BG_SIZE, BG_SIZE) ? from_products(c) : from_squares(c, size);
    *fastest = fmax(bg_signals_fastest(c->signals, &c->run.span), c->own);
    return BG_OK;
}

int bg_located_fastest(bg_located *c, double t, const double *s, double *fastest)
{
    int same = c->known;
    *fastest = bg_signals_fastest(c->signals, &c->run.span);
    for (int i = 0; i < K; i++)
        same &= c->rated[i] == c->run.mode[i];
    if (same) {
        *fastest = fmax(*fastest, c->own);
        return BG_OK;
    }
    int status = bg_located_jacobian(c, t, s, c->squares[0]);
    if (status == BG_OK)
        status = largest_rate(c, fastest);
    c->known = BG_AFFINE && status == BG_OK;
    memcpy(c->rated, c->run.mode, K * sizeof *c->rated);
    return status;
}

/* At the present instant, a jump beside it left aside: from the smaller slope of both sides, which
 * are one where rates are affine in a mode. */
int bg_located_calm(bg_located *c, double *fastest)
{
    double *const ahead = c->squares[0], *const behind = c->squares[1];
    if (BG_AFFINE)
        return bg_located_fastest(c, c->run.at.t, c->s, fastest);
    int status = slopes(c, c->run.at.t, c->s, 1.0, ahead);
    if (status == BG_OK)
        status = slopes(c, c->run.at.t, c->s, -1.0, behind);
    for (int i = 0; i < BG_SIZE * BG_SIZE; i++)
        ahead[i] = fabs(ahead[i]) < fabs(behind[i]) ? ahead[i] : behind[i];
    return status == BG_OK ? largest_rate(c, fastest) : status;
}
