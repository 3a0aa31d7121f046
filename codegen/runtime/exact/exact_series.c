/* Steps by power series, in which no event can hide. */
#include "exact_internal.h"

#include <math.h>
#include <string.h>

/* The magnitude of a term, as the norm of M has it. */
static double weighed(const ex_entry *e, const double *term)
{
    double sum = 0.0, other = 0.0;
    for (int i = 0; i < EX_Z / 2; i++)
        sum += e->weight[i] * fabs(term[i]);
    for (int i = EX_Z / 2; i < EX_Z; i++)
        other += e->weight[i] * fabs(term[i]);
    return sum + other;
}

/* The powers of the state, z(tau) = sum terms[k] tau^k over a step, and those of the triggers: as many
 * as count: one is no larger than |M| step over its number times the one before, but of inputs that
 * are polynomials all count. */
static void expand(ex_context *c, const double *z, double step)
{
    const ex_entry *const e = c->stretch.entry;
    double(*const terms)[EX_Z] = c->terms;
    EX_ALIGNED double next[EX_WIDE];
    double first = 0.0;
    int k = 0, more = 1;
    memcpy(terms[0], z, sizeof terms[0]);
    do {
        const double share = step / ++k;
        ex_differentiate(e, terms[k - 1], next);
        for (int i = 0; i < EX_Z; i++)
            terms[k][i] = ((k == 1 ? c->stretch.b[i] : 0.0) + next[i]) * share;
        for (int i = 0; i < EX_T; i++)
            c->powers[i].at[k - 1] = (k == 1 ? c->stretch.level[i] : 0.0) + next[EX_Z + i];
        if (k == 1)
            first = weighed(e, terms[1]);
        else if (k > e->least)
            more = weighed(e, terms[k]) > BG_LEFT_OUT * first;
    } while (more && k < BG_POWERS);
    c->degree = k;
    for (int i = 0; i < EX_T; i++)
        c->powers[i].degree = k - 1;
}

static void state(const ex_context *c, double tau, double *z)
{
    memcpy(z, c->terms[c->degree], sizeof c->terms[0]);
    for (int k = c->degree - 1; k >= 0; k--)
        for (int i = 0; i < EX_Z; i++)
            z[i] = z[i] * tau + c->terms[k][i];
}

/* A trigger that began at zero is armed when it has risen; until then it may be lost, after a
 * moment in which nothing counts. 1: lost at *root. 0: armed at *root, or neither (*root is 2). */
static int arm(ex_context *c, int trigger, double elapsed, double step, double *root)
{
    const ex_powers *const p = c->powers + trigger;
    const double limit = c->stretch.limit[trigger];
    ex_powers rise = *p, fall = *p;
    double armed = 0.0, lost;
    *root = 0.0;
    if (p->at[0] >= limit) {
        c->stretch.armed[trigger] = 1;
        return 0;
    }
    *root = 2.0;
    if (ex_only_rises(p, limit)) {
        c->stretch.armed[trigger] = ex_value(p, 1.0) >= limit;
        return 0;
    }
    for (int k = 0; k <= p->degree; k++)
        rise.at[k] = -p->at[k];
    rise.at[0] += limit;
    fall.at[0] += 2.0 * limit;
    const int rises = ex_first_fall(&rise, 0.0, &armed);
    const double blind = bg_lesser(bg_greater((c->stretch.blind - elapsed) / step, 0.0), 1.0);
    lost = blind;
    const int falls = ex_value(&fall, blind) <= 0 ? 1 : ex_first_fall(&fall, blind, &lost);
    if (rises < 0 || falls < 0)
        return -1;
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
    const ex_powers *const p = c->powers + trigger;
    double begin = 0.0, again;
    if (!c->stretch.armed[trigger]) {
        const int lost = arm(c, trigger, elapsed, step, root);
        if (lost || *root > 1.0)
            return lost;
        begin = *root;
    }
    const int found = ex_first_fall(p, begin, root);
    if (found <= 0 || ex_value(p, 1.0) <= 0)
        return found;
    /* It comes back: a touch, unless it fell below zero by more than rounding. */
    ex_powers below = *p;
    below.at[0] += c->stretch.limit[trigger];
    return ex_first_fall(&below, *root, &again);
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

static double parts_of(const ex_context *c, double length)
{
    return bg_greater(ceil(c->stretch.entry->norm * length / BG_LONGEST), 1.0);
}

int ex_series(ex_context *c, double t, double length, double *z, double *end, bg_set *ports)
{
    const double parts = parts_of(c, length);
    memset(ports, 0, sizeof *ports);
    *end = t + length;
    if (length <= 0.0)
        return BG_OK;
    const double step = length / parts;
    for (double part = 0.0; part < parts; part += 1.0) {
        const double from = t + part * step;
        double tau;
        expand(c, z, step);
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
    const double parts = parts_of(c, length);
    for (double part = 0.0; length > 0.0 && part < parts; part += 1.0) {
        expand(c, z, length / parts);
        state(c, 1.0, z);
    }
}
