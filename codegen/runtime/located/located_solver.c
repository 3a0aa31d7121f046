/* Steps of either method, and what begins and interpolates them. */
#include <math.h>
#include <string.h>

#include "located_internal.h"

/* A first step from the sizes of the state, its rate and its rate's rate (Hairer, Norsett, Wanner,
 * Solving Ordinary Differential Equations I, section II.4); tried no further than to `stop`, beyond
 * which inputs go on as they never do. */
static int first_step(bg_located *c, double order, double stop)
{
    bg_solver *const s = &c->solver;
    double rate[BG_SIZE];
    for (int i = 0; i < BG_SIZE; i++)
        s->scale[i] = c->asked->atol + c->asked->rtol * fabs(s->y[i]);
    const double size = bg_norm(BG_SIZE, s->y, s->scale), slope = bg_norm(BG_SIZE, s->f, s->scale);
    const int tiny = size < BG_FIRST_SMALL || slope < BG_FIRST_SMALL;
    double h = tiny ? BG_FIRST_STEP : BG_FIRST_PART * size / slope;
    h = fmin(h, fmin(s->longest, stop - c->run.at.t));
    for (int i = 0; i < BG_SIZE; i++)
        s->tried[i] = s->y[i] + h * s->f[i];
    const int status = bg_located_rate(c, c->run.at.t + h, s->tried, rate);
    for (int i = 0; i < BG_SIZE; i++)
        rate[i] -= s->f[i];
    const double bend = status == BG_OK ? bg_norm(BG_SIZE, rate, s->scale) / h : INFINITY;
    const double most = fmax(slope, bend);
    const double next = most <= BG_FIRST_FLAT ? fmax(BG_FIRST_STEP, h * BG_FIRST_SHORTER)
                                              : pow(BG_FIRST_PART / most, 1.0 / order);
    s->next = fmin(fmin(100 * h, fmax(next, BG_FIRST_LEAST * s->longest)), s->longest);
    return status == BG_NOT_FINITE || status == BG_NO_SOLUTION ? BG_OK : status;
}

int bg_solver_begin(bg_located *c, int method, double longest, double stop)
{
    bg_solver *const s = &c->solver;
    s->method = method;
    s->longest = longest;
    s->begun = s->stale = s->factored = s->doubts = 0;
    s->t = s->t_old = c->run.at.t;
    memcpy(s->y, c->s, sizeof s->y);
    const int status = bg_located_rate(c, c->run.at.t, s->y, s->f);
    return status == BG_OK ? first_step(c, method == BG_RADAU ? 4.0 : 8.0, stop) : status;
}

int bg_solver_step(bg_located *c, double stop)
{
    c->solver.dense = 0;
    return c->solver.method == BG_RADAU ? bg_implicit_step(c, stop) : bg_explicit_step(c, stop);
}

int bg_solver_dense(bg_located *c, double t, double *s)
{
    bg_solver *const solver = &c->solver;
    int status = BG_OK;
    if (solver->method == BG_RADAU) {
        bg_implicit_at(solver, t, s);
        return BG_OK;
    }
    if (!solver->dense)
        status = bg_explicit_dense(c);
    solver->dense = 1;
    bg_explicit_at(solver, t, s);
    return status;
}
