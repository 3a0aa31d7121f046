/* One step in bounded time: which ports hold is decided at its start, then it is one of a
 * method's in that mode, and what changes inside it is made up for at its end. */
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

int bg_model_advance(bg_model *m, double t, double h, double *s, const double *w)
{
    if (!(h > 0) || !isfinite(h))
        return BG_BAD_STEP;
    if (BG_RATED)
        external_rates(h, w, m->work.rates);
    memset(m->work.mean, 0, sizeof m->work.mean);
    memset(m->work.mean_caps, 0, sizeof m->work.mean_caps);
    m->work.unshared = OWN == 0 && !BG_JOINT;
    int status = BG_ROSENBROCK ? bg_rosenbrock(m, t, h, s, w) : bg_runge_kutta(m, t, h, s, w);
    if (bg_is_taken(status)) {
        const int corrected = bg_correct_step(m, t + h, h, s, w + 2 * BG_EXTERNAL);
        status = corrected == BG_OK ? status : corrected;
    }
    m->work.unshared = 0;
    return status;
}

int bg_model_step(bg_model *m, double t, double h, double *s, const double *w)
{
    const int decided = bg_model_settle(m, t, h, s, w);
    const int status = bg_is_taken(decided) ? bg_model_advance(m, t, h, s, w) : decided;
    return status == BG_OK ? decided : status;
}
