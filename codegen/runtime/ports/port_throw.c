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

/* The impact where these stops take part; s after it goes to c->struck. */
static int strike_some(const bg_sight *c, const bg_instant *at, const int *mode,
                       const bg_throw *wanted, const bg_set *active, bg_blow *blow)
{
    int tried[BG_MOST_PORTS], any = 0;
    double speeds[BG_MOST_PORTS] = {0};
    *blow = (bg_blow){0};
    for (int i = 0; i < c->ports; i++) {
        tried[i] = c->switches[i].kind == BG_RUBS ? 1 : mode[i];
        if (bg_has(active, i)) {
            tried[i] = 0;
            speeds[i] = c->switches[i].side * wanted->speed[i];
        }
        any |= tried[i] == 0;
    }
    memcpy(c->struck, at->s, sizeof(double) * (size_t)c->size);
    return any ? c->strike(c->self, at, tried, speeds, c->struck, blow) : BG_OK;
}

/* The stops that would pull, that bounce faster than they ought to, or not enough. */
static bg_set contrary_stops(const bg_sight *c, const bg_throw *wanted, const bg_set *active,
                             const bg_blow *blow, const double *before, const double *after)
{
    bg_set wrong = {{0}};
    double largest = 0.0;
    for (int i = 0; i < c->ports; i++)
        largest = fmax(largest, fabs(blow->given[i]));
    for (int i = 0; i < c->ports; i++) {
        const double way = c->switches[i].side, over = way * after[i] - wanted->speed[i];
        const double near =
            BG_ROUNDING * (fabs(before[i]) + fabs(after[i] - before[i]) + wanted->speed[i]);
        if (!bg_has(&wanted->ports, i))
            continue;
        if (bg_has(active, i) ? over > near || way * blow->given[i] > BG_ROUNDING * largest
                              : over < -near)
            bg_add(&wrong, i);
    }
    return wrong;
}

/* Of those that are wrong the one that changes: one that takes part, if there is any. */
static bg_set one_of(const bg_set *wrong, const bg_set *active)
{
    bg_set both = {{0}};
    for (int k = 0; k < BG_SET_WORDS; k++)
        both.bits[k] = wrong->bits[k] & active->bits[k];
    return bg_only(bg_first_of(bg_is_empty(&both) ? wrong : &both));
}

int bg_throw_back(const bg_sight *c, const bg_instant *at, const int *mode, const bg_throw *wanted,
                  bg_blow *blow)
{
    double before[BG_MOST_PORTS], after[BG_MOST_PORTS];
    int loose[BG_MOST_PORTS];
    bg_set active = wanted->ports;
    for (int i = 0; i < c->ports; i++)
        loose[i] = 1;
    int status = bg_evaluated(c, at, 1, loose);
    if (status == BG_OK)
        status = slips_at(c, at, at->s, loose, before);
    for (int turn = 0; turn < BG_BOUNCES && status == BG_OK; turn++) {
        status = strike_some(c, at, mode, wanted, &active, blow);
        if (status || !blow->struck)
            return status;
        status = slips_at(c, at, c->struck, loose, after);
        const bg_set wrong = contrary_stops(c, wanted, &active, blow, before, after);
        if (status || bg_is_empty(&wrong))
            return status;
        const bg_set one = one_of(&wrong, &active);
        active = bg_turned(active, &one);
    }
    return status ? status : BG_STRUCK;
}
