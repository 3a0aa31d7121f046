/* External inputs over time. */
#include <float.h>
#include <math.h>

#include "model_terms.h"
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

bg_term_walk bg_walk_terms(const bg_signals *signals, const bg_span *span)
{
    const int *const begins = signals->begins + span->segment;
    return (bg_term_walk){signals, span, -1, begins[0], begins[1], 0.0, {0, 0, 0, 0.0, {0.0, 0.0}}};
}

const bg_term *bg_next_term(bg_term_walk *walk)
{
    const bg_signals *const signals = walk->signals;
    while (walk->next == walk->last) {
        if (++walk->wave >= signals->waves)
            return 0;
        const bg_wave *const wave = signals->wave + walk->wave;
        const int part = bg_wave_part(signals, wave, walk->span->begin, &walk->begin);
        walk->next = signals->parts[wave->first + part].first;
        walk->last = walk->next + signals->parts[wave->first + part].count;
    }
    if (walk->wave < 0)
        return signals->terms + walk->next++;
    walk->own = signals->terms[walk->next++];
    walk->own.start = walk->begin;
    return &walk->own;
}

/* What rounding leaves of an input's terms where they cancel. */
static double rounding(const bg_signals *signals, const bg_span *span, int input, double t)
{
    double sum = 0.0;
    bg_term_walk walk = bg_walk_terms(signals, span);
    for (const bg_term *term = bg_next_term(&walk); term; term = bg_next_term(&walk)) {
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

/* Adds a term, and tells the largest of the coefficients so far. */
static void add_term(const bg_term *term, const double (*coefficients)[2], double t, double *w,
                     double *dw, double *largest)
{
    const double(*const c)[2] = coefficients + term->first;
    double *const most = largest + term->input;
    bg_term_add(term, coefficients, t, w + term->input, dw + term->input);
    for (int i = 0; i < term->count; i++)
        *most = fmax(*most, fmax(fabs(c[i][0]), fabs(c[i][1])));
}

void bg_signals_at(const bg_signals *signals, const bg_span *span, double t, double *w,
                   double *dw)
{
    double largest[BG_ROOM(BG_EXTERNAL)] = {0};
    bg_term_walk walk = bg_walk_terms(signals, span);
    for (int i = 0; i < BG_EXTERNAL; i++)
        w[i] = dw[i] = 0.0;
    /* Pieces are not continued back before they begin: a level would fall below zero. */
    t = fmax(t, span->begin);
    for (; walk.next < walk.last; walk.next++) /* of the table, which most are */
        add_term(signals->terms + walk.next, signals->coefficients, t, w, dw, largest);
    for (const bg_term *term = bg_next_term(&walk); term; term = bg_next_term(&walk))
        add_term(term, signals->coefficients, t, w, dw, largest);
    for (int i = 0; i < BG_EXTERNAL; i++)
        if (w[i] != 0.0 && fabs(w[i]) <= BG_CANCELLED * largest[i] /* else none: saves the look */
            && fabs(w[i]) <= rounding(signals, span, i, t))
            w[i] = 0.0;
}

double bg_signals_one(const bg_signals *signals, int at, double t)
{
    const bg_span span = bg_signals_span(signals, t);
    bg_term_walk walk = bg_walk_terms(signals, &span);
    double value = 0.0, slope = 0.0;
    for (const bg_term *term = bg_next_term(&walk); term; term = bg_next_term(&walk))
        if (term->input == at)
            bg_term_add(term, signals->coefficients, t, &value, &slope);
    return value;
}

double bg_reached(double t)
{
    return t + 8 * DBL_EPSILON * fabs(t);
}

bg_span bg_signals_span(const bg_signals *signals, double t)
{
    bg_span span = bg_span_at(signals->segments, signals->breaks, t);
    for (int i = 0; i < signals->waves; i++) {
        double begin;
        bg_wave_part(signals, signals->wave + i, t, &begin);
        span.begin = fmax(span.begin, begin);
        span.following = fmin(span.following, bg_wave_following(signals, signals->wave + i, t));
    }
    return span;
}

double bg_signals_fastest(const bg_signals *signals, const bg_span *span)
{
    double fastest = signals->fastest[span->segment];
    for (int i = 0; i < signals->waves; i++)
        fastest = fmax(fastest, signals->wave[i].fastest);
    return fastest;
}
