/* External inputs over time. */
#include <float.h>
#include <math.h>

#include "model_signals.h"
#include "run_pace.h"
#include "tuning.h"

void bg_term_add(const bg_term *term, const double (*coefficients)[2], double t, double *value,
                 double *slope)
{
    const double(*const c)[2] = coefficients + term->first;
    const double *const r = term->rate;
    const double tau = t - term->start, size = r[0] != 0.0 ? exp(r[0] * tau) : 1.0;
    const double cosine = r[1] != 0.0 ? cos(r[1] * tau) : 1.0;
    const double sine = r[1] != 0.0 ? sin(r[1] * tau) : 0.0;
    double p[2] = {0.0, 0.0}, d[2] = {0.0, 0.0};
    for (int k = term->count - 1; k >= 0; k--) {
        d[0] = d[0] * tau + p[0];
        d[1] = d[1] * tau + p[1];
        p[0] = p[0] * tau + c[k][0];
        p[1] = p[1] * tau + c[k][1];
    }
    d[0] += r[0] * p[0] - r[1] * p[1];
    d[1] += r[0] * p[1] + r[1] * p[0];
    *value += size * (p[0] * cosine - p[1] * sine);
    *slope += size * (d[0] * cosine - d[1] * sine);
}

double bg_cancelled(double size, double slope, double time)
{
    return 8.0 * DBL_EPSILON * (size + slope * time / 8.0);
}

/* What rounding leaves of an input's terms where they cancel. */
static double rounding(const bg_signals *signals, int segment, int input, double t)
{
    double sum = 0.0;
    for (int k = signals->begins[segment]; k < signals->begins[segment + 1]; k++) {
        const bg_term *const term = signals->terms + k;
        const double(*const c)[2] = signals->coefficients + term->first;
        const double tau = t - term->start;
        double size = 0.0, slope = 0.0;
        if (term->input != input)
            continue;
        for (int i = term->count - 1; i >= 0; i--) {
            slope = slope * fabs(tau) + size;
            size = size * fabs(tau) + fabs(c[i][0]) + fabs(c[i][1]);
        }
        slope += (fabs(term->rate[0]) + fabs(term->rate[1])) * size;
        const double grown = term->rate[0] != 0.0 ? exp(term->rate[0] * tau) : 1.0;
        sum += grown * bg_cancelled(size, slope, fabs(t) + fabs(term->start));
    }
    return sum;
}

void bg_signals_at(const bg_signals *signals, int segment, double t, double *w, double *dw)
{
    double largest[BG_ROOM(BG_EXTERNAL)] = {0};
    for (int i = 0; i < BG_EXTERNAL; i++)
        w[i] = dw[i] = 0.0;
    /* A segment is not continued back before its begin: a level would fall below zero. */
    if (segment > 0)
        t = fmax(t, signals->breaks[segment - 1]);
    for (int k = signals->begins[segment]; k < signals->begins[segment + 1]; k++) {
        const bg_term *const term = signals->terms + k;
        const double(*const c)[2] = signals->coefficients + term->first;
        double *const most = largest + term->input;
        bg_term_add(term, signals->coefficients, t, w + term->input, dw + term->input);
        for (int i = 0; i < term->count; i++)
            *most = fmax(*most, fmax(fabs(c[i][0]), fabs(c[i][1])));
    }
    for (int i = 0; i < BG_EXTERNAL; i++)
        if (w[i] != 0.0 && fabs(w[i]) <= BG_CANCELLED * largest[i] /* else none: saves the look */
            && fabs(w[i]) <= rounding(signals, segment, i, t))
            w[i] = 0.0;
}

/* A breakpoint counts as reached a rounding before it: times are sums of steps. */
int bg_signals_segment(const bg_signals *signals, double t)
{
    const double near = t + 8 * DBL_EPSILON * fabs(t);
    return bg_segment(signals->segments, signals->breaks, near);
}
