/* The event-driven loop, over what an engine can look at and advance. */
#include "run_loop.h"

#include <limits.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

/* At the end of a run: whether there is something to decide. The search may have missed an event
 * there by a rounding: what slips and is at rest, or sticks and is at its limit, counts as one. */
static int come_to_end(const bg_engine *e, bg_course *c, int *undecided)
{
    const bg_sight *const sight = &e->sight;
    bg_port now[BG_MOST_PORTS];
    *undecided = c->span.begin == c->at.t;
    if (sight->ports == 0)
        return BG_OK;
    const int status = sight->look(sight->self, c->at.t, c->at.s, c->mode);
    if (status)
        return status;
    sight->tell(sight->self, c->mode, &c->at, now, NULL);
    for (int i = 0; i < sight->ports; i++) {
        if (sight->switches && bg_is_apart(sight->switches + i, c->mode[i]))
            c->at.touched[i] |= now[i].gap <= now[i].near_gap;
        else if (sight->switches && sight->switches[i].kind != BG_RUBS)
            c->at.touched[i] |= now[i].stay <= BG_WIDE * now[i].near_stay;
        else if (bg_hangs(sight->kinds + i) && c->mode[i])
            c->at.touched[i] |= fabs(now[i].gap) <= BG_WIDE * now[i].near_gap;
        else if (c->mode[i] == 0)
            c->at.touched[i] |= now[i].cap - fabs(now[i].effort) <= BG_WIDE * now[i].near_effort;
        else if (!sight->coupled[i])
            c->at.touched[i] |= fabs(now[i].slip) <= BG_WIDE * now[i].near_slip;
        *undecided |= c->at.touched[i] || sight->coupled[i];
    }
    return BG_OK;
}

/* The mode just after an instant; the last one where a run ends so soon that none needs to go on:
 * as where a level comes down to zero at the end, what would follow, a level below, does not. */
static int decide(const bg_engine *e, bg_course *c, int started)
{
    const bg_sight *const sight = &e->sight;
    int before[BG_MOST_PORTS];
    memcpy(before, c->mode, sizeof before);
    const int status =
        e->choose ? e->choose(e->self, sight) : bg_choose(sight, &c->at, c->mode);
    const double ahead = bg_look_ahead(c->at.time, c->at.t, c->at.following);
    if (!started || c->at.t + ahead < c->end
        || (status != BG_UNDECIDED && status != BG_BAD_FRICTION && status != BG_NEGATIVE))
        return status;
    memcpy(c->mode, before, sizeof before);
    c->excused = 1;
    return sight->look(sight->self, c->at.t, c->at.s, c->mode);
}

static int is_jump(const bg_switch *one)
{
    return one->order != 0;
}

/* Tells swings that hardly shrink, by the speeds of crossings to the same side. */
static void linger(bg_course *c, int port, double speed)
{
    double *const before = c->crossings.speed[port];
    c->at.lingers[port] = BG_LINGERS * before[0] < speed && speed < INFINITY;
    before[0] = before[1];
    before[1] = speed;
}

/* Counts the crossings of jumps at an instant; whether one comes to rest on its jump: crossed so
 * often in a row without leaping higher than what counts as zero. As codegen/modes/crossings.py. */
static int count_crossings(const bg_engine *e, bg_course *c)
{
    const bg_sight *const sight = &e->sight;
    bg_port now[BG_MOST_PORTS];
    int crossed = 0, gathers = 0;
    for (int i = 0; i < sight->ports; i++)
        crossed |= c->at.touched[i] && is_jump(sight->kinds + i);
    if (!crossed)
        return BG_OK;
    const int status = sight->look(sight->self, c->at.t, c->at.s, c->mode);
    if (status)
        return status;
    sight->tell(sight->self, c->mode, &c->at, now, NULL);
    for (int i = 0; i < sight->ports; i++) {
        int *const unseen = c->crossings.unseen + i;
        if (!c->at.touched[i] || !is_jump(sight->kinds + i))
            continue;
        const int hangs = bg_hangs(sight->kinds + i);
        const double speed = hangs ? now[i].slip : now[i].push;
        const double near = hangs ? now[i].near_gap : now[i].near_slip;
        const double leap = fabs(speed) * (c->at.t - c->crossings.last[i]) / 4;
        c->at.leapt[i] = isfinite(leap) ? fmax(c->at.leapt[i], leap) : c->at.leapt[i];
        c->crossings.last[i] = c->at.t;
        linger(c, i, hangs && c->mode[i] ? fabs(speed) : INFINITY);
        *unseen = c->mode[i] == 0 || leap > BG_LEAP * near ? 0 : *unseen + 1;
        gathers |= *unseen >= BG_STALLED;
    }
    return gathers ? BG_STALLS : BG_OK;
}

/* Takes the present instant into account, decides the mode there and removes slips that stick; from
 * the mode before it. */
static int settle_once(const bg_engine *e, bg_course *c, const int *before, int started)
{
    const bg_sight *const sight = &e->sight;
    int slipping[BG_MOST_PORTS], touched = 0;
    double fastest = 0.0;
    memcpy(slipping, c->mode, sizeof slipping);
    int status = bg_evaluated(sight, &c->at, 1, slipping);
    if (status == BG_OK)
        e->see(e->self, slipping);
    if (status == BG_OK)
        status = e->fastest(e->self, &fastest);
    if (status)
        return status;
    c->at.time = bg_time_constant(fastest, c->at.t - c->began);
    bg_begin_log(&c->log, c->mode);
    c->log.begins = !started && !c->goes_on;
    c->at.log = &c->log;
    status = decide(e, c, started);
    c->at.log = NULL;
    /* A jump that is crossed may be so as often as it is. */
    for (int i = 0; i < sight->ports; i++)
        touched |= c->at.touched[i] && !(is_jump(sight->kinds + i) && before[i] && c->mode[i]);
    started |= !c->log.begins && !c->goes_on;
    if (status == BG_OK && started) {
        if (bg_note(&c->log, c->at.t, sight->ports, sight->kinds, c->mode))
            status = BG_EVENTS;
        else if (touched && !c->log.thrown && bg_stalls(&c->rounds, c->at.t, c->at.time))
            status = BG_STALLS;
    }
    if (status == BG_OK && started)
        status = count_crossings(e, c);
    return status ? status : e->rest(e->self);
}

/* The same until no jump of second order comes to rest any more: what was left of its leap is gone
 * then, and what goes with it may rest, too. */
static int settle(const bg_engine *e, bg_course *c, int started)
{
    int before[BG_MOST_PORTS], rests = e->sight.ports > 0, status = BG_OK;
    c->excused = 0;
    while (rests && status == BG_OK) {
        memcpy(before, c->mode, sizeof before);
        status = settle_once(e, c, before, started);
        rests = 0;
        for (int i = 0; i < e->sight.ports; i++)
            rests |= bg_hangs(e->sight.kinds + i) && before[i] && c->mode[i] == 0;
        memset(c->at.touched, 0, sizeof c->at.touched);
        started = 1;
    }
    return status;
}

/* The next instant of a task. */
static double next_tick(const bg_engine *e, const bg_course *c)
{
    double tick = INFINITY;
    for (int k = 0; k < BG_CLOCKS; k++)
        tick = fmin(tick, bg_clock_after(e->sight.clocks + k, c->at.t));
    return tick;
}

/* Which tasks are due at the present instant, and have not been done yet; whether any is. */
static int are_due(const bg_engine *e, bg_course *c)
{
    int any = 0;
    for (int k = 0; k < BG_CLOCKS; k++)
        any |= c->due[k] = c->at.t > c->done && bg_clock_strikes(e->sight.clocks + k, c->at.t);
    return any;
}

/* Whether nothing but tasks makes an instant: no port is at an event, no input at a breakpoint. */
static int is_plain(const bg_engine *e, const bg_course *c)
{
    int touched = c->paused || c->span.begin == c->at.t;
    for (int i = 0; i < e->sight.ports; i++)
        touched |= c->at.touched[i];
    return !touched;
}

/* What is due is set once no event is left, and the mode decided anew. */
static int strike(const bg_engine *e, bg_course *c)
{
    const int status = bg_set_by_tasks(&e->sight, &c->at, c->mode, c->due);
    c->done = c->at.t;
    return status ? status : settle(e, c, 1);
}

void bg_set_out(bg_course *c, double t, double end, double *s, const int *first)
{
    c->at = (bg_instant){.t = t, .s = s};
    c->began = t;
    c->goes_on = c->started = c->decided = c->paused = c->excused = 0;
    c->done = -INFINITY;
    c->end = end;
    c->span = (bg_span){0, -INFINITY, INFINITY};
    c->log.count = c->log.emptied = c->rounds.next = c->rounds.full = 0;
    for (int i = 0; i < BG_MOST_PORTS; i++)
        c->mode[i] = first ? first[i] : 1;
    for (int i = 0; i < BG_MOST_PORTS; i++) {
        c->crossings.last[i] = -INFINITY;
        c->crossings.unseen[i] = 0;
        c->crossings.speed[i][0] = c->crossings.speed[i][1] = INFINITY;
    }
}

/* Decides the mode at the present instant. */
static int decide_here(const bg_engine *e, bg_course *c)
{
    const int due = are_due(e, c);
    int status = BG_OK;
    if (!c->started || !due || !is_plain(e, c))
        status = settle(e, c, c->started);
    c->started = c->decided = 1;
    if (due && status == BG_OK)
        status = strike(e, c);
    memset(c->at.touched, 0, sizeof c->at.touched);
    return status;
}

double bg_most_turns(const bg_log *log)
{
    return 16.0 * (log->emptied ? INT_MAX : log->capacity) + 1000.0;
}

int bg_arrive(const bg_engine *e, bg_course *c)
{
    int status = BG_OK, undecided;
    /* Breakpoints lie ahead one after the other: a turn that ends at one gets somewhere. */
    for (double turns = 0.0; turns < bg_most_turns(&c->log); turns += c->at.t < c->at.following) {
        status = e->pass(e->self, c->at.t, &c->span);
        c->at.following = fmin(c->span.following, next_tick(e, c));
        if (status || c->at.t >= c->end)
            return status;
        if (!c->decided && c->paused)
            status = come_to_end(e, c, &undecided);
        if (!c->decided && status == BG_OK)
            status = decide_here(e, c);
        if (status)
            return status;
        c->decided = c->paused = 0;
        status = e->advance(e->self, fmin(c->at.following, c->end));
        if (status)
            return status;
    }
    return BG_EVENTS;
}

int bg_finish(const bg_engine *e, bg_course *c)
{
    int undecided = 1, status = BG_OK;
    if (c->started)
        status = come_to_end(e, c, &undecided);
    if (status == BG_OK && (undecided || are_due(e, c)))
        status = decide_here(e, c);
    c->decided = status == BG_OK;
    return status;
}

int bg_run(const bg_engine *e, bg_course *c)
{
    const int status = bg_arrive(e, c);
    return status ? status : bg_finish(e, c);
}
