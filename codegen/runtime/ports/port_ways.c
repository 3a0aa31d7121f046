/* The ways of switches in turn; as codegen/standalone/switchings.py. */
#include "port_ways.h"

enum {
    ALL_WAYS = 12,  /* with more switches, further ways are those of few changes only */
    FEW = 2,
    TURNS = 50,     /* so often for each switch .. */
    MOST_TURNS = 1000, /* .. and in all */
    SEEN = BG_PORTS < 10 ? 1 << BG_PORTS : 2 * MOST_TURNS
};

/* `seen`: the ways that have been tried, but for those of few changes. */
typedef struct {
    int count, turns, known;
    int switches[BG_MOST_PORTS];
    bg_set guarded, contradicted;
    bg_way attempt;
    void *self;
    bg_set seen[SEEN];
} way_search;

static int was_seen(const way_search *s, const bg_set *held)
{
    for (int k = 0; k < s->known; k++)
        if (bg_is_same(s->seen + k, held))
            return 1;
    return 0;
}

static int try_one(way_search *s, const bg_set *held, int *holds, bg_set *broken)
{
    *holds = 0;
    *broken = (bg_set){{0}};
    const int status = s->attempt(s->self, held, holds, broken);
    for (int k = 0; k < s->count; k++)
        if (bg_has(broken, s->switches[k]))
            bg_add(&s->contradicted, s->switches[k]);
    return status;
}

/* Switches that contradict change over, all or the first of them, until a way has been tried. */
static int follow(way_search *s, int all, bg_set *last, bg_set *held, bg_set *broken, int *holds)
{
    for (int k = 0; k < s->turns && !was_seen(s, held); k++) {
        const int status = try_one(s, held, holds, broken);
        s->seen[s->known++] = *held;
        if (status || *holds || bg_is_empty(broken))
            return status;
        *last = *held;
        const bg_set first = bg_only(bg_first_of(broken));
        *held = bg_turned(*held, all ? broken : &first);
    }
    return 0;
}

/* All that contradict, then the first of them (Murty). */
static int follow_both(way_search *s, bg_set held, int *holds)
{
    bg_set broken = {{0}}, last = held;
    const int status = follow(s, 1, &last, &held, &broken, holds);
    if (status || *holds || bg_is_empty(&broken))
        return status;
    const bg_set first = bg_only(bg_first_of(&broken));
    held = bg_turned(last, &first);
    return follow(s, 0, &last, &held, &broken, holds);
}

int bg_next_choice(int size, int total, int *chosen)
{
    int at = size - 1;
    while (at >= 0 && chosen[at] == total - size + at)
        at--;
    if (at < 0)
        return 0;
    chosen[at]++;
    for (int i = at + 1; i < size; i++)
        chosen[i] = chosen[i - 1] + 1;
    return 1;
}

/* Whether some switches change over now: those with conditions of their own that contradict no mode
 * are as good as they are, and do so last of all. */
static int is_turn(const way_search *s, int size, const int *chosen, int last_of_all)
{
    int waits = 0, any = 0;
    for (int k = 0; k < size; k++) {
        const int i = s->switches[chosen[k]];
        any |= bg_has(&s->guarded, i);
        waits |= bg_has(&s->guarded, i) && !bg_has(&s->contradicted, i);
    }
    return last_of_all ? any : !waits;
}

/* All ways, by how many switches differ from the first. */
static int try_all(way_search *s, const bg_set *first, int last_of_all, int *holds)
{
    const int most = s->count <= ALL_WAYS ? s->count : FEW;
    int chosen[BG_MOST_PORTS];
    for (int changed = 1; changed <= most; changed++) {
        for (int k = 0; k < changed; k++)
            chosen[k] = k;
        do {
            bg_set held = *first, broken;
            if (!is_turn(s, changed, chosen, last_of_all))
                continue;
            for (int k = 0; k < changed; k++) {
                const bg_set one = bg_only(s->switches[chosen[k]]);
                held = bg_turned(held, &one);
            }
            if (was_seen(s, &held))
                continue;
            const int status = try_one(s, &held, holds, &broken);
            if (status || *holds)
                return status;
        } while (bg_next_choice(changed, s->count, chosen));
    }
    return 0;
}

int bg_try_ways(int ports, const bg_set *switches, const bg_set *guarded, bg_set first,
                bg_way attempt, void *self, int *holds)
{
    way_search s;
    s.guarded = *guarded;
    s.contradicted = (bg_set){{0}};
    s.count = s.known = 0;
    s.attempt = attempt;
    s.self = self;
    for (int i = 0; i < ports; i++)
        if (bg_has(switches, i))
            s.switches[s.count++] = i;
    s.turns = TURNS * s.count < MOST_TURNS ? TURNS * s.count : MOST_TURNS;
    if (s.count == 0)
        s.turns = 1; /* all stay as they are */
    *holds = 0;
    int status = follow_both(&s, first, holds);
    for (int last_of_all = 0; last_of_all < 2 && !status && !*holds; last_of_all++)
        status = try_all(&s, &first, last_of_all, holds);
    return status;
}
