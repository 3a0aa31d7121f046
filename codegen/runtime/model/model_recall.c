/* What delays give a model: its memory in a run, and in fixed steps what these read. */
#include <math.h>
#include <string.h>

#include "model_internal.h"
#include "model_signals.h"

/* Of each delay in turn what it reads, how late it is, and what it gives before. */
enum { TOLD = 3 };

int bg_set_lags(bg_model *m)
{
    double told[TOLD * BG_LAGS] = {0};
    bg_remembered *const is = &m->memory.is;
    bg_delaying(&m->now, told);
    for (int i = 0; i < BG_DELAYS; i++) {
        is->late[i] = told[TOLD * i + 1];
        is->start[i] = told[TOLD * i + 2];
        if (!(is->late[i] > 0.0) || !isfinite(is->late[i]) || !isfinite(is->start[i]))
            return BG_NOT_LATE;
    }
    return BG_OK;
}

void bg_model_remember(bg_model *m, const bg_remembered *was)
{
    bg_remembered *const is = &m->memory.is, own = *is;
    *is = *was;
    memcpy(is->late, own.late, sizeof is->late);
    memcpy(is->start, own.start, sizeof is->start);
}

void bg_read_late(const bg_model *m, double *values)
{
    double told[TOLD * BG_LAGS] = {0};
    bg_delaying(&m->now, told);
    for (int i = 0; i < BG_DELAYS; i++)
        values[i] = told[TOLD * i];
}

void bg_model_recall(const bg_model *m, double t, double *w, double *dw)
{
    double values[BG_LAGS], slopes[BG_LAGS];
    bg_memory_at(&m->memory, t, values, slopes);
    for (int i = 0; i < BG_DELAYS; i++) {
        w[BG_DELAYED_FROM + i] = values[i];
        if (dw)
            dw[BG_DELAYED_FROM + i] = slopes[i];
    }
}

void bg_pass_memory(bg_model *m, double t, double end, bg_span *span)
{
    bg_remembered *const is = &m->memory.is;
    bg_memory_pass(&m->memory, t);
    span->begin = fmax(span->begin, is->stretch);
    /* What breaks from now on is not known yet. */
    const double following = fmin(is->following, t + bg_memory_shortest(&m->memory));
    /* One that is a rounding before the end is passed there. */
    if (bg_reached(following) < end)
        span->following = fmin(span->following, following);
}

/* Steps follow one another, or go back. */
int bg_memory_ready(bg_model *m, double t, double h)
{
    bg_remembered *const is = &m->memory.is;
    const double near = BG_TOGETHER * fmax(fabs(t), h);
    if (!is->begun)
        bg_memory_begin(&m->memory, t);
    if (t > is->until + near || t < is->since - near)
        return BG_FORGETS;
    if (t < is->until - near)
        bg_memory_back(&m->memory, t);
    bg_memory_pass(&m->memory, t + near);
    return BG_OK;
}

const double *bg_recalled(bg_model *m, double t, double h, const double *w)
{
    double *const own = m->work.recalled;
    memcpy(own, w, sizeof(double) * 3 * BG_EXTERNAL);
    for (int i = 0; i < 3; i++)
        bg_model_recall(m, t + 0.5 * i * h, own + i * BG_EXTERNAL, NULL);
    return own;
}

void bg_between(double x, double h, const double *begin, const double *end, const double *first,
                const double *last, double *s)
{
    const double y = 1.0 - x, a = y * y * (1.0 + 2.0 * x), b = x * x * (3.0 - 2.0 * x);
    for (int i = 0; i < BG_SIZE; i++)
        s[i] = a * begin[i] + b * end[i] + h * x * y * (y * first[i] - x * last[i]);
}

/* Whether a step begins as the one before ended. */
static int goes_on(const bg_model *m, double t, const double *s, const double *w, const int *mode)
{
    const bg_latest *const last = &m->latest;
    return m->memory.is.stretch < m->memory.is.until - BG_TOGETHER * fabs(t)
        && memcmp(last->s, s, sizeof last->s) == 0
        && memcmp(last->w, w, sizeof(double) * BG_EXTERNAL) == 0
        && memcmp(last->mode, mode, sizeof(int) * K) == 0;
}

int bg_remember_step(bg_model *m, double t, double h, const double *begin, const double *end,
                     const double *w, const int *mode)
{
    static const double places[] = {-1.0, 1.0, -1.0 / 3.0, 1.0 / 3.0};
    enum { PLACES = sizeof places / sizeof *places };
    double rates[2][BG_SIZE], s[BG_SIZE], values[BG_LAGS][BG_PAST_VALUES];
    double now[BG_ROOM(BG_EXTERNAL)] = {0}, late[BG_LAGS];
    const int turns = !goes_on(m, t, begin, w, mode);
    int status = BG_OK;
    for (int k = 0; k < PLACES && status == BG_OK; k++) {
        const double x = 0.5 * (places[k] + 1.0);
        if (k < 2)
            memcpy(s, k ? end : begin, sizeof s);
        else
            bg_between(x, h, begin, end, rates[0], rates[1], s);
        bg_on_parabola(x, w, now);
        bg_model_recall(m, t + x * h, now, NULL);
        status = bg_evaluate(m, t + x * h, s, now, m->work.rates[0], mode, 0, &m->shot);
        if (k < 2)
            memcpy(rates[k], m->shot.rate, sizeof rates[k]);
        bg_read_late(m, late);
        for (int i = 0; i < BG_DELAYS; i++)
            values[i][k] = late[i];
    }
    if (status == BG_OK)
        status = bg_memory_take(&m->memory, t + h, PLACES, places, values, turns);
    memcpy(m->latest.s, end, sizeof m->latest.s);
    memcpy(m->latest.w, w + 2 * BG_EXTERNAL, sizeof(double) * BG_EXTERNAL);
    memcpy(m->latest.mode, m->mode, sizeof(int) * K);
    return status;
}
