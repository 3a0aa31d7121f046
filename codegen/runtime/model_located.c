/* The event-driven loop: stretches between breakpoints, sticking, release and zero crossings. */
#include <math.h>
#include <string.h>

#include "model_located_internal.h"

enum { K = BG_FRICTION, REFRESH = 50 };
static const double STIFF = 2e5;     /* run over time constant: from here on implicit steps */
static const double FOLLOWED = 0.1;  /* an implicit step in time constants of the inputs */

int bg_located_look(bg_located *c, double t, const double *s, const signed char *mode)
{
    double w[BG_ROOM(BG_EXTERNAL)], dw[BG_ROOM(BG_EXTERNAL)];
    int signs[BG_ROOM(K)] = {0};
    for (int i = 0; i < K; i++)
        signs[i] = mode[i];
    bg_signals_at(c->signals, c->segment, t, w, dw);
    return bg_evaluate(c->model, t, s, w, dw, signs, 1, &c->shot);
}

/* In the present mode; straight-line code where all ports slip and there is any. */
int bg_located_rate(bg_located *c, double t, const double *s, double *rate)
{
    double w[BG_ROOM(BG_EXTERNAL)], dw[BG_ROOM(BG_EXTERNAL)], signs[BG_ROOM(K)] = {0};
    int sticking = 0;
    for (int i = 0; i < K; i++) {
        signs[i] = c->mode[i];
        sticking |= c->mode[i] == 0;
    }
    if (!BG_STRAIGHT || sticking) {
        const int status = bg_located_look(c, t, s, c->mode);
        memcpy(rate, c->shot.rate, sizeof c->shot.rate);
        return status;
    }
    bg_signals_at(c->signals, c->segment, t, w, dw);
    const int status = bg_model_rhs(c->model, t, s, w, signs, rate);
    return status == BG_OK && !bg_finite(BG_SIZE, rate) ? BG_NOT_FINITE : status;
}

static int touched(const bg_located *c)
{
    int any = 0;
    for (int i = 0; i < K; i++)
        any |= c->touched[i];
    return any;
}

/* At the end of a run the search may have missed an event by a rounding: slips that are at rest. */
static int come_to_end(bg_located *c)
{
    bg_rounding size;
    const int status = bg_located_look(c, c->t, c->s, c->mode);
    if (status != BG_OK)
        return status;
    bg_located_rounding(c, c->t, &size);
    for (int i = 0; i < K; i++)
        if (c->mode[i] && !bg_beside[i])
            c->touched[i] |= fabs(c->shot.y[bg_friction_readings[i]]) <= BG_AT_REST * size.slip[i];
    return BG_OK;
}

/* Takes the present instant into account, decides the mode there and removes slips that stick. */
static int settle(bg_located *c, int started, int last)
{
    signed char before[BG_ROOM(K)], usable[BG_ROOM(K)];
    double fastest;
    if (K == 0)
        return BG_OK;
    bg_have_seen(c->model, c->s);
    memcpy(before, c->mode, sizeof before);
    memcpy(usable, before, sizeof usable);
    int status = bg_located_usable(c, 1, usable);
    if (status == BG_OK)
        status = bg_located_see(c, usable);
    if (status == BG_OK)
        status = bg_located_usable(c, 0, c->mode);
    if (status == BG_OK)
        status = bg_located_fastest(c, c->t, c->s, &fastest);
    memcpy(c->mode, before, sizeof before);
    if (status != BG_OK)
        return status;
    c->moment = bg_time_constant(fastest, c->t - c->began);
    status = last ? come_to_end(c) : BG_OK;
    if (status != BG_OK)
        return status;
    status = bg_located_decide(c);
    if (status != BG_OK || !started)
        return status;
    bg_request *const asked = c->asked;
    if (bg_note(asked->events, &asked->count, asked->capacity, c->t, K, before, c->mode))
        return BG_EVENTS;
    return touched(c) && bg_stalls(&c->rounds, c->t, c->moment) ? BG_STALLS : BG_OK;
}

/* Hands the next sample over, which is at s. */
static int record(bg_located *c, const double *s)
{
    const bg_request *const asked = c->asked;
    const double t = asked->times[c->next];
    double w[BG_ROOM(BG_EXTERNAL)], dw[BG_ROOM(BG_EXTERNAL)];
    int mode[BG_ROOM(K)] = {0};
    const int status = bg_located_look(c, t, s, c->mode);
    if (status != BG_OK)
        return status;
    for (int i = 0; i < K; i++)
        mode[i] = c->mode[i];
    bg_signals_at(c->signals, c->segment, t, w, dw);
    asked->record(asked->to, c->next++, w, mode, &c->shot);
    return BG_OK;
}

/* The samples before `until`, from the latest step. */
static int sample(bg_located *c, double until)
{
    const bg_request *const asked = c->asked;
    double s[BG_SIZE];
    int status = BG_OK;
    while (status == BG_OK && c->next < asked->samples && asked->times[c->next] < until) {
        status = bg_solver_dense(c, asked->times[c->next], s);
        if (status == BG_OK)
            status = record(c, s);
    }
    return status;
}

/* The longest step: events and inputs must not fall between, nor the interpolant be strained. */
static double longest(const bg_located *c, int method, double fastest)
{
    const double bound = bg_longest_step(c->t - c->began);
    const double driven = c->signals->fastest[c->segment];
    if (method == BG_RADAU)
        return driven > 0 ? fmin(bound, FOLLOWED / driven) : bound;
    return fastest > 0 ? fmin(bound, 1.0 / fastest) : bound;
}

/* A step: its end, or the event in it; samples before that are recorded. */
static int step(bg_located *c, double stop, int *ended)
{
    const bg_request *const asked = c->asked;
    double until = INFINITY, s[BG_SIZE];
    int status = bg_solver_step(c, stop);
    if (status == BG_OK)
        status = bg_watch_step(c, ended, &until, c->touched);
    if (status == BG_OK)
        status = sample(c, *ended ? until : c->solver.t);
    if (status == BG_OK && asked->smooth)
        status = asked->smooth(asked->to, c, c->t, *ended ? until : c->solver.t);
    if (status == BG_OK && *ended)
        status = bg_solver_dense(c, until, s);
    if (status != BG_OK)
        return status;
    c->t = *ended ? until : c->solver.t;
    memcpy(c->s, *ended ? s : c->solver.y, sizeof c->s);
    bg_have_seen(c->model, c->s);
    return BG_OK;
}

/* From the present instant to `stop` or the first event. */
static int advance(bg_located *c, double stop)
{
    double fastest;
    int status = bg_located_fastest(c, c->t, c->s, &fastest), ended = 0;
    int method = c->asked->method;
    const double span = c->asked->times[c->asked->samples - 1] - c->began;
    if (method == BG_AUTO)
        method = fastest * span > STIFF ? BG_RADAU : BG_DOP853;
    if (status == BG_OK)
        status = bg_solver_begin(c, method, longest(c, method, fastest));
    if (status == BG_OK)
        status = bg_watch_begin(c);
    bg_progress_begin(c);
    for (long count = 1; status == BG_OK && c->t < stop && !ended; count++) {
        status = step(c, stop, &ended);
        if (status == BG_OK && !ended)
            status = bg_progress_check(c);
        if (status == BG_OK && !BG_AFFINE && count % REFRESH == 0)
            status = bg_located_fastest(c, c->t, c->s, &fastest);
        c->solver.longest = longest(c, method, fastest);
    }
    return status;
}

static int begin(bg_located *c, bg_model *m, const bg_signals *signals, bg_request *asked)
{
    double w[BG_ROOM(BG_EXTERNAL)], dw[BG_ROOM(BG_EXTERNAL)];
    c->model = m;
    c->signals = signals;
    c->asked = asked;
    c->t = c->began = asked->times[0];
    c->next = asked->count = c->rounds.next = c->rounds.full = 0;
    c->moment = 0.0;
    memset(c->touched, 0, sizeof c->touched);
    memset(c->mode, 1, sizeof c->mode);
    memset(m->seen, 0, sizeof m->seen);
    memset(c->peak_x, 0, sizeof c->peak_x);
    memset(c->peak_u, 0, sizeof c->peak_u);
    c->segment = bg_signals_segment(signals, c->t);
    bg_signals_at(signals, c->segment, c->t, w, dw);
    return bg_model_vector(m, c->t, asked->states, w, c->s);
}

static int run(bg_located *c)
{
    const double end = c->asked->times[c->asked->samples - 1];
    int status = BG_OK, started = 0;
    for (;;) {
        const bg_signals *const signals = c->signals;
        c->segment = bg_signals_segment(signals, c->t);
        status = settle(c, started, started && c->t >= end);
        started = 1;
        memset(c->touched, 0, sizeof c->touched);
        if (status != BG_OK || c->t >= end)
            return status;
        double stop = end;
        if (c->segment + 1 < signals->segments)
            stop = fmin(signals->breaks[c->segment], end);
        status = advance(c, stop);
        if (status != BG_OK)
            return status;
    }
}

int bg_model_run(bg_located *c, bg_model *m, const bg_signals *signals, bg_request *asked)
{
    int status = begin(c, m, signals, asked);
    if (status == BG_OK)
        status = run(c);
    if (status == BG_OK)
        status = record(c, c->s); /* the last sample shows the instant after all events */
    asked->time = c->t;
    return status;
}
