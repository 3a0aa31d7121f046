/* Friction ports in blocks that do not touch one another at an instant, and ways to
 * stick and slip: as codegen/modes/blocks.py. */
#include "port_choosing.h"

/* Choice `number` among three to the power of the ports, the last changing fastest: whether so many
 * stick, and so many that were not touched change, as the block asks for. */
static int put_way(const bg_choice *choice, const bg_port_block *block, int number, int *mode)
{
    int sticking = 0, changed = 0;
    for (int k = block->count - 1; k >= 0; k--) {
        const int i = block->ports[k], before = choice->before[i];
        const int digit = number % 3, forward = before ? before : 1;
        number /= 3;
        mode[i] = digit == 0 ? 0 : digit == 1 ? forward : -forward;
        sticking += mode[i] == 0;
        changed += !choice->at->touched[i] && mode[i] != before;
    }
    return sticking == block->stick && changed == block->change;
}

static int next_number(const bg_choice *choice, bg_port_block *block, int *mode)
{
    int total = 1;
    for (int k = 0; k < block->count; k++)
        total *= 3;
    for (; block->stick >= 0; block->stick--, block->change = 0)
        for (; block->change <= block->count; block->change++, block->number = -1)
            while (++block->number < total)
                if (put_way(choice, block, block->number, mode))
                    return 1;
    return 0;
}

void bg_begin_block(const bg_choice *choice, bg_port_block *block, int *mode)
{
    block->stick = block->count;
    block->change = block->turns = 0;
    block->number = -1;
    if (block->count <= BG_ENUMERATED)
        next_number(choice, block, mode);
    else
        for (int k = 0; k < block->count; k++)
            mode[block->ports[k]] = 0;
}

/* Whether the way of a block in a mode has been tried; it is kept, if it is to be. */
static int was_tried(bg_tried *tried, const bg_port_block *block, const int *mode, int keep)
{
    bg_set held = {{0}}, back = {{0}};
    for (int k = 0; k < block->count; k++) {
        if (mode[block->ports[k]] == 0)
            bg_add(&held, block->ports[k]);
        else if (mode[block->ports[k]] < 0)
            bg_add(&back, block->ports[k]);
    }
    for (int k = 0; k < tried->count; k++)
        if (tried->ways[k].block == block->ports && bg_is_same(&tried->ways[k].held, &held)
            && bg_is_same(&tried->ways[k].back, &back))
            return 1;
    if (keep && tried->count < BG_BLOCK_WAYS) {
        tried->ways[tried->count].block = block->ports;
        tried->ways[tried->count].held = held;
        tried->ways[tried->count++].back = back;
    }
    return 0;
}

/* Ports that contradict turn, at most so many: what slips sticks, what sticks slips as pushed. */
static int turn_ports(const bg_port_block *block, const bg_finding *found, int most, int *mode)
{
    int count = 0;
    for (int k = 0; k < block->count && count < most; k++) {
        const int i = block->ports[k];
        if (bg_has(&found->turned, i)) {
            mode[i] = mode[i] ? 0 : bg_has(&found->up, i) ? 1 : -1;
            count++;
        }
    }
    return count;
}

int bg_next_way(const bg_choice *choice, bg_port_block *block, bg_tried *tried,
                const bg_finding *found, int *mode)
{
    int last[BG_MOST_PORTS];
    if (block->count <= BG_ENUMERATED)
        return next_number(choice, block, mode);
    for (int k = 0; k < block->count; k++)
        last[k] = mode[block->ports[k]];
    was_tried(tried, block, mode, 1);
    if (++block->turns >= BG_BLOCK_TURNS * block->count
        || !turn_ports(block, found, block->count, mode))
        return 0;
    if (!was_tried(tried, block, mode, 0))
        return 1;
    for (int k = 0; k < block->count; k++)
        mode[block->ports[k]] = last[k];
    turn_ports(block, found, 1, mode);
    return !was_tried(tried, block, mode, 0);
}

/* The ports that a port touches, and those that they touch, and so on: taken from the rest. */
static int gather(int port, bg_set *touched, bg_set *rest, int ports, int *to)
{
    int count = 0;
    to[count++] = port;
    for (int k = 0; k < count; k++)
        for (int i = 0; i < ports; i++)
            if (bg_has(rest, i) && (bg_has(touched + to[k], i) || bg_has(touched + i, to[k]))) {
                const bg_set one = bg_only(i);
                *rest = bg_turned(*rest, &one);
                to[count++] = i;
            }
    for (int k = 1; k < count; k++) { /* in order */
        const int one = to[k];
        int at = k;
        for (; at > 0 && to[at - 1] > one; at--)
            to[at] = to[at - 1];
        to[at] = one;
    }
    return count;
}

int bg_partition(const bg_choice *choice, const int *mode, int count, int *ports,
                 bg_port_block *found, int *blocks)
{
    const bg_sight *const c = choice->sight;
    bg_set touched[BG_MOST_PORTS] = {{{0}}}, rest = choice->open;
    int together[BG_MOST_PORTS], sorted = 0;
    found[0] = (bg_port_block){.count = count, .ports = ports};
    *blocks = 1;
    if (count <= BG_FEW_OPEN)
        return BG_OK;
    for (int i = 0; i < c->ports; i++) /* as they are tried first, but for switches */
        together[i] = bg_has(&choice->open, i) ? 0 : bg_has(&choice->switches, i) ? 1 : mode[i];
    const int status = c->couple(c->self, together, touched);
    if (status)
        return status >= BG_MISSING ? status : BG_OK;
    for (*blocks = 0; sorted < count; ++*blocks) {
        const int port = bg_first_of(&rest);
        const bg_set first = bg_only(port);
        rest = bg_turned(rest, &first);
        found[*blocks] = (bg_port_block){.ports = ports + sorted};
        found[*blocks].count = gather(port, touched, &rest, c->ports, ports + sorted);
        sorted += found[*blocks].count;
    }
    return BG_OK;
}
