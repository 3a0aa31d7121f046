/* Modes in turn, those that stick most first, until one contradicts nothing. */
#include "port_choosing.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

enum { MOST_SLIPPING = 10 }; /* up to so many ports all ways of slipping are tried */

int bg_ends_search(int status)
{
    return status == BG_NEEDS_SLOPE || status == BG_STRUCTURE || status == BG_NOT_AFFINE
        || status >= BG_MISSING;
}

int bg_try(int ports, int number, const int *mode, int *tried)
{
    const int ways = ports <= MOST_SLIPPING ? 1 << ports : 0;
    for (int i = 0; i < ports; i++) {
        if (number < 2)
            tried[i] = mode[i] ? mode[i] : number == 0 ? 1 : -1;
        else if (number == 2)
            tried[i] = mode[i];
        else
            tried[i] = number - 3 >= ways ? 0 : (number - 3) >> i & 1 ? -1 : 1;
    }
    return number < ways + 4;
}

int bg_evaluated(const bg_sight *c, const bg_instant *at, int slipping, int *mode)
{
    int tried[BG_MOST_PORTS], first = BG_OK;
    int status = slipping ? BG_UNDECIDED : c->look(c->self, at->t, at->s, mode);
    if (!slipping && (status == BG_OK || bg_ends_search(status)))
        return status;
    first = slipping ? BG_OK : status;
    for (int k = 0; k < BG_TRIES && bg_try(c->ports, k, mode, tried); k++) {
        status = c->look(c->self, at->t, at->s, tried);
        for (int i = 0; i < c->ports && status == BG_OK; i++)
            mode[i] = tried[i];
        if (status == BG_OK || bg_ends_search(status))
            return status;
        first = first ? first : status;
    }
    return first;
}

/* The first way of one block that contradicts none of the ports asked. *broken: switches that alone
 * contradict the first that could be one. */
static int search_block(bg_choice *choice, bg_port_block *block, const bg_set *asked, int *mode,
                        int *holds, bg_set *broken)
{
    bg_tried tried;
    bg_finding found;
    int tries = 1;
    tried.count = 0;
    *holds = 0;
    for (bg_begin_block(choice, block, mode); tries;
         tries = bg_next_way(choice, block, &tried, &found, mode)) {
        const int status = bg_find(choice, mode, asked, &found);
        *holds = found.holds;
        if (status || *holds)
            return status;
        if (bg_is_empty(broken) && !found.rubbing)
            *broken = found.broken;
    }
    return BG_OK;
}

/* The first way of each block, all looked at together: at an instant none touches another. */
static int side_by_side(bg_choice *choice, int blocks, bg_port_block *block, int *mode, int *holds)
{
    bg_tried tried;
    bg_finding found;
    tried.count = 0;
    for (int k = 0; k < blocks; k++)
        bg_begin_block(choice, block + k, mode);
    for (;;) {
        const int status = bg_find(choice, mode, &choice->open, &found);
        *holds = found.holds;
        if (status || *holds || bg_is_empty(&found.turned))
            return status;
        for (int k = 0; k < blocks; k++) {
            int any = 0;
            for (int l = 0; l < block[k].count; l++)
                any |= bg_has(&found.turned, block[k].ports[l]);
            if (any && !bg_next_way(choice, block + k, &tried, &found, mode))
                return BG_OK;
        }
    }
}

/* The first way of each block after those before it, where a whole way cannot be looked at; none
 * where they contradict one another: what a switch holds may join blocks that nothing else does. */
static int one_by_one(bg_choice *choice, int blocks, bg_port_block *block, int *mode, int *holds)
{
    bg_finding found;
    for (int k = 0; k < blocks; k++) {
        bg_set asked = {{0}}, broken = {{0}};
        for (int l = 0; l < block[k].count; l++)
            bg_add(&asked, block[k].ports[l]);
        const int status = search_block(choice, block + k, &asked, mode, holds, &broken);
        if (status || !*holds)
            return status;
    }
    const int status = bg_find(choice, mode, &choice->open, &found);
    *holds = found.holds;
    return status;
}

/* The first way of several blocks; where some ports depend on others only as they hold, of all at
 * once. */
static int search_blocks(bg_choice *choice, int blocks, bg_port_block *block, int *mode, int *holds)
{
    int begun[BG_MOST_PORTS], count = 0;
    bg_set broken = {{0}};
    memcpy(begun, mode, sizeof begun);
    int status = side_by_side(choice, blocks, block, mode, holds);
    if (status || *holds)
        return status;
    memcpy(mode, begun, sizeof begun);
    status = one_by_one(choice, blocks, block, mode, holds);
    if (status || *holds)
        return status;
    memcpy(mode, begun, sizeof begun);
    int every[BG_MOST_PORTS];
    for (int i = 0; i < choice->sight->ports; i++)
        if (bg_has(&choice->open, i))
            every[count++] = i;
    bg_port_block all = {.count = count, .ports = every};
    return search_block(choice, &all, &choice->open, mode, holds, &broken);
}

/* On which side a jump of second order is, that is not where it jumps; 0 of any other port. */
static int side_of(const bg_switch *one, const bg_port *now, int loose)
{
    if (!bg_hangs(one) || fabs(now->gap) <= (loose ? BG_WIDE : 1.0) * now->near_gap)
        return 0;
    return now->gap > 0 ? 1 : -1;
}

/* The friction ports that may stick, where `now` is with friction slipping; the others slip as they
 * do. How many. */
static int find_open(bg_choice *choice, const bg_port *now, const int *mode, int *slipping,
                     int *ports)
{
    const bg_sight *const c = choice->sight;
    int count = 0;
    memset(&choice->open, 0, sizeof choice->open);
    memset(&choice->switches, 0, sizeof choice->switches);
    for (int i = 0; i < c->ports; i++) {
        const double slip = fabs(now[i].slip), near = now[i].near_slip;
        const int touched = choice->at->touched[i];
        const int loose = touched || mode[i] == 0;
        /* A jump of second order is crossed as a rule, at a speed that tells. */
        const int passed = touched == BG_PASSED && !bg_hangs(c->kinds + i);
        if (c->switches && c->switches[i].kind != BG_RUBS) {
            slipping[i] = mode[i];
            if (!bg_has(&choice->barred, i))
                bg_add(&choice->switches, i);
            continue;
        }
        const int side = side_of(c->kinds + i, now + i, loose);
        slipping[i] = side ? side : now[i].slip > 0 ? 1 : -1;
        if (side)
            continue;
        if (c->coupled[i] || slip <= near || (passed && !choice->blow.struck)
            || (loose && slip <= BG_WIDE * near)) {
            ports[count++] = i;
            bg_add(&choice->open, i);
        }
    }
    return count;
}

/* Friction ports that slip as in `found` stick where they do, so that nothing is contradicted. */
static int stick(bg_choice *choice, int count, int *ports, int *found, int *holds, bg_set *broken)
{
    bg_port_block block[BG_MOST_PORTS];
    bg_set asked = bg_turned(choice->open, &choice->switches);
    int blocks, status = bg_partition(choice, found, count, ports, block, &blocks);
    if (status == BG_OK && blocks > 1) {
        status = search_blocks(choice, blocks, block, found, holds);
        if (status || !*holds || bg_is_empty(&choice->switches))
            return status;
        block[0].count = 0;
    }
    return status ? status : search_block(choice, block, &asked, found, holds, broken);
}

int bg_choose_rubbing(bg_choice *choice, int *mode, int *holds, bg_set *broken)
{
    const bg_sight *const c = choice->sight;
    const bg_instant here = {.t = choice->at->t, .time = choice->at->time, .s = choice->s};
    int found[BG_MOST_PORTS], ports[BG_MOST_PORTS];
    bg_port now[BG_MOST_PORTS];
    *holds = 0;
    memset(broken, 0, sizeof *broken);
    for (int i = 0; i < c->ports; i++)
        found[i] = mode[i];
    int status = bg_evaluated(c, &here, 1, found);
    if (status) {
        choice->why = choice->why ? choice->why : status;
        return bg_ends_search(status) ? status : BG_OK;
    }
    bg_tell(choice, found, now, NULL);
    choice->before = mode;
    const int count = find_open(choice, now, mode, found, ports);
    status = stick(choice, count, ports, found, holds, broken);
    for (int i = 0; i < c->ports && *holds; i++)
        mode[i] = found[i];
    return status;
}
