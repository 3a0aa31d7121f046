/* A step in one mode by Runge's and Kutta's classical method of fourth order. */
#include <string.h>

#include "model_internal.h"

int bg_runge_kutta(bg_model *m, double t, double h, double *s, const double *w)
{
    static const double along[4] = {0.0, 0.5, 0.5, 1.0};
    static const int instant[4] = {0, 1, 1, 2};
    static const double part[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    bg_work *const work = &m->work;
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
        bg_note_given(m, part[k], k == 0);
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
