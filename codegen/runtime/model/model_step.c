/* One step in bounded time. Which ports stick is decided at its start; then the step is one of
 * Runge's and Kutta's. */
#include <math.h>
#include <string.h>

#include "model_internal.h"

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

int bg_model_settle(bg_model *m, double t, double h, double *s, const double *w)
{
    int status, sticking = 0;
    if (!(h > 0) || !isfinite(h))
        return BG_BAD_STEP;
    if (K == 0)
        return BG_OK;
    bg_have_seen(m, s);
    if (BG_RATED)
        external_rates(h, w, m->work.rates);
    status = bg_decide_step(m, t, h, s, w);
    for (int i = 0; i < K; i++)
        sticking |= m->mode[i] == 0;
    if (status == BG_OK && sticking)
        status = bg_remove_slips(m, m->mode, &m->shot, s);
    return status == BG_OK ? m->decided : status;
}

/* A step in the mode, of Runge's and Kutta's fourth order. */
static int run_on(bg_model *m, double t, double h, double *s, const double *w)
{
    static const double along[4] = {0.0, 0.5, 0.5, 1.0};
    static const int instant[4] = {0, 1, 1, 2};
    static const double part[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    bg_work *const work = &m->work;
    memset(work->mean, 0, sizeof work->mean);
    memset(work->mean_caps, 0, sizeof work->mean_caps);
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
        bg_note_given(m, part[k]);
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

int bg_model_advance(bg_model *m, double t, double h, double *s, const double *w)
{
    if (!(h > 0) || !isfinite(h))
        return BG_BAD_STEP;
    if (BG_RATED)
        external_rates(h, w, m->work.rates);
    m->work.unshared = OWN == 0 && !BG_JOINT;
    int status = run_on(m, t, h, s, w);
    if (status == BG_OK)
        status = bg_correct_step(m, t + h, h, s, w + 2 * BG_EXTERNAL);
    m->work.unshared = 0;
    return status;
}

int bg_model_step(bg_model *m, double t, double h, double *s, const double *w)
{
    const int decided = bg_model_settle(m, t, h, s, w);
    const int status = bg_is_taken(decided) ? bg_model_advance(m, t, h, s, w) : decided;
    return status == BG_OK ? decided : status;
}
