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

/* Whether what leaves with a speed leaps higher than displacements are known. */
static int is_seen(const bg_switch *one, const bg_port *now, double speed)
{
    return speed * speed > 2.0 * BG_LEAP * fmax(-one->side * now->push, 0.0) * now->near_gap;
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
    return is_seen(one, now, speed) ? speed : 0.0;
}

/* What is looked for among stops that are touched and let go. Those that bounce as they close;
 * those that bounce and are about to open, which what joins does not join; if one closes so slowly
 * that no impact would see it, all that are slow: an impact that joins leaves what is an event's
 * own rounding, and a push that has turned by then would find neither way consistent; and what an
 * impact has opened, but would close again before its gap could be seen: what is joined to it came
 * to rest, and unless it were stopped, too, the two might take turns for ever. */
enum wanted { BOUNCES, OPENS, CREEPS, HARDLY_LEAVES };

/* Whether a stop is wanted so, which bounces at a speed; of the slow tells if it closes. */
static int is_wanted(enum wanted what, const bg_switch *one, const bg_port *now, double speed,
                     int *closes)
{
    const double slip = one->side * now->slip;
    if (what == BOUNCES)
        return speed > 0.0;
    if (what == OPENS || what == HARDLY_LEAVES)
        *closes = 1;
    if (what == OPENS)
        return now->back > 0.0 && slip > now->near_slip;
    if (what == HARDLY_LEAVES)
        return slip > now->near_slip && !is_seen(one, now, slip);
    const int slow = speed == 0.0 && slip >= -2.0 * BG_WIDE * now->near_slip;
    *closes |= slow && slip < -now->near_slip;
    return slow;
}

/* Those among some stops that are wanted, and how fast they are to leave. What is held is pressed
 * with what holds it. */
static int find_wanted(const bg_sight *c, const bg_instant *at, const int *mode, bg_set among,
                       enum wanted what, bg_throw *wanted)
{
    bg_port now[BG_MOST_PORTS];
    int any = what == BOUNCES;
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
        const double speed = leaving_speed(one, now + i);
        wanted->speed[i] = what == BOUNCES ? speed : 0.0;
        if (is_wanted(what, one, now + i, speed, &any))
            bg_add(&wanted->ports, i);
    }
    if (!any)
        memset(wanted, 0, sizeof *wanted);
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
        bg_add(&log->back, i);
        if (!log->begins && bg_append(log, (bg_event){at->t, i, BG_HIT, blow->given[i]}))
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

/* Stops some that are met: what creeps, or what hardly leaves; whether there was any. */
static int still(const bg_sight *c, const bg_instant *at, const bg_set *met, const int *mode,
                 enum wanted what, int *stilled)
{
    const bg_set none = {{0}};
    bg_throw wanted;
    bg_blow blow = {0};
    int status = find_wanted(c, at, mode, *met, what, &wanted);
    if (status == BG_OK && !bg_is_empty(&wanted.ports))
        status = what == CREEPS ? bg_throw_back(c, at, mode, &wanted, &blow)
                                : bg_bring_to_rest(c, at, mode, &wanted, &blow);
    *stilled = blow.struck;
    return status == BG_OK && *stilled ? take_blow(c, at, &none, &blow) : status;
}

/* One turn: joins, then throws back; whether anything was joined and thrown. */
static int strike_in_turn(const bg_sight *c, const bg_instant *at, const bg_set *met,
                          const bg_set *apart, int *mode, int *joined, int *thrown)
{
    *joined = *thrown = 0;
    bg_throw wanted, opens;
    bg_blow blow = {0};
    int status = find_wanted(c, at, mode, *met, BOUNCES, &wanted);
    if (status == BG_OK)
        status = find_wanted(c, at, mode, *met, OPENS, &opens);
    if (status)
        return status;
    const bg_set among = bg_turned(wanted.ports, &opens.ports);
    const bg_set barred = bg_turned(*apart, &among);
    status = bg_choose_once(c, at, &barred, mode, &blow);
    *joined = blow.struck;
    blow.struck = 0;
    if (status == BG_OK)
        status = find_wanted(c, at, mode, among, BOUNCES, &wanted);
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
        int joined = 0, thrown = 0, crept;
        status = still(c, &now, &met, mode, CREEPS, &crept);
        struck |= crept;
        if (status == BG_OK)
            status = strike_in_turn(c, &now, &met, &apart, mode, &joined, &thrown);
        memset(now.touched, 0, sizeof now.touched);
        if (status == BG_OK && struck && !joined && !thrown)
            status = still(c, &now, &met, mode, HARDLY_LEAVES, &thrown);
        struck |= joined | thrown;
        joinings += joined;
        if (status == BG_OK && !thrown && (!joined || joinings > BG_IMPACTS))
            return close_up(c, &now, mode, &met);
    }
    return status ? status : BG_STRUCK;
}
