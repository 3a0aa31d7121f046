/* The ways of switches in turn; at most as many as there are. */
#include "port_ways.h"

#include "port_choose.h"

enum { WAYS = 1 << BG_MOST_PORTS, TURNS = 50 };

typedef struct {
    int ports;
    unsigned switches;
    bg_way attempt;
    void *self;
    unsigned char seen[WAYS];
} way_search;

static int try_one(way_search *s, unsigned held, int *holds, unsigned *broken)
{
    s->seen[held] = 1;
    *holds = 0;
    *broken = 0;
    return s->attempt(s->self, held, holds, broken);
}

/* All that contradict change over until that has been tried, then the first of them (Murty). */
static int follow(way_search *s, unsigned held, int *holds)
{
    unsigned broken = 0, last = held;
    int status = 0;
    while (!s->seen[held]) {
        status = try_one(s, held, holds, &broken);
        if (status || *holds || broken == 0)
            return status;
        last = held;
        held ^= broken;
    }
    held = last ^ (broken & (~broken + 1u));
    for (int k = 0; k < TURNS * s->ports && !s->seen[held]; k++) {
        status = try_one(s, held, holds, &broken);
        if (status || *holds || broken == 0)
            return status;
        held ^= broken & (~broken + 1u);
    }
    return status;
}

/* How many of the switches differ in `change`, whose highest bit is the first of them; those, as
 * bits of the ports. */
static int changes(const way_search *s, unsigned change, int count, unsigned *ports)
{
    int changed = 0, at = count;
    *ports = 0;
    for (int i = 0; i < s->ports; i++)
        if (s->switches >> i & 1u) {
            at--;
            if (change >> at & 1u) {
                *ports |= 1u << i;
                changed++;
            }
        }
    return changed;
}

/* All ways, by how many switches differ from the first. */
static int try_all(way_search *s, unsigned first, int *holds)
{
    int count = 0, status = 0;
    for (int i = 0; i < s->ports; i++)
        count += (s->switches >> i & 1u) != 0;
    for (int changed = 1; changed <= count; changed++)
        for (unsigned change = 1u << count; change-- > 0;) {
            unsigned ports, broken;
            if (changes(s, change, count, &ports) != changed || s->seen[first ^ ports])
                continue;
            status = try_one(s, first ^ ports, holds, &broken);
            if (status || *holds)
                return status;
        }
    return status;
}

int bg_try_ways(int ports, unsigned switches, unsigned first, bg_way attempt, void *self,
                int *holds)
{
    way_search s = {.ports = ports, .switches = switches, .attempt = attempt, .self = self};
    *holds = 0;
    const int status = follow(&s, first, holds);
    return status || *holds ? status : try_all(&s, first, holds);
}
