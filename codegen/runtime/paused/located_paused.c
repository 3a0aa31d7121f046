/* Event-located runs that pause. */
#include "located_paused.h"

#include <string.h>

#include "located_internal.h"
#include "located_rows.h"
#include "run_paused.h"

typedef struct {
    bg_kept run;
    double s[BG_SIZE], seen[BG_SIZE];
    bg_peaks peaks;
} located_kept;

/* Where it was arrived at, and as it was decided. */
struct bg_paused {
    double row[BG_ROW_WIDTH], times[2];
    located_kept arrived, present;
};

enum { KEPT_WIDTH = BG_KEPT_WIDTH + 2 * BG_SIZE + BG_ROOM(BG_STATES) + BG_ROOM(BG_INPUTS) };

void bg_paused_sizes(unsigned long *sizes)
{
    sizes[0] = (unsigned long)sizeof(bg_paused);
    sizes[1] = (unsigned long)(2 * KEPT_WIDTH * sizeof(double));
}

static void keep_located(const bg_located *c, located_kept *to)
{
    bg_keep(&c->run, &to->run);
    memcpy(to->s, c->s, sizeof to->s);
    memcpy(to->seen, c->model->seen, sizeof to->seen);
    to->peaks = c->peaks;
}

static void put_present(void *to, int sample, const double *w, const int *mode, const bg_snapshot *shot)
{
    (void)sample;
    bg_row_put(to, w, mode, shot);
}

/* Sets out from what was kept, to `stop`. */
static void take_up_located(bg_located *c, bg_model *m, const bg_signals *signals, bg_request *asked,
                    bg_paused *to, const located_kept *from, double stop)
{
    to->times[0] = from->run.t;
    to->times[1] = stop;
    asked->times = to->times;
    asked->samples = 2;
    asked->record = put_present;
    memcpy(c->s, from->s, sizeof c->s);
    memcpy(m->seen, from->seen, sizeof m->seen);
    c->peaks = from->peaks;
    bg_located_set_out(c, m, signals, asked, from->run.t, stop, from->run.mode);
    bg_take_up(&c->run, &from->run, stop, c->s);
    c->next = 1; /* the begin is no sample any more, and the end is before none */
}

/* To the end of the course, and what is just after it. */
static int go_located(bg_located *c, bg_request *asked, bg_paused *to)
{
    asked->to = to->row;
    int status = bg_located_arrive(c);
    keep_located(c, &to->arrived);
    if (status == BG_OK)
        status = bg_located_finish(c);
    keep_located(c, &to->present);
    if (status == BG_OK)
        status = bg_located_hand_over(c, c->s);
    asked->count = c->run.log.count;
    asked->time = c->run.at.t;
    return status;
}

int bg_pause_make(bg_model *m, const double *parameters)
{
    return bg_model_init(m, parameters);
}

int bg_pause_first(bg_located *c, bg_model *m, const bg_signals *signals, bg_request *asked,
                   bg_paused *to, double t, const double *s)
{
    located_kept from = {.run = {.t = t, .began = t}};
    memset(m->seen, 0, sizeof m->seen);
    memset(&c->peaks, 0, sizeof c->peaks);
    memcpy(c->s, s, sizeof c->s);
    c->view.measured = 0;
    bg_located_set_out(c, m, signals, asked, t, t, asked->first);
    bg_have_seen(m, c->s);
    keep_located(c, &from);
    take_up_located(c, m, signals, asked, to, &from, t);
    return go_located(c, asked, to);
}

int bg_pause_next(bg_located *c, bg_model *m, const bg_signals *signals, bg_request *asked,
                  const bg_paused *from, bg_paused *to, double stop, int how)
{
    const int again = how == BG_GO_ANEW || !from->present.run.decided;
    take_up_located(c, m, signals, asked, to, again ? &from->arrived : &from->present, stop);
    return go_located(c, asked, to);
}

int bg_pause_look(bg_located *c, bg_model *m, const bg_signals *signals, bg_request *asked,
                  bg_paused *p)
{
    c->view.measured = 0;
    take_up_located(c, m, signals, asked, p, &p->present, p->present.run.t);
    asked->to = p->row;
    const int status = bg_located_arrive(c);
    return status ? status : bg_located_hand_over(c, c->s);
}

static void carry_located(bg_carrier *by, located_kept *one)
{
    bg_carry_kept(by, &one->run);
    bg_carry(by, one->s, BG_SIZE);
    bg_carry(by, one->peaks.x, BG_ROOM(BG_STATES));
    bg_carry(by, one->peaks.u, BG_ROOM(BG_INPUTS));
    bg_carry(by, one->seen, BG_SIZE);
}

void bg_pause_carry(bg_paused *p, double *numbers, int back)
{
    bg_carrier by = {numbers, back};
    carry_located(&by, &p->arrived);
    carry_located(&by, &p->present);
}
