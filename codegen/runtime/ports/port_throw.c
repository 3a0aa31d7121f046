/* The impulses that throw back what closes on stops: with p those and y the slips as gaps open,
 * p >= 0, y+ + e y- >= 0, and one of them zero, which Murty's rule solves. */
#include <math.h>
#include <string.h>

#include "port_choosing.h"

/* The slips of all ports at s, everything let go and friction slipping so; a status. */
static int slips_at(const bg_sight *c, const bg_instant *at, const double *s, const int *loose,
                    double *slips)
{
    bg_port now[BG_MOST_PORTS];
    const int status = c->look(c->self, at->t, s, loose);
    if (status)
        return status;
    c->tell(c->self, loose, NULL, now, NULL);
    for (int i = 0; i < c->ports; i++)
        slips[i] = now[i].slip;
    return BG_OK;
}

/* The ports that may take part: those that are wanted, and what a push alone holds in the mode. */
static bg_set pushing(const bg_sight *c, const int *mode, const bg_set *wanted)
{
    bg_set found = {{0}};
    for (int i = 0; i < c->ports; i++)
        if (c->switches[i].side && (mode[i] == 0 || bg_has(wanted, i)))
            bg_add(&found, i);
    return found;
}

/* The impact where these take part, with what holds both ways; s after it goes to c->struck. */
static int strike_some(const bg_sight *c, const bg_instant *at, const int *mode,
                       const bg_throw *wanted, const bg_set *active, bg_blow *blow)
{
    int tried[BG_MOST_PORTS], any = 0;
    double speeds[BG_MOST_PORTS] = {0};
    *blow = (bg_blow){0};
    for (int i = 0; i < c->ports; i++) {
        const bg_switch *const one = c->switches + i;
        tried[i] = one->kind == BG_RUBS || one->side ? 1 : mode[i];
        if (bg_has(active, i)) {
            tried[i] = 0;
            speeds[i] = one->side * wanted->speed[i];
        }
        any |= tried[i] == 0;
    }
    memcpy(c->struck, at->s, sizeof(double) * (size_t)c->size);
    return any ? c->strike(c->self, at, tried, speeds, c->struck, blow) : BG_OK;
}

/* Of the ports that may take part those that would pull, that open faster than they ought to, or
 * not fast enough. */
static bg_set contrary_pushes(const bg_sight *c, const bg_throw *wanted, const bg_set *may,
                              const bg_set *active, const bg_blow *blow, const double *after)
{
    bg_set wrong = {{0}};
    double largest = 0.0;
    for (int i = 0; i < c->ports; i++)
        largest = fmax(largest, fabs(blow->given[i]));
    for (int i = 0; i < c->ports; i++) {
        const double way = c->switches[i].side, over = way * after[i] - wanted->speed[i];
        const double near = blow->near[i];
        if (!bg_has(may, i))
            continue;
        if (bg_has(active, i) ? over > near || way * blow->given[i] > BG_ROUNDING * largest
                              : over < -near)
            bg_add(&wrong, i);
    }
    return wrong;
}

/* A strike at an instant: the slips before it and after it, the latter of what is tried last. */
typedef struct {
    const bg_sight *c;
    const bg_instant *at;
    const int *mode;
    const bg_throw *wanted;
    int loose[BG_MOST_PORTS];
    double before[BG_MOST_PORTS], after[BG_MOST_PORTS];
} bg_throwing;

/* The impact where these take part, and the slips after it. */
static int try_strike(bg_throwing *t, const bg_set *active, bg_blow *blow)
{
    const int status = strike_some(t->c, t->at, t->mode, t->wanted, active, blow);
    return status || !blow->struck ? status
                                   : slips_at(t->c, t->at, t->c->struck, t->loose, t->after);
}

/* Of these the ports whose slips depend on those of others, and were left far from wanted. */
static bg_set left_short(const bg_throwing *t, const bg_set *active, const bg_blow *blow)
{
    bg_set found = {{0}};
    for (int i = 0; i < t->c->ports; i++) {
        const double way = t->c->switches[i].side, wanted = t->wanted->speed[i];
        const double least = fmax(blow->near[i], BG_SHORT_OF * (wanted - way * t->before[i]));
        if (bg_has(active, i) && wanted - way * t->after[i] > least)
            bg_add(&found, i);
    }
    return found;
}

/* The port without which those left short get what is wanted. */
static int find_hindering(bg_throwing *t, const bg_set *active, const bg_set *lacking, int *port)
{
    bg_set others = bg_turned(*active, lacking);
    if (bg_is_empty(&others))
        others = *lacking;
    *port = bg_first_of(&others);
    for (int i = 0; i < t->c->ports; i++) {
        const bg_set one = bg_only(i), less = bg_turned(*active, &one);
        bg_blow blow;
        if (!bg_has(&others, i))
            continue;
        const int status = try_strike(t, &less, &blow);
        if (status)
            return status;
        const bg_set still_short = left_short(t, lacking, &blow);
        if (blow.struck && bg_is_empty(&still_short)) {
            *port = i;
            return BG_OK;
        }
    }
    return BG_OK;
}

/* The port that is to change over next in Murty's rule; -1 where all is as it is to be. Two stops
 * at one motion, each with a speed of its own, do not both take part. */
static int find_next(bg_throwing *t, const bg_set *may, const bg_set *active,
                     const bg_blow *blow, int *port)
{
    const bg_set lacking = left_short(t, active, blow);
    if (!bg_is_empty(&lacking))
        return find_hindering(t, active, &lacking, port);
    const bg_set wrong = contrary_pushes(t->c, t->wanted, may, active, blow, t->after);
    *port = bg_is_empty(&wrong) ? -1 : bg_first_of(&wrong);
    return BG_OK;
}

int bg_throw_back(const bg_sight *c, const bg_instant *at, const int *mode, const bg_throw *wanted,
                  bg_blow *blow)
{
    bg_throwing t = {.c = c, .at = at, .mode = mode, .wanted = wanted};
    const bg_set may = pushing(c, mode, &wanted->ports);
    bg_set active = may;
    int port;
    for (int i = 0; i < c->ports; i++)
        t.loose[i] = 1;
    int status = bg_evaluated(c, at, 1, t.loose);
    if (status == BG_OK)
        status = slips_at(c, at, at->s, t.loose, t.before);
    for (int turn = 0; turn < BG_BOUNCES && status == BG_OK; turn++) {
        status = try_strike(&t, &active, blow);
        if (status || !blow->struck)
            return status;
        status = find_next(&t, &may, &active, blow, &port);
        if (status || port < 0)
            return status;
        const bg_set one = bg_only(port);
        active = bg_turned(active, &one);
    }
    return status ? status : BG_STRUCK;
}

int bg_bring_to_rest(const bg_sight *c, const bg_instant *at, const int *mode,
                     const bg_throw *wanted, bg_blow *blow)
{
    const bg_set all = pushing(c, mode, &wanted->ports);
    return strike_some(c, at, mode, wanted, &all, blow);
}
