/* Jumps of second order in affine modes: what they hang on, which is the same in each. */
#include "exact_internal.h"

#include <math.h>

int ex_hangs(const ex_context *c, int port)
{
    return c->model->hung && bg_hangs(c->model->switches + port);
}

/* The magnitude of the terms. */
static double terms_at(const ex_mode *mode, int port, const double *v)
{
    double sum = 0.0;
    for (int j = 0; j < EX_L; j++)
        sum += fabs(mode->stay[j][port] * v[j]);
    return sum;
}

void ex_hang(const ex_context *c, const ex_mode *mode, const double *v, bg_port *ports)
{
    for (int i = 0; i < EX_K; i++) {
        if (!ex_hangs(c, i))
            continue;
        ports[i].gap = 0.0;
        for (int j = 0; j < EX_L; j++)
            ports[i].gap += mode->stay[j][i] * v[j];
    }
}

void ex_round_hung(const ex_context *c, const ex_mode *mode, const double *v, double t,
                   bg_port *ports)
{
    const double spacing = nextafter(fabs(t), INFINITY) - fabs(t);
    ex_hang(c, mode, v, ports);
    for (int i = 0; i < EX_K; i++)
        if (ex_hangs(c, i))
            bg_count_leaps(ports + i, bg_greater(terms_at(mode, i, v), c->farthest[i]),
                           c->model->inertia[i], spacing);
}

void ex_see_hung(ex_context *c, const ex_mode *mode, const double *v)
{
    for (int i = 0; i < EX_K; i++)
        if (ex_hangs(c, i))
            c->farthest[i] = bg_greater(c->farthest[i], terms_at(mode, i, v));
}
