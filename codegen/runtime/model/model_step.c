/* One step in bounded time: which ports hold is decided at its start, then it is one of a
 * method's in that mode, and what changes inside it is made up for at its end. Tasks that are due
 * set what they set at its start; one that crosses their instants, or breaks in what delays give,
 * is cut there. */
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

/* The mode at the start of a step of h, whose inputs' rates are known, and s then. */
static int settle_start(bg_model *m, double t, double h, double *s, const double *w)
{
    int status, sticking = 0;
    if (K == 0)
        return BG_OK;
    bg_have_seen(m, s);
    status = bg_decide_step(m, t, h, s, w);
    for (int i = 0; i < K; i++)
        sticking |= m->mode[i] == 0;
    if (status == BG_OK && sticking)
        status = bg_remove_slips(m, m->mode, &m->shot, s);
    return status == BG_OK ? m->decided : status;
}

void bg_on_parabola(double x, const double *w, double *of)
{
    const double y = 1.0 - x;
    for (int i = 0; i < BG_EXTERNAL; i++) {
        const double a = w[i], b = w[BG_EXTERNAL + i], c = w[2 * BG_EXTERNAL + i];
        of[i] = a * y * (y - x) + 4.0 * b * x * y + c * x * (x - y);
    }
}

/* The external inputs at the start, the middle and the end of a part of a step. */
static void inputs_of_part(double from, double part, const double *w, double *of)
{
    for (int k = 0; k < 3; k++)
        bg_on_parabola(from + 0.5 * k * part, w, of + k * BG_EXTERNAL);
}

int bg_model_settle(bg_model *m, double t, double h, double *s, const double *w)
{
    int due[BG_ROOM(BG_CLOCKS)];
    double instant = 0.0, part[3 * BG_ROOM(BG_EXTERNAL)];
    if (!(h > 0) || !isfinite(h))
        return BG_BAD_STEP;
    const int ready = BG_DELAYS ? bg_memory_ready(m, t, h) : BG_OK;
    if (ready)
        return ready;
    const double until = BG_CUT ? bg_cut_step(m, t, t + h) - t : h;
    if (BG_DELAYS) {
        inputs_of_part(0.0, until / h, w, part);
        w = bg_recalled(m, t, until, part);
    }
    if (BG_RATED)
        external_rates(BG_DELAYS ? until : h, w, m->work.rates);
    const int decided = settle_start(m, t, until, s, w);
    if (!BG_CLOCKS || !bg_is_taken(decided) || !bg_due_in_step(m, t, h, due, &instant))
        return decided;
    const bg_start at = {t, until, s, w, m->work.rates[0], m->mode, m->started};
    const int set = bg_set_by_tasks_in_step(m, &at, due, s);
    if (set)
        return set;
    m->ticked = instant;
    const int again = settle_start(m, t, until, s, w);
    return again == BG_OK ? decided : again;
}

/* A step in one mode, and what changes at its end. */
static int advance_whole(bg_model *m, double t, double h, double *s, const double *w)
{
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

/* The same of a model with delays, whose memory is ready: they read what it makes; it is not taken
 * where they cannot. */
static int advance_late(bg_model *m, double t, double h, double *s, const double *w)
{
    double begun[BG_SIZE];
    int mode[BG_ROOM(K)];
    w = bg_recalled(m, t, h, w);
    memcpy(begun, s, sizeof begun);
    memcpy(mode, m->mode, sizeof mode);
    const int status = advance_whole(m, t, h, s, w);
    const int read = bg_is_taken(status) ? bg_remember_step(m, t, h, begun, s, w, mode) : BG_OK;
    if (read == BG_OK)
        return status;
    memcpy(s, begun, sizeof begun);
    memcpy(m->mode, mode, sizeof mode);
    return read;
}

static int advance_plain(bg_model *m, double t, double h, double *s, const double *w)
{
    return BG_DELAYS ? advance_late(m, t, h, s, w) : advance_whole(m, t, h, s, w);
}

/* The same by parts, from one instant of tasks to the next; s and the mode are as they were where
 * one is not taken. */
static int advance_by_parts(bg_model *m, double t, double h, double *s, const double *w)
{
    double begun[BG_SIZE], part[3 * BG_ROOM(BG_EXTERNAL)];
    int mode[BG_ROOM(K)], started = m->started, status = BG_OK, told = BG_OK;
    const double end = t + h, ticked = m->ticked;
    double a = t;
    memcpy(begun, s, sizeof begun);
    memcpy(mode, m->mode, sizeof mode);
    for (int k = 0; k < BG_CUTS && a < end && bg_is_taken(status); k++) {
        status = BG_DELAYS ? bg_memory_ready(m, a, end - a) : BG_OK;
        const double b = bg_cut_step(m, a, end);
        inputs_of_part((a - t) / h, (b - a) / h, w, part);
        if (a > t && bg_is_taken(status))
            status = bg_model_settle(m, a, b - a, s, part);
        told = status ? status : told;
        if (bg_is_taken(status))
            status = advance_plain(m, a, b - a, s, part);
        told = status ? status : told;
        a = b;
    }
    if (bg_is_taken(told) && a < end)
        told = BG_INSTANTS;
    if (bg_is_taken(told))
        return told;
    memcpy(s, begun, sizeof begun);
    memcpy(m->mode, mode, sizeof mode);
    m->started = started;
    m->ticked = ticked;
    return told;
}

int bg_model_advance(bg_model *m, double t, double h, double *s, const double *w)
{
    if (!(h > 0) || !isfinite(h))
        return BG_BAD_STEP;
    const int ready = BG_DELAYS ? bg_memory_ready(m, t, h) : BG_OK;
    if (ready)
        return ready;
    return BG_CUT && bg_cut_step(m, t, t + h) < t + h ? advance_by_parts(m, t, h, s, w)
                                                     : advance_plain(m, t, h, s, w);
}

int bg_model_step(bg_model *m, double t, double h, double *s, const double *w)
{
    const int decided = bg_model_settle(m, t, h, s, w);
    const int status = bg_is_taken(decided) ? bg_model_advance(m, t, h, s, w) : decided;
    return status == BG_OK ? decided : status;
}
