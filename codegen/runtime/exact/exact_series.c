/* Steps by power series, in which no event can hide. */
#include "exact_internal.h"

#include <math.h>
#include <string.h>

/* next = factor (M term + constant), in two sums that don't wait for each other */
static inline void differentiate(const ex_entry *e, const double *restrict term,
                                 const double *restrict constant, double factor,
                                 double *restrict next)
{
#pragma GCC unroll 1
    for (int i = 0; i < EX_Z; i++) {
        double sum = constant[i], other = 0.0;
#pragma GCC unroll 32
        for (int j = 0; j < EX_Z / 2; j++)
            sum += e->M[j][i] * term[j];
#pragma GCC unroll 32
        for (int j = EX_Z / 2; j < EX_Z; j++)
            other += e->M[j][i] * term[j];
        next[i] = (sum + other) * factor;
    }
}

/* The powers of the state, z(tau) = sum terms[k] tau^k over a step. */
static void expand(ex_context *c, const double *z, double step)
{
    const ex_entry *e = c->stretch.entry;
    double(*terms)[EX_Z] = c->terms;
    const double none[EX_Z] = {0};
    for (int i = 0; i < EX_Z; i++)
        terms[0][i] = z[i];
    for (int k = 1; k <= BG_DEGREE; k++)
        differentiate(e, terms[k - 1], k == 1 ? c->stretch.b : none, step / k, terms[k]);
}

/* The same of the triggers. */
static void expand_triggers(ex_context *c)
{
    const ex_entry *e = c->stretch.entry;
    for (int k = 0; k <= BG_DEGREE; k++)
        for (int i = 0; i < EX_T; i++) {
            double sum = k ? 0.0 : c->stretch.level[i];
            for (int j = 0; j < EX_Z; j++)
                sum += e->trigger[j][i] * c->terms[k][j];
            c->powers[i][k] = sum;
        }
}

static void state(const ex_context *c, double tau, double *z)
{
    for (int i = 0; i < EX_Z; i++)
        z[i] = c->terms[BG_DEGREE][i];
    for (int k = BG_DEGREE - 1; k >= 0; k--)
        for (int i = 0; i < EX_Z; i++)
            z[i] = z[i] * tau + c->terms[k][i];
}

/* A trigger that began at zero is armed when it has risen; until then it may be lost, after a
 * moment in which nothing counts. 1: lost at *root. 0: armed at *root, or neither (*root is 2). */
static int arm(ex_context *c, int trigger, double elapsed, double step, double *root)
{
    const double *p = c->powers[trigger], limit = c->stretch.limit[trigger];
    double rise[BG_DEGREE + 1], fall[BG_DEGREE + 1], armed = 0.0, lost;
    *root = 0.0;
    if (p[0] >= limit) {
        c->stretch.armed[trigger] = 1;
        return 0;
    }
    for (int k = 0; k <= BG_DEGREE; k++) {
        rise[k] = -p[k];
        fall[k] = p[k];
    }
    rise[0] += limit;
    fall[0] += 2.0 * limit;
    const int rises = ex_first_fall(rise, 0.0, &armed);
    const double blind = bg_lesser(bg_greater((c->stretch.blind - elapsed) / step, 0.0), 1.0);
    lost = blind;
    const int falls = ex_value(fall, blind) <= 0 ? 1 : ex_first_fall(fall, blind, &lost);
    if (rises < 0 || falls < 0)
        return -1;
    *root = 2.0;
    if (!rises || (falls && lost < armed)) {
        if (!falls || lost >= 1.0)
            return 0;
        *root = lost;
        return 1;
    }
    c->stretch.armed[trigger] = 1;
    *root = armed;
    return 0;
}

/* Where one trigger falls in a step: 1 if it does, 0 if not, -1 if the search has no end. */
static int fall(ex_context *c, int trigger, double elapsed, double step, double *root)
{
    double begin = 0.0, sum = 0.0, below[BG_DEGREE + 1], again;
    if (!c->stretch.armed[trigger]) {
        const int lost = arm(c, trigger, elapsed, step, root);
        if (lost || *root > 1.0)
            return lost;
        begin = *root;
    }
    const int found = ex_first_fall(c->powers[trigger], begin, root);
    if (found <= 0)
        return found;
    for (int k = 0; k <= BG_DEGREE; k++) {
        below[k] = c->powers[trigger][k];
        sum += below[k];
    }
    if (sum <= 0)
        return 1;
    /* It comes back: a touch, unless it fell below zero by more than rounding. */
    below[0] += c->stretch.limit[trigger];
    return ex_first_fall(below, *root, &again);
}

/* The first event of a step that has been expanded, in all ports that have it. */
static int event(ex_context *c, double t, double step, double *tau, bg_set *ports)
{
    double roots[EX_PORTS];
    *tau = 2.0;
    memset(ports, 0, sizeof *ports);
    for (int i = 0; i < EX_K; i++) {
        const int triggers = ex_single(c, c->stretch.entry->mode, i) ? 1 : 2;
        roots[i] = 2.0;
        for (int k = 0; k < triggers; k++) {
            double root = 2.0;
            const int found = fall(c, 2 * i + k, t - c->stretch.t, step, &root);
            if (found < 0)
                return BG_WORK;
            if (found && root < roots[i])
                roots[i] = root;
        }
        *tau = bg_lesser(*tau, roots[i]);
    }
    const double near = *tau + BG_TOGETHER * bg_greater(1.0, t / step);
    for (int i = 0; i < EX_K; i++)
        if (*tau <= 1.0 && roots[i] <= bg_lesser(near, 1.5))
            bg_add(ports, i);
    return BG_OK;
}

int ex_series(ex_context *c, double t, double length, double *z, double *end, bg_set *ports)
{
    const double parts = bg_greater(ceil(c->stretch.entry->norm * length), 1.0);
    memset(ports, 0, sizeof *ports);
    *end = t + length;
    if (length <= 0.0)
        return BG_OK;
    const double step = length / parts;
    for (double part = 0.0; part < parts; part += 1.0) {
        const double from = t + part * step;
        double tau;
        expand(c, z, step);
        expand_triggers(c);
        const int status = event(c, from, step, &tau, ports);
        if (status)
            return status;
        if (!bg_is_empty(ports)) {
            state(c, tau, z);
            ex_see_places(c, z);
            *end = from + tau * step;
            return BG_OK;
        }
        state(c, 1.0, z);
        ex_see_places(c, z);
    }
    return BG_OK;
}

void ex_glide(ex_context *c, double length, double *z)
{
    const double parts = bg_greater(ceil(c->stretch.entry->norm * length), 1.0);
    for (double part = 0.0; length > 0.0 && part < parts; part += 1.0) {
        expand(c, z, length / parts);
        state(c, 1.0, z);
    }
}
