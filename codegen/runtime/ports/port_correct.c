/* The end of a step: what slips would have gone through zero is stopped, or turned round, by what
 * ports give over the step in the mean (J. J. Moreau, 1988; M. Anitescu, F. A. Potra, 1997): one
 * linear complementarity problem at velocity level. A step in which nothing changes stays what its
 * method made of it. */
#include <math.h>
#include <string.h>

#include "model_internal.h"

void bg_note_given(bg_model *m, double part, int begins)
{
    double *const mean = m->work.mean, *const caps = m->work.mean_caps;
    for (int i = 0; i < K; i++) {
        if (begins)
            m->work.begun[i] = m->shot.y[bg_friction_readings[i]];
        mean[i] += part * m->shot.u[bg_friction_inputs[i]];
        caps[i] += part * m->shot.caps[i];
    }
}

/* Bounds of what friction gives: over the step as it was, or if it stuck by its level at rest. */
static void bound_friction(const bg_model *m, const double *values, int i, bg_boxed *b)
{
    const double given = m->work.mean[i], cap = fmax(0.0, m->work.mean_caps[i]);
    const double at_end = values[4 * i + 1], rest = values[4 * i] * values[4 * i + 3];
    const double level = m->mode[i] ? fabs(given)
        : at_end > 0.0              ? cap * fmin(1.0, rest / at_end)
                                    : cap;
    bg_bound_friction(i, level, cap, m->mode[i] == 0, b);
}

/* The problem at the end of a step; 1 if slips contradict the mode, and the part of the step
 * that is left after the first of them went through zero. */
static int find_last(bg_model *m, bg_boxed *b, double *after)
{
    double values[4 * PORTS] = {0};
    int broken = 0;
    bg_friction_values(&m->now, values);
    for (int i = 0; i < K; i++) {
        double terms;
        const double slip = bg_slip(m, &m->shot, i, &terms);
        b->given[i] = m->work.mean[i];
        b->near[i] = BG_STEP_ROUNDING * terms;
        b->slip[i] = m->mode[i] ? slip : 0.0;
        bg_bound_switch(i, m->mode[i], 1, b);
        if (bg_switches[i].kind == BG_RUBS)
            bound_friction(m, values, i, b);
        bg_hang_on(i, b);
        if (b->least[i] == b->most[i] || !(b->way[i] * slip < -b->near[i]))
            continue;
        const double begun = m->work.begun[i];
        const double past = begun * slip < 0.0 ? slip / (slip - begun) : 1.0;
        *after = fmax(*after, past);
        broken = 1;
    }
    return broken;
}

/* Slips that solving leaves of what is held now. */
static void come_to_rest(bg_model *m, double t, double *s, const double *w)
{
    int held = 0;
    for (int i = 0; i < K; i++)
        held |= m->mode[i] == 0;
    if (held && bg_evaluate(m, t, s, w, m->work.rates[2], m->mode, 1, &m->shot) == BG_OK)
        bg_remove_slips(m, m->mode, &m->shot, s);
}

int bg_correct_step(bg_model *m, double t, double h, double *s, const double *w)
{
    bg_boxed *const b = &m->work.box;
    double change[PORTS], after = 0.0;
    if (K == 0 || bg_evaluate(m, t, s, w, m->work.rates[2], m->mode, 1, &m->shot) != BG_OK)
        return BG_OK; /* whoever begins the next step tells */
    if (BG_ROSENBROCK)
        bg_note_given(m, 0.5, 0);
    if (!find_last(m, b, &after))
        return BG_OK;
    /* What is more or less than was given is so after the slip has gone through zero. */
    bg_respond(m, h, 0.5 * after * h, &m->work.response);
    if (!bg_yields(m, &m->work.response, m->work.yields, b->reversed)) {
        bg_respond(m, h, h, &m->work.response);
        bg_yields(m, &m->work.response, m->work.yields, b->reversed);
    }
    const int status = bg_box_solve(K, b, m->work.yields, m->work.system);
    for (int i = 0; i < K; i++)
        change[i] = b->given[i] - m->work.mean[i];
    bg_push(&m->work.response, change, s);
    bg_take_ways(b, 0, m->mode);
    come_to_rest(m, t, s, w);
    return status;
}
