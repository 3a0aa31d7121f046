/* One consistent mode where stops may be met: what joins comes first, then what closes is thrown
 * back; again until nothing closes. As codegen/modes/choose.py and bounce.py. */
#include <math.h>
#include <string.h>

#include "port_choosing.h"

/* What there is at an instant in a mode, or, where that cannot be looked at, in another; what
 * counts as zero only where `near` is the instant. */
static int look_as(const bg_sight *c, const bg_instant *at, const bg_instant *near,
                   const int *mode, bg_port *now)
{
    int known[BG_MOST_PORTS];
    memcpy(known, mode, sizeof(int) * (size_t)c->ports);
    const int status = bg_evaluated(c, at, 0, known);
    if (status == BG_OK)
        c->tell(c->self, known, near, now, NULL);
    return status;
}

/* The stops whose gap is closed: whose event it is, that were held, or to rounding; the others. */
static int find_met(const bg_sight *c, const bg_instant *at, const int *mode, bg_set *met,
                    bg_set *apart)
{
    bg_port now[BG_MOST_PORTS];
    const int status = look_as(c, at, at, mode, now);
    if (status)
        return status;
    for (int i = 0; i < c->ports; i++) {
        if (c->switches[i].kind != BG_STOPS)
            continue;
        const int closed = at->touched[i] || !bg_is_apart(c->switches + i, mode[i]);
        bg_add(closed || now[i].gap <= now[i].near_gap ? met : apart, i);
    }
    return BG_OK;
}

/* How fast what meets a stop leaves it; 0 if it hardly would. One that was found late, beyond its
 * bound, had another speed there. */
static double leaving_speed(const bg_switch *one, const bg_port *now)
{
    const double slip = one->side * now->slip, push = one->side * now->push;
    const double depth = now->gap < -now->near_gap ? -now->gap : 0.0;
    if (now->back <= 0.0 || slip >= -BG_BOUNCE * now->near_slip)
        return 0.0;
    const double speed = now->back * sqrt(fmax(0.0, slip * slip + 2.0 * push * depth));
    return speed * speed > 2.0 * BG_LEAP * fmax(-push, 0.0) * now->near_gap ? speed : 0.0;
}

/* Whether what an impact has opened would close again before its gap could be seen. What is joined
 * to it came to rest; unless it were stopped, too, the two might take turns for ever. */
static int hardly_leaves(const bg_switch *one, const bg_port *now)
{
    const double slip = one->side * now->slip, pressed = fmax(-one->side * now->push, 0.0);
    return slip > now->near_slip && slip * slip <= 2.0 * BG_LEAP * pressed * now->near_gap;
}

/* Those among some stops that bounce as they are met; or, if `leaving`, those that hardly leave,
 * to be stopped. What is held is pressed with what holds it. */
static int find_wanted(const bg_sight *c, const bg_instant *at, const int *mode, bg_set among,
                       int leaving, bg_throw *wanted)
{
    bg_port now[BG_MOST_PORTS];
    memset(wanted, 0, sizeof *wanted);
    if (bg_is_empty(&among))
        return BG_OK;
    const int status = look_as(c, at, at, mode, now);
    if (status)
        return status;
    for (int i = 0; i < c->ports; i++) {
        const bg_switch *const one = c->switches + i;
        if (!bg_has(&among, i) || one->on || !bg_is_apart(one, mode[i]))
            continue;
        wanted->speed[i] = leaving ? 0.0 : leaving_speed(one, now + i);
        if (leaving ? hardly_leaves(one, now + i) : wanted->speed[i] > 0.0)
            bg_add(&wanted->ports, i);
    }
    return BG_OK;
}

/* Takes what an impact leads to as s, and tells of what it has thrown back. */
static int take_blow(const bg_sight *c, const bg_instant *at, const bg_set *thrown,
                     const bg_blow *blow)
{
    bg_log *const log = at->log;
    memcpy(at->s, c->struck, sizeof(double) * (size_t)c->size);
    for (int i = 0; i < c->ports && log; i++) {
        if (!bg_has(thrown, i) || blow->given[i] == 0.0) {
            log->given[i] += blow->given[i];
            continue;
        }
        log->thrown = 1;
        if (bg_append(log, (bg_event){at->t, i, BG_HIT, blow->given[i]}))
            return BG_EVENTS;
    }
    return BG_OK;
}

/* Closes the gaps of these stops, as far as they are rounding. */
static int close_up(const bg_sight *c, const bg_instant *at, const int *mode, const bg_set *met)
{
    bg_port now[BG_MOST_PORTS];
    if (bg_is_empty(met))
        return BG_OK;
    const int status = look_as(c, at, NULL, mode, now);
    if (status)
        return status;
    for (int i = 0; i < c->ports; i++)
        if (bg_has(met, i))
            at->s[c->switches[i].place] -= c->switches[i].opening * now[i].gap;
    return BG_OK;
}

/* Stops what hardly leaves, at the end of what was struck. */
static int still(const bg_sight *c, const bg_instant *at, const bg_set *met, const int *mode,
                 int *thrown)
{
    const bg_set none = {{0}};
    bg_throw wanted;
    bg_blow blow = {0};
    int status = find_wanted(c, at, mode, *met, 1, &wanted);
    if (status == BG_OK && !bg_is_empty(&wanted.ports))
        status = bg_bring_to_rest(c, at, mode, &wanted, &blow);
    *thrown = blow.struck;
    return status == BG_OK && *thrown ? take_blow(c, at, &none, &blow) : status;
}

/* One turn: joins, then throws back; whether anything was joined and thrown. */
static int strike_in_turn(const bg_sight *c, const bg_instant *at, const bg_set *met,
                          const bg_set *apart, int *mode, int *joined, int *thrown)
{
    bg_throw wanted;
    bg_blow blow = {0};
    int status = find_wanted(c, at, mode, *met, 0, &wanted);
    const bg_set barred = bg_turned(*apart, &wanted.ports);
    if (status == BG_OK)
        status = bg_choose_once(c, at, &barred, mode, &blow);
    *joined = blow.struck;
    blow.struck = 0;
    if (status == BG_OK)
        status = find_wanted(c, at, mode, wanted.ports, 0, &wanted);
    if (status == BG_OK && !bg_is_empty(&wanted.ports))
        status = bg_throw_back(c, at, mode, &wanted, &blow);
    *thrown = blow.struck;
    return status == BG_OK && *thrown ? take_blow(c, at, &wanted.ports, &blow) : status;
}

int bg_choose_struck(const bg_sight *c, const bg_instant *at, int *mode)
{
    bg_instant now = *at;
    bg_set met = {{0}}, apart = {{0}};
    int status = find_met(c, at, mode, &met, &apart), joinings = 0, struck = 0;
    for (int turn = 0; turn < BG_BOUNCES && status == BG_OK; turn++) {
        int joined, thrown;
        status = strike_in_turn(c, &now, &met, &apart, mode, &joined, &thrown);
        memset(now.touched, 0, sizeof now.touched);
        if (status == BG_OK && struck && !joined && !thrown)
            status = still(c, &now, &met, mode, &thrown);
        struck |= joined | thrown;
        joinings += joined;
        if (status == BG_OK && !thrown && (!joined || joinings > BG_IMPACTS))
            return close_up(c, &now, mode, &met);
    }
    return status ? status : BG_STRUCK;
}
