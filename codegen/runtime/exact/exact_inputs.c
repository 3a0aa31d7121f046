/* Inputs: chains of polynomials times exponentials between breakpoints. */
#include "exact_internal.h"

#include <float.h>
#include <math.h>

int ex_span(const ex_inputs *inputs, double t, bg_span *span)
{
    const int here = t >= inputs->since && t < inputs->until;
    if (!here && inputs->more && inputs->more(inputs->self, t))
        return BG_NOT_AFFINE;
    *span = bg_span_at(inputs->segments, inputs->breaks, t);
    if (span->segment == 0)
        span->begin = inputs->since;
    if (span->segment + 1 == inputs->segments)
        span->following = inputs->until;
    return BG_OK;
}

/* The derivative of order `order` of a polynomial, one of every `width` coefficients. */
static double derivative(const double *c, int depth, int width, int order, double tau)
{
    double sum = 0.0;
    for (int k = depth - 1; k >= order; k--) {
        double factor = 1.0;
        for (int j = 0; j < order; j++)
            factor *= k - j;
        sum = sum * tau + factor * c[k * width];
    }
    return sum;
}

/* Whether a chain has the exponential of the one before. */
static int grows_alike(const ex_chains *chains, const double *start, int i)
{
    const double *const rate = chains->rate[i], *const before = chains->rate[i - 1];
    return rate[0] == before[0] && rate[1] == before[1] && start[i] == start[i - 1];
}

void ex_slots(const ex_inputs *inputs, int segment, double t, double *g)
{
    const ex_chains *chains = inputs->structures + inputs->chains[segment];
    const double *c = inputs->polynomial[segment], *start = inputs->start[segment];
    double re = 1.0, im = 0.0;
    for (int i = 0; i < EX_G; i++)
        g[i] = 0.0;
    for (int i = 0; i < chains->count; i++) {
        const int first = chains->first[i], depth = chains->depth[i], width = chains->width[i];
        const double tau = t - start[i];
        if (i == 0 || !grows_alike(chains, start, i)) {
            const double size = chains->rate[i][0] != 0.0 ? exp(chains->rate[i][0] * tau) : 1.0;
            const double turn = chains->rate[i][1] * tau;
            re = width == 2 ? size * cos(turn) : size;
            im = width == 2 ? size * sin(turn) : 0.0;
        }
        for (int k = 0; k < depth; k++) {
            const double a = derivative(c + first, depth, width, k, tau);
            if (width == 1) {
                g[first + k] = a * re;
                continue;
            }
            const double b = derivative(c + first + 1, depth, width, k, tau);
            g[first + 2 * k] = a * re - b * im;
            g[first + 2 * k + 1] = a * im + b * re;
        }
    }
}

void ex_given(const ex_inputs *inputs, int segment, const double *g, double *w, double *dw)
{
    const ex_chains *chains = inputs->structures + inputs->chains[segment];
    for (int j = 0; j < EX_W; j++) {
        w[j] = inputs->constant[segment][j];
        dw[j] = 0.0;
    }
    for (int i = 0; i < chains->count; i++) {
        const int first = chains->first[i], width = chains->width[i], j = chains->input[i];
        w[j] += g[first];
        dw[j] += chains->rate[i][0] * g[first];
        if (width == 2)
            dw[j] -= chains->rate[i][1] * g[first + 1];
        if (chains->depth[i] > 1)
            dw[j] += g[first + width];
    }
}

void ex_input_sizes(const ex_inputs *inputs, int segment, double t, double *w)
{
    const ex_chains *chains = inputs->structures + inputs->chains[segment];
    const double *c = inputs->polynomial[segment], *start = inputs->start[segment];
    for (int j = 0; j < EX_W; j++)
        w[j] = fabs(inputs->constant[segment][j]);
    for (int i = 0; i < chains->count; i++) {
        const int width = chains->width[i];
        const double re = chains->rate[i][0], im = chains->rate[i][1], tau = t - start[i];
        double size = 0.0, slope = 0.0;
        for (int k = chains->depth[i] - 1; k >= 0; k--) {
            const double *const at = c + chains->first[i] + k * width;
            slope = slope * fabs(tau) + size;
            size = size * fabs(tau) + fabs(at[0]) + (width == 2 ? fabs(at[1]) : 0.0);
        }
        slope += (fabs(re) + fabs(im)) * size;
        const double late = DBL_EPSILON * (fabs(t) + fabs(start[i])) / BG_ROUNDING;
        w[chains->input[i]] += (size + late * slope) * (re != 0.0 ? exp(re * tau) : 1.0);
    }
}
