/* External inputs: what the importer gives, and the sources inside. */
#include <float.h>
#include <math.h>

#include "fmu_common.h"

/* Adds the real part of p(tau) exp(r tau), and its slope. */
static void add_term(const fmu_term *term, double tau, double *value, double *slope)
{
    double p[2] = {0.0, 0.0}, d[2] = {0.0, 0.0};
    const double *const r = term->rate;
    const double size = exp(r[0] * tau), cosine = cos(r[1] * tau), sine = sin(r[1] * tau);
    for (int k = term->count - 1; k >= 0; k--) {
        d[0] = d[0] * tau + p[0];
        d[1] = d[1] * tau + p[1];
        p[0] = p[0] * tau + fmu_coefficients[term->first + k][0];
        p[1] = p[1] * tau + fmu_coefficients[term->first + k][1];
    }
    d[0] += r[0] * p[0] - r[1] * p[1];
    d[1] += r[0] * p[1] + r[1] * p[0];
    *value += size * (p[0] * cosine - p[1] * sine);
    *slope += size * (d[0] * cosine - d[1] * sine);
}

/* Time since a piece began. One is entered a rounding before its start and never continued back from
 * there: a torque that rises from zero would be below zero. The first has no start. */
static double since(const fmu_piece *piece, int segment, double t)
{
    return segment > 0 ? fmax(t - piece->start, 0.0) : t - piece->start;
}

/* Values and rates at t; what the importer gives goes on from the instance's time with its slope. */
void fmu_externals(const fmu_instance *f, double t, double *w, double *dw)
{
    for (int i = 0; i < BG_EXTERNAL; i++) {
        w[i] = f->at.given[i] + f->at.slopes[i] * (t - f->at.time);
        dw[i] = f->at.slopes[i];
    }
    for (int k = 0; k < FMU_SOURCES; k++) {
        const fmu_source *source = &fmu_sources[k];
        const fmu_piece *piece = &fmu_pieces[source->first_piece + f->at.segment[k]];
        const double tau = since(piece, f->at.segment[k], t);
        const int i = source->external;
        w[i] = dw[i] = 0.0;
        for (int j = 0; j < piece->count; j++)
            add_term(&fmu_terms[piece->first + j], tau, &w[i], &dw[i]);
    }
}

/* A breakpoint counts as reached a rounding before it. */
static int reached(double t, double point)
{
    return point <= t + 8 * DBL_EPSILON * fmax(fabs(t), fabs(point));
}

void fmu_pass(fmu_instance *f, double t)
{
    for (int k = 0; k < FMU_SOURCES; k++) {
        const fmu_source *source = &fmu_sources[k];
        int *const segment = &f->at.segment[k];
        *segment = 0;
        while (*segment < source->breaks && reached(t, fmu_breaks[source->first_break + *segment]))
            ++*segment;
    }
    f->stale = 1;
}

int fmu_next_break(const fmu_instance *f, double *time)
{
    int any = 0;
    for (int k = 0; k < FMU_SOURCES; k++) {
        const fmu_source *source = &fmu_sources[k];
        const int segment = f->at.segment[k];
        if (segment < source->breaks) {
            const double next = fmu_breaks[source->first_break + segment];
            *time = any && *time < next ? *time : next;
            any = 1;
        }
    }
    return any;
}
