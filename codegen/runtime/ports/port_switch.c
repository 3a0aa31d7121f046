/* Which switches hold: the ways to try, from the one at hand to those with more changes. */
#include <string.h>

#include "port_choosing.h"

enum { WAYS = 1 << BG_MOST_PORTS, TURNS = 50 };

double bg_stay(const bg_switch *s, int sign, double slip, double effort, const double *guards)
{
    if (s->kind == BG_TOLD)
        return -guards[s->guard + (s->on == (sign == 0))];
    return sign ? s->side * slip : -s->side * effort;
}

/* A search among the ways of the switches: those held are bits. */
typedef struct {
    bg_choice choice;
    const int *before;
    unsigned switches;
    unsigned char seen[WAYS];
} bg_search;

/* Tries one way: the switches that contradict it go to *broken; *holds with its mode. */
static int try_way(bg_search *search, unsigned held, int *mode, int *holds, unsigned *broken)
{
    bg_choice *const choice = &search->choice;
    const bg_sight *const c = choice->sight;
    int tried[BG_MOST_PORTS];
    search->seen[held] = 1;
    *holds = 0;
    *broken = 0;
    for (int i = 0; i < c->ports; i++)
        tried[i] = search->switches >> i & 1u ? !(held >> i & 1u) : search->before[i];
    memset(choice->shocks, 0, sizeof choice->shocks);
    choice->s = c->struck;
    memcpy(choice->s, choice->at->s, sizeof(double) * (size_t)c->size);
    choice->struck = 0;
    int status = BG_OK;
    if (held)
        status = c->strike(c->self, choice->at, tried, choice->s, choice->shocks, &choice->struck);
    if (status) {
        choice->why = choice->why ? choice->why : status;
        return status == BG_NEEDS_SLOPE || status == BG_STRUCTURE || status >= BG_MISSING ? status
                                                                                           : BG_OK;
    }
    status = bg_choose_rubbing(choice, tried, holds, broken);
    for (int i = 0; i < c->ports && *holds; i++)
        mode[i] = tried[i];
    return status;
}

/* All that contradict change over until that has been tried, then the first of them (Murty). */
static int follow(bg_search *search, unsigned held, int *mode, int *holds)
{
    unsigned broken = 0, last = held;
    int status = BG_OK;
    while (!search->seen[held]) {
        status = try_way(search, held, mode, holds, &broken);
        if (status || *holds || broken == 0)
            return status;
        last = held;
        held ^= broken;
    }
    held = last ^ (broken & (~broken + 1u));
    for (int k = 0; k < TURNS * search->choice.sight->ports && !search->seen[held]; k++) {
        status = try_way(search, held, mode, holds, &broken);
        if (status || *holds || broken == 0)
            return status;
        held ^= broken & (~broken + 1u);
    }
    return status;
}

/* How many of the switches differ in `change`, whose highest bit is the first of them; those, as
 * bits of the ports. */
static int changes(const bg_search *search, unsigned change, int count, unsigned *ports)
{
    int changed = 0, at = count;
    *ports = 0;
    for (int i = 0; i < search->choice.sight->ports; i++)
        if (search->switches >> i & 1u) {
            at--;
            if (change >> at & 1u) {
                *ports |= 1u << i;
                changed++;
            }
        }
    return changed;
}

/* All ways, by how many switches differ from the first. */
static int try_all(bg_search *search, unsigned first, int *mode, int *holds)
{
    int count = 0, status = BG_OK;
    for (int i = 0; i < search->choice.sight->ports; i++)
        count += search->switches >> i & 1u;
    for (int changed = 1; changed <= count; changed++)
        for (unsigned change = 1u << count; change-- > 0;) {
            unsigned ports, broken;
            if (changes(search, change, count, &ports) != changed || search->seen[first ^ ports])
                continue;
            status = try_way(search, first ^ ports, mode, holds, &broken);
            if (status || *holds)
                return status;
        }
    return status;
}

/* The mode, where some ports are switches. */
static int choose_switched(bg_search *search, int *mode, int *holds)
{
    const bg_choice *const choice = &search->choice;
    const bg_sight *const c = choice->sight;
    unsigned first = 0;
    for (int i = 0; i < c->ports; i++) {
        if (c->switches[i].kind == BG_RUBS)
            continue;
        search->switches |= 1u << i;
        first |= (unsigned)(mode[i] == 0) << i;
    }
    const int status = follow(search, first, mode, holds);
    return status || *holds ? status : try_all(search, first, mode, holds);
}

int bg_choose(const bg_sight *c, const bg_instant *at, int *mode)
{
    int before[BG_MOST_PORTS], holds = 0;
    unsigned broken;
    bg_search search = {.choice = {.sight = c, .at = at, .s = at->s}, .before = before};
    memcpy(before, mode, sizeof(int) * (size_t)c->ports);
    const int status = c->switches ? choose_switched(&search, mode, &holds)
                                   : bg_choose_rubbing(&search.choice, mode, &holds, &broken);
    if (status || !holds)
        return status ? status : search.choice.why;
    if (search.choice.struck)
        memcpy(at->s, search.choice.s, sizeof(double) * (size_t)c->size);
    return BG_OK;
}
