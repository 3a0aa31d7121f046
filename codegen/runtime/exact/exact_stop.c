/* Stops of affine modes: their gaps, which change with one displacement each. */
#include "exact_glance.h"

#include <math.h>

int ex_is_apart(const ex_context *c, int port)
{
    return c->model->stopping && bg_is_apart(c->model->switches + port, c->run.mode[port]);
}

void ex_gaps(const ex_context *c, const double *s, bg_port *ports)
{
    const ex_model *const m = c->model;
    for (int i = 0; i < EX_K && m->stopping; i++) {
        if (m->switches[i].kind != BG_STOPS)
            continue;
        ports[i].gap = m->room[i] + m->switches[i].opening * s[m->switches[i].place];
        ports[i].back = m->back[i];
    }
}

void ex_round_gaps(const ex_context *c, const double *s, const double *rate, double t, bg_port *ports)
{
    const double spacing = nextafter(fabs(t), INFINITY) - fabs(t);
    ex_gaps(c, s, ports);
    for (int i = 0; i < EX_K && c->model->stopping; i++) {
        const bg_switch *const one = c->model->switches + i;
        if (one->kind == BG_STOPS)
            ports[i].near_gap = bg_gap_rounding(one, ports[i].gap, s[one->place], rate[one->place],
                                                c->farthest[i], spacing);
    }
}

void ex_see_places(ex_context *c, const double *s)
{
    for (int i = 0; i < EX_K && c->model->stopping; i++)
        if (c->model->switches[i].kind == BG_STOPS)
            c->farthest[i] = bg_greater(c->farthest[i], fabs(s[c->model->switches[i].place]));
}

void ex_watch_gaps(const ex_context *c, int column, double *stay)
{
    const ex_model *const m = c->model;
    for (int i = 0; i < EX_K; i++)
        if (ex_is_apart(c, i)) {
            const int own = column == m->switches[i].place;
            stay[i] = column < 0 ? m->room[i] : own ? m->switches[i].opening : 0.0;
        }
}

int ex_bar_stops(ex_glance *g, const int *before)
{
    const ex_model *const m = g->c->model;
    for (int i = 0; i < EX_K && m->stopping; i++) {
        const bg_switch *const one = m->switches + i;
        double row[EX_L] = {0};
        if (one->kind != BG_STOPS)
            continue;
        row[one->place] = one->opening;
        row[EX_L - 1] = m->room[i];
        const double most = g->to->most[one->place];
        const double near = bg_gap_rounding(one, m->room[i] + one->opening * most, most, g->rate[i],
                                            most, nextafter(g->to->until, INFINITY) - g->to->until);
        if (!bg_is_apart(one, before[i]) || g->c->run.at.touched[i]
            || !ex_ask(g, row, 1.0, near * (1.0 + BG_BOUND_SLACK)))
            return 0;
        bg_add(&g->barred, i);
    }
    return 1;
}
