/* Explicit steps of order 8 with an interpolant of order 7. */
#include <math.h>
#include <string.h>

#include "located_explicit_table.h"
#include "located_internal.h"

static const double SAFETY = 0.9;

/* Stage i of a step, at `tried`. */
static int stage(bg_located *c, int i, double h)
{
    bg_solver *const s = &c->solver;
    for (int k = 0; k < BG_SIZE; k++)
        s->tried[k] = 0.0;
    for (int j = 0; j < i; j++) {
        const double weight = h * DOP_A[i][j];
        for (int k = 0; k < BG_SIZE && weight != 0.0; k++)
            s->tried[k] += weight * s->stage[j][k];
    }
    for (int k = 0; k < BG_SIZE; k++)
        s->tried[k] += s->y_old[k];
    return bg_located_rate(c, s->t_old + DOP_C[i] * h, s->tried, s->stage[i]);
}

/* The estimates of a step's error of order 5 and 3, in what the tolerance allows. */
static void estimates(const bg_located *c, double *fifth, double *third)
{
    const bg_solver *const s = &c->solver;
    *fifth = *third = 0.0;
    for (int k = 0; k < BG_SIZE; k++) {
        const double size = fmax(fabs(s->y_old[k]), fabs(s->tried[k]));
        const double scale = c->asked->atol + c->asked->rtol * size;
        double e5 = 0.0, e3 = 0.0;
        for (int i = 0; i <= DOP_STAGES; i++) {
            e5 += E5[i] * s->stage[i][k];
            e3 += E3[i] * s->stage[i][k];
        }
        *fifth += (e5 / scale) * (e5 / scale);
        *third += (e3 / scale) * (e3 / scale);
    }
}

/* Where rates may have a corner in a step both estimates are added: runs/explicit.py says why. */
static double error_over(bg_solver *s, double fifth, double third, double h)
{
    const double longer = s->begun ? fmax(h, s->h) : h, rise = BG_RISEN * longer * longer * longer;
    const double both = fifth + 0.01 * third;
    double error = 0.0;
    if (s->begun && sqrt(third) > rise * s->before)
        s->doubts = BG_WARY;
    if (both > 0.0)
        error = h * (s->doubts > 0 ? sqrt(both / BG_SIZE) : fifth / sqrt(both * BG_SIZE));
    if (!(both >= 0.0) || error != error)
        error = INFINITY;
    if (error < 1.0)
        s->before = sqrt(third) / (h * h * h);
    return error;
}

double bg_explicit_judge(bg_solver *s, double fifth, double third, double h)
{
    const double error = error_over(s, fifth, third, h);
    if (!(error < 1.0))
        s->doubts = BG_WARY;
    else if (s->doubts > 0)
        s->doubts--;
    return error;
}

/* All stages of a step; its end in `tried`. A point where laws have no value is an error without
 * bound. */
static int attempt(bg_located *c, double h, double *error)
{
    int status = BG_OK;
    double fifth = INFINITY, third = INFINITY;
    for (int i = 1; i <= DOP_STAGES && status == BG_OK; i++)
        status = stage(c, i, h);
    if (status == BG_OK)
        estimates(c, &fifth, &third);
    *error = bg_explicit_judge(&c->solver, fifth, third, h);
    return status == BG_NOT_FINITE || status == BG_NO_SOLUTION ? BG_OK : status;
}

/* The root of order 8 that lengths of steps go by. */
static double as_length(double error)
{
    return SAFETY / sqrt(sqrt(sqrt(error)));
}

double bg_explicit_least(const bg_solver *s)
{
    return 10.0 * (nextafter(fabs(s->t), INFINITY) - fabs(s->t));
}

double bg_explicit_shorter(double error)
{
    return isfinite(error) ? fmax(SHRINK, as_length(error)) : SHRINK;
}

void bg_explicit_take(bg_solver *s, double end, double h, double error, double grow)
{
    s->t = end;
    s->h = h;
    s->error = error;
    s->begun = 1;
    s->next = h * (error > 0.0 ? fmin(grow, as_length(error)) : grow);
}

int bg_explicit_step(bg_located *c, double stop)
{
    bg_solver *const s = &c->solver;
    const double least = bg_explicit_least(s);
    double h = fmin(fmax(s->next, least), s->longest), error = INFINITY, grow = GROW, end;
    s->t_old = s->t;
    memcpy(s->y_old, s->y, sizeof s->y);
    memcpy(s->stage[0], s->f, sizeof s->f);
    for (;;) {
        end = fmin(s->t_old + h, stop);
        h = end - s->t_old;
        const int status = attempt(c, h, &error);
        if (status != BG_OK)
            return status;
        if (error < 1.0)
            break;
        h *= bg_explicit_shorter(error);
        grow = 1.0;
        if (h < least)
            return BG_STEPS;
    }
    memcpy(s->y, s->tried, sizeof s->y);
    memcpy(s->f_old, s->f, sizeof s->f);
    memcpy(s->f, s->stage[DOP_STAGES], sizeof s->f);
    bg_explicit_take(s, end, h, error, grow);
    return BG_OK;
}

int bg_explicit_dense(bg_located *c)
{
    bg_solver *const s = &c->solver;
    for (int i = DOP_STAGES + 1; i < DOP_ALL; i++) {
        const int status = stage(c, i, s->h);
        if (status != BG_OK)
            return status;
    }
    for (int k = 0; k < BG_SIZE; k++) {
        const double change = s->y[k] - s->y_old[k];
        s->interpolation[0][k] = change;
        s->interpolation[1][k] = s->h * s->f_old[k] - change;
        s->interpolation[2][k] = 2 * change - s->h * (s->f[k] + s->f_old[k]);
        for (int r = 0; r < 4; r++) {
            double sum = 0.0;
            for (int i = 0; i < DOP_ALL; i++)
                sum += D[r][i] * s->stage[i][k];
            s->interpolation[3 + r][k] = s->h * sum;
        }
    }
    return BG_OK;
}

void bg_explicit_at(const bg_solver *s, double t, double *y)
{
    const double x = (t - s->t_old) / s->h;
    for (int k = 0; k < BG_SIZE; k++) {
        double sum = 0.0;
        for (int i = 6; i >= 0; i--)
            sum = (sum + s->interpolation[i][k]) * (i % 2 ? 1 - x : x);
        y[k] = s->y_old[k] + sum;
    }
}
