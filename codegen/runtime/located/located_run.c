/* Event-located runs: steps with a tolerance, and the samples on the way. */
#include <math.h>
#include <string.h>

#include "located_internal.h"

/* External inputs in the present segment, for the view. */
static int inputs_now(const void *self, double t, double *w, double *dw)
{
    const bg_located *const c = self;
    bg_signals_at(c->signals, &c->run.span, t, w, dw);
    if (BG_DELAYS)
        bg_model_recall(c->model, t, w, dw);
    return 1;
}

static int pass_on(void *run, double t, bg_span *span)
{
    const bg_located *const c = run;
    *span = bg_signals_span(c->signals, t);
    if (BG_DELAYS)
        bg_pass_memory(c->model, t, c->run.end, span);
    return BG_OK;
}

/* In the present mode; straight-line code where all ports slip and there is any. */
int bg_located_rate(bg_located *c, double t, const double *s, double *rate)
{
    double w[BG_ROOM(BG_EXTERNAL)], dw[BG_ROOM(BG_EXTERNAL)], signs[BG_ROOM(K)] = {0};
    int sticking = 0;
    for (int i = 0; i < K; i++) {
        signs[i] = c->run.mode[i];
        sticking |= c->run.mode[i] == 0;
    }
    if (!BG_STRAIGHT || sticking) {
        const int status = bg_view_look(&c->view, t, s, c->run.mode);
        memcpy(rate, c->view.shot.rate, sizeof c->view.shot.rate);
        return status;
    }
    c->view.given(c->view.self, t, w, dw);
    int status = bg_model_rhs(c->model, t, s, w, signs, rate);
    const double sided = c->model->now.sided;
    if (status == BG_OK && sided > 0.0 && !bg_finite(BG_SIZE, rate)) {
        c->model->now.sided = 0.0; /* a law without a value beyond its corner, as below */
        status = bg_model_rhs(c->model, t, s, w, signs, rate);
        c->model->now.sided = sided;
    }
    return status == BG_OK && !bg_finite(BG_SIZE, rate) ? BG_NOT_FINITE : status;
}

static void take_in(void *run, const int *slipping)
{
    bg_located *const c = run;
    bg_view_see(&c->view, c->s, slipping);
}

/* The largest rate in the mode so far or, where that cannot be evaluated, in one that can. */
static int fastest_now(void *run, double *fastest)
{
    bg_located *const c = run;
    const bg_sight sight = bg_view_sight(&c->view);
    int before[BG_MOST_PORTS];
    memcpy(before, c->run.mode, sizeof before);
    int status = bg_evaluated(&sight, &c->run.at, 0, c->run.mode);
    if (status == BG_OK)
        status = bg_located_fastest(c, c->run.at.t, c->s, fastest);
    memcpy(c->run.mode, before, sizeof before);
    return status;
}

static int take_away(void *run)
{
    bg_located *const c = run;
    int sticking = 0;
    for (int i = 0; i < K; i++)
        sticking |= c->run.mode[i] == 0;
    const int status = sticking ? bg_view_look(&c->view, c->run.at.t, c->s, c->run.mode) : BG_OK;
    if (status || !sticking)
        return status;
    return bg_remove_slips(c->model, c->run.mode, &c->view.shot, c->s);
}

/* Hands the next sample over, which is at s. */
int bg_located_hand_over(bg_located *c, const double *s)
{
    const bg_request *const asked = c->asked;
    const double t = asked->times[c->next], sided = c->model->now.sided;
    double w[BG_ROOM(BG_EXTERNAL)], dw[BG_ROOM(BG_EXTERNAL)];
    c->model->now.sided = 0.0; /* told are laws as they are */
    const int status = bg_view_look(&c->view, t, s, c->run.mode);
    c->model->now.sided = sided;
    if (status != BG_OK)
        return status;
    c->view.given(c->view.self, t, w, dw);
    asked->record(asked->to, c->next++, w, c->run.mode, &c->view.shot);
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
            status = bg_located_hand_over(c, s);
    }
    return status;
}

/* The longest step: events and inputs must not fall between, nor the interpolant be strained. */
static double longest_now(const bg_located *c, int method, double fastest)
{
    double bound = bg_longest_step(c->run.at.t - c->run.began);
    if (BG_DELAYS)
        bound = fmin(bound, bg_memory_shortest(&c->model->memory));
    const double driven = bg_signals_fastest(c->signals, &c->run.span);
    if (method == BG_RADAU)
        return driven > 0 ? fmin(bound, BG_FOLLOWED / driven) : bound;
    return fastest > 0 ? fmin(bound, 1.0 / fastest) : bound;
}

/* The first event or corner in the latest step. */
static int find_end(bg_located *c, double *until, int *ended)
{
    double corner = INFINITY;
    int status = bg_watch_step(c, until, c->run.at.touched);
    if (BG_CORNERS && status == BG_OK && c->model->now.sided > 0.0)
        status = bg_corners_step(c, &corner);
    *ended = *until < INFINITY ? BG_AT_EVENT : 0;
    if (corner < *until) {
        *ended = BG_AT_CORNER;
        *until = corner;
        memset(c->run.at.touched, 0, sizeof c->run.at.touched);
    }
    return status;
}

int bg_located_pass(bg_located *c, int *ended)
{
    const bg_request *const asked = c->asked;
    double until = INFINITY, s[BG_SIZE];
    int status = find_end(c, &until, ended);
    if (status == BG_OK)
        status = sample(c, *ended ? until : c->solver.t);
    if (BG_DELAYS && status == BG_OK)
        status = bg_located_remember(c, *ended ? until : c->solver.t);
    if (status == BG_OK && asked->smooth)
        status = asked->smooth(asked->to, c, c->run.at.t, *ended ? until : c->solver.t);
    if (status == BG_OK && *ended)
        status = bg_solver_dense(c, until, s);
    if (status == BG_OK)
        bg_located_reach(c, *ended ? until : c->solver.t, *ended ? s : c->solver.y);
    return status == BG_OK && asked->passed ? asked->passed(asked->to, c) : status;
}

void bg_located_reach(bg_located *c, double t, const double *s)
{
    c->run.at.t = t;
    memcpy(c->s, s, sizeof c->s);
    bg_have_seen(c->model, c->s);
}

/* The other method from the present instant on. */
static int turn_over(bg_located *c)
{
    bg_stretch *const of = &c->stretch;
    const double length = c->solver.t - c->solver.t_old;
    int status = bg_located_fastest(c, c->run.at.t, c->s, &of->fastest);
    of->method = of->method == BG_RADAU ? BG_DOP853 : BG_RADAU;
    if (status == BG_OK)
        status = bg_solver_begin(c, of->method, longest_now(c, of->method, of->fastest), of->stop);
    c->solver.next = fmin(length, c->solver.longest);
    return status;
}

int bg_located_set_off(bg_located *c, double stop, double first)
{
    bg_stretch *const of = &c->stretch;
    int status = bg_located_fastest(c, c->run.at.t, c->s, &of->fastest);
    of->stop = stop;
    of->steps = 0;
    of->method = c->asked->method;
    c->turned = 1;
    if (of->method == BG_AUTO)
        of->method = of->fastest > c->stiff ? BG_RADAU : BG_DOP853;
    if (status == BG_OK)
        status = bg_solver_begin(c, of->method, longest_now(c, of->method, of->fastest), stop);
    if (first > 0.0)
        c->solver.next = fmin(first, c->solver.longest);
    if (status == BG_OK)
        status = bg_watch_begin(c);
    if (BG_CORNERS && status == BG_OK && c->model->now.sided > 0.0)
        status = bg_corners_watch(c, c->corners.fastest);
    c->corners.fastest = of->fastest;
    bg_progress_begin(c);
    bg_turns_begin(c);
    return status;
}

int bg_located_go_on(bg_located *c)
{
    bg_stretch *const of = &c->stretch;
    int status = bg_progress_check(c);
    if (status == BG_OK && !BG_AFFINE && ++of->steps % BG_REFRESH == 0)
        status = bg_located_fastest(c, c->run.at.t, c->s, &of->fastest);
    if (status == BG_OK && c->asked->method == BG_AUTO && c->run.at.t < of->stop
        && bg_turns_over(c, of->fastest, of->stop))
        status = turn_over(c);
    c->solver.longest = longest_now(c, of->method, of->fastest);
    return status;
}

int bg_located_stretch(bg_located *c, double stop, double first, int *ended)
{
    *ended = 0;
    const int status = bg_located_set_off(c, stop, first);
    return status == BG_OK ? bg_located_rest(c, 1, ended) : status;
}

int bg_located_rest(bg_located *c, int whole, int *ended)
{
    int status = BG_OK;
    while (status == BG_OK && c->run.at.t < c->stretch.stop && !*ended
           && (whole || c->stretch.method == BG_RADAU)) {
        status = bg_solver_step(c, c->stretch.stop);
        if (status == BG_OK)
            status = bg_located_pass(c, ended);
        if (status == BG_OK && !*ended)
            status = bg_located_go_on(c);
    }
    return status;
}

/* From the present instant to `stop`, to where one has to look, or to the first event. */
static int go_on(void *run, double stop)
{
    bg_located *const c = run;
    int ended;
    if (c->ahead)
        stop = c->ahead(c->view.self, c->run.at.t, stop);
    c->stretch.stop = stop;
    if (c->leaves)
        return BG_AWAY;
    return BG_CORNERS ? bg_corners_go(c, stop) : bg_located_stretch(c, stop, 0.0, &ended);
}

void bg_located_set_out(bg_located *c, bg_model *m, const bg_signals *signals, bg_request *asked,
                        double t, double end, const int *first)
{
    c->model = m;
    c->signals = signals;
    c->asked = asked;
    c->next = 0;
    c->stiff = BG_STIFF_SPAN / (end - t);
    c->ahead = NULL;
    c->together = NULL;
    c->leaves = 0;
    c->known = 0;
    c->run.log.events = asked->events;
    c->run.log.capacity = asked->capacity;
    bg_set_out(&c->run, t, end, c->s, first);
    c->run.span = bg_signals_span(signals, t);
    c->view.model = m;
    c->view.peaks = &c->peaks;
    c->view.self = c;
    c->view.given = inputs_now;
}

/* The model is where the run came to, at the end of a table that it was to leave. */
static int come_to(bg_located *c, int status)
{
    if (status != BG_OK && BG_REFUSING > 0)
        (void)bg_view_look(&c->view, c->run.at.t, c->s, c->run.mode);
    return status;
}

static bg_engine engine_of(bg_located *c)
{
    return (bg_engine){bg_view_sight(&c->view), c, pass_on, take_in, fastest_now, NULL, take_away,
                       go_on};
}

int bg_located_arrive(bg_located *c)
{
    const bg_engine engine = engine_of(c);
    return come_to(c, bg_arrive(&engine, &c->run));
}

int bg_located_finish(bg_located *c)
{
    const bg_engine engine = engine_of(c);
    return come_to(c, bg_finish(&engine, &c->run));
}

int bg_located_go(bg_located *c)
{
    const int status = bg_located_arrive(c);
    return status ? status : bg_located_finish(c);
}

/* The vector and the switches at the start. */
int bg_located_begin(bg_located *c, bg_model *m, const bg_signals *signals, bg_request *asked)
{
    double w[BG_ROOM(BG_EXTERNAL)], dw[BG_ROOM(BG_EXTERNAL)];
    int first[BG_MOST_PORTS] = {0};
    bg_all_off(first);
    for (int i = 0; i < K && asked->first; i++)
        first[i] = asked->first[i];
    bg_located_set_out(c, m, signals, asked, asked->times[0], asked->times[asked->samples - 1],
                       first);
    memset(&c->peaks, 0, sizeof c->peaks);
    c->view.measured = 0;
    memset(m->seen, 0, sizeof m->seen);
    if (BG_DELAYS)
        bg_memory_begin(&m->memory, c->run.at.t);
    inputs_now(c, c->run.at.t, w, dw);
    int status = bg_model_vector(m, c->run.at.t, asked->states, w, c->s);
    for (int i = 0; i < ALL && asked->moved; i++)
        asked->moved[i] = -c->s[i];
    if (status == BG_OK && asked->named)
        status = bg_complete(m, c->run.at.t, w, asked->named, c->run.mode, c->s);
    for (int i = 0; i < ALL && asked->moved; i++)
        asked->moved[i] += c->s[i];
    bg_have_seen(m, c->s);
    return status;
}

int bg_located_turn(bg_located *c, double *stop)
{
    const bg_engine engine = engine_of(c);
    c->leaves = 1;
    const int status = bg_arrive(&engine, &c->run);
    c->leaves = 0;
    *stop = c->stretch.stop;
    return status == BG_AWAY ? BG_OK : come_to(c, status);
}

int bg_located_end(bg_located *c)
{
    int status = bg_located_finish(c);
    if (status == BG_OK)
        /* the last sample shows the instant after all events */
        status = bg_located_hand_over(c, c->s);
    return status;
}

int bg_model_run(bg_located *c, bg_model *m, const bg_signals *signals, bg_request *asked)
{
    int status = bg_located_begin(c, m, signals, asked);
    if (status == BG_OK)
        status = bg_located_arrive(c);
    if (status == BG_OK)
        status = bg_located_end(c);
    asked->count = c->run.log.count;
    asked->time = c->run.at.t;
    return status;
}
