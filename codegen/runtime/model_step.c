/* One step in bounded time. Which ports stick is decided at its start by Karnopp's dead band, in at
 * most 4 evaluations for each port near rest; then the step is one of Runge's and Kutta's. */
#include <math.h>
#include <string.h>

#include "model_internal.h"

enum { K = BG_FRICTION, N = BG_STATES, M = BG_INPUTS };
#define PORTS BG_ROOM(BG_FRICTION)
static const double ROUNDING = 1e-9; /* of what makes up a slip or its rate */

/* Rates of the external inputs of the parabola through their three values. */
static void external_rates(double h, const double *w, double rates[3][BG_ROOM(BG_EXTERNAL)])
{
    for (int i = 0; i < BG_EXTERNAL; i++) {
        const double a = w[i], b = w[BG_EXTERNAL + i], c = w[2 * BG_EXTERNAL + i];
        rates[0][i] = (4 * b - 3 * a - c) / h;
        rates[1][i] = (c - a) / h;
        rates[2][i] = (3 * c + a - 4 * b) / h;
    }
}

static int sticks(const int *mode)
{
    int any = 0;
    for (int i = 0; i < K; i++)
        any |= mode[i] == 0;
    return any;
}

/* How fast a port's slip changes, and in `terms` the magnitude of what makes that up. */
static double slip_rate(const bg_model *m, int port, double *terms)
{
    const bg_numbers *const a = &m->numbers;
    const bg_snapshot *const now = &m->shot;
    const double *const row = a->F + bg_friction_readings[port] * N;
    double sum = 0.0;
    *terms = 0.0;
    for (int i = 0; i < N; i++) {
        double rate = 0.0, size = 0.0;
        for (int j = 0; j < N; j++) {
            rate += a->P[i * N + j] * now->x[j];
            size += fabs(a->P[i * N + j]) * fabs(now->x[j]);
        }
        for (int j = 0; j < M; j++) {
            rate += a->Q[i * M + j] * now->u[j] + a->R[i * M + j] * now->du[j];
            size += fabs(a->Q[i * M + j]) * fabs(now->u[j]);
        }
        sum += row[i] * rate;
        *terms += fabs(row[i]) * size;
    }
    for (int j = 0; j < M; j++)
        sum += a->D[bg_friction_readings[port] * M + j] * now->du[j];
    return sum;
}

/* The slip of a port, and in `terms` the magnitude of what makes it up. */
static double slip_now(const bg_model *m, int port, double *terms)
{
    const int row = bg_friction_readings[port];
    *terms = 0.0;
    for (int i = 0; i < N; i++)
        *terms += fabs(m->numbers.F[row * N + i]) * fabs(m->shot.x[i]);
    for (int j = 0; j < M; j++)
        *terms += fabs(m->numbers.D[row * M + j]) * fabs(m->shot.u[j]);
    return m->shot.y[row];
}

/* A port may stick if its slip is inside the band, has changed its sign since the step before, by
 * no more than a step of h can, or depends on its effort at once. First guess: all these stick;
 * their number. */
static int first_guess(bg_model *m, double h, int *near)
{
    int count = 0;
    for (int i = 0; i < K; i++) {
        double around, terms;
        const double slip = slip_now(m, i, &around), rate = slip_rate(m, i, &terms);
        near[i] = fabs(slip) <= fmax(m->band[i], ROUNDING * around) || bg_beside[i];
        /* An input that steps may turn a slip round too; what a step can't reach slips on. */
        near[i] |= m->started && slip * m->mode[i] < 0 && fabs(slip) <= 2 * h * fabs(rate);
        m->mode[i] = near[i] ? 0 : slip > 0 ? 1 : -1;
        count += near[i];
    }
    return count;
}

/* Lets the sticking port go that is held farthest beyond its breakaway effort; 0: there is none. */
static int let_go(bg_model *m)
{
    double worst = 0.0, most = 0.0;
    int found = -1;
    for (int i = 0; i < K; i++)
        most = fmax(most, fabs(m->shot.u[bg_friction_inputs[i]]));
    for (int i = 0; i < K; i++) {
        const double effort = fabs(m->shot.u[bg_friction_inputs[i]]), cap = m->shot.caps[i];
        const double over = m->mode[i] == 0 ? effort - cap * (1 + 1e-12) : 0.0;
        if (over > 0 && (found < 0 || over / (cap + 1e-12 * most) > worst)) {
            found = i;
            worst = over / (cap + 1e-12 * most);
        }
    }
    if (found >= 0)
        m->mode[found] = m->shot.u[bg_friction_inputs[found]] > 0 ? 1 : -1;
    return found >= 0;
}

/* Catches a port let go that would slip against its direction; 0: there is none. */
static int caught(bg_model *m, const int *near)
{
    for (int i = 0; i < K; i++) {
        double terms, moves;
        if (!near[i] || m->mode[i] == 0)
            continue;
        moves = bg_beside[i] ? slip_now(m, i, &terms) : slip_rate(m, i, &terms);
        if (moves * m->mode[i] < -ROUNDING * terms) {
            m->mode[i] = 0;
            return 1;
        }
    }
    return 0;
}

/* The mode of a step; one port changes at a time. */
static int decide(bg_model *m, double t, double h, const double *s, const double *w,
                  const double *dw)
{
    int slipping[PORTS], near[PORTS], status, tries;
    for (int i = 0; i < K; i++)
        slipping[i] = m->started && m->mode[i] != 0 ? m->mode[i] : 1;
    status = bg_evaluate(m, t, s, w, dw, slipping, 1, &m->shot);
    tries = status == BG_OK ? 4 * first_guess(m, h, near) : 0;
    m->started = status == BG_OK;
    for (int k = 0; k < tries; k++) {
        status = bg_evaluate(m, t, s, w, dw, m->mode, 1, &m->shot);
        if (status != BG_OK || (!let_go(m) && !caught(m, near)))
            return status;
    }
    return status;
}

int bg_model_settle(bg_model *m, double t, double h, double *s, const double *w)
{
    int status;
    if (!(h > 0) || !isfinite(h))
        return BG_BAD_STEP;
    if (K == 0)
        return BG_OK;
    if (BG_RATED)
        external_rates(h, w, m->work.rates);
    status = decide(m, t, h, s, w, m->work.rates[0]);
    if (status != BG_OK || !sticks(m->mode))
        return status;
    status = bg_evaluate(m, t, s, w, m->work.rates[0], m->mode, 1, &m->shot);
    return status == BG_OK ? bg_remove_slips(m, m->mode, &m->shot, s) : status;
}

int bg_model_advance(bg_model *m, double t, double h, double *s, const double *w)
{
    static const double along[4] = {0.0, 0.5, 0.5, 1.0};
    static const int instant[4] = {0, 1, 1, 2};
    bg_work *const work = &m->work;
    if (!(h > 0) || !isfinite(h))
        return BG_BAD_STEP;
    if (BG_RATED)
        external_rates(h, w, work->rates);
    for (int k = 0; k < 4; k++) {
        const int at = instant[k];
        int status;
        for (int i = 0; i < BG_SIZE; i++)
            work->point[i] = k > 0 ? s[i] + along[k] * h * work->stage[k - 1][i] : s[i];
        status = bg_evaluate(m, t + along[k] * h, work->point, w + at * BG_EXTERNAL,
                             work->rates[at], m->mode, 1, &m->shot);
        if (status != BG_OK)
            return status;
        memcpy(work->stage[k], m->shot.rate, sizeof work->stage[k]);
        if (BG_CHECK_STEP && k == 0)
            status = bg_check_step(m, t, h, s, w);
        if (status != BG_OK)
            return status;
    }
    if (BG_CHECK_STEP)
        bg_note_stages(m);
    for (int i = 0; i < BG_SIZE; i++)
        s[i] += h / 6 * (work->stage[0][i] + 2 * work->stage[1][i] + 2 * work->stage[2][i]
                         + work->stage[3][i]);
    return bg_finite(BG_SIZE, s) ? BG_OK : BG_NOT_FINITE;
}

int bg_model_step(bg_model *m, double t, double h, double *s, const double *w)
{
    const int status = bg_model_settle(m, t, h, s, w);
    return status == BG_OK ? bg_model_advance(m, t, h, s, w) : status;
}
