/* What a choice of mode rests on, switches and friction. */
#ifndef BG_PORT_CHOOSING_H
#define BG_PORT_CHOOSING_H

#include "port_choose.h"

/* `s`: that of the instant, or what it is after an impact, which `blow` tells. `open`: the friction
 * ports that may stick; `switches`: those that may change over, which `barred` ones may not. `why`
 * there is no mode: as none could be looked at so far, or as those are not consistent. */
typedef struct {
    const bg_sight *sight;
    const bg_instant *at;
    double *s;
    const int *before;
    int why;
    bg_blow blow;
    bg_set open, switches, barred;
} bg_choice;

/* What is found of a mode: whether it holds, or else whether friction or which switches contradict
 * it; `turned`: which friction ports do, of which those that are held go `up` by what they give. */
typedef struct {
    int holds, rubbing;
    bg_set broken, turned, up;
} bg_finding;

/* Friction ports that touch one another, and the way that was tried last: by number, of those in
 * which so many stick and so many that were not touched change; of a large block, after how many
 * turns. */
typedef struct {
    int count, stick, change, number, turns;
    const int *ports;
} bg_port_block;

enum {
    BG_FEW_OPEN = 4,   /* so many ports are tried together whether or not they touch */
    BG_ENUMERATED = 8, /* of a block of so many ports all ways are tried; else ports turn */
    BG_BLOCK_TURNS = 20, /* so often for each port */
    BG_BLOCK_WAYS = BG_PORTS > BG_ENUMERATED ? BG_BLOCK_TURNS * BG_PORTS : 1
};

/* The ways of large blocks that have been tried. */
typedef struct {
    int count;
    struct {
        const int *block;
        bg_set held, back;
    } ways[BG_BLOCK_WAYS];
} bg_tried;

/* port_verdict.c: the ports of the latest look, with what counts as zero; of swings that hardly
 * shrink larger leaps count as unseen: there are as many as one is smaller. */
void bg_tell(const bg_choice *choice, const int *mode, bg_port *now, bg_ruling *ruling);

/* port_verdict.c: what contradicts a mode, of the ports asked; a status that ends the search. */
int bg_find(bg_choice *choice, const int *mode, const bg_set *asked, bg_finding *found);

/* port_block.c: puts the first way of a block in a mode; the next, after what was found of that: 0
 * if there is none. Those that stick most come first, then those that change least; in a large
 * block ports that contradict turn. */
void bg_begin_block(const bg_choice *choice, bg_port_block *block, int *mode);
int bg_next_way(const bg_choice *choice, bg_port_block *block, bg_tried *tried,
                const bg_finding *found, int *mode);

/* Sorts the ports that may stick by the blocks they are in, and tells how many blocks there are;
 * few ports are one. `mode`: what is not open, friction slipping. A status that ends the search. */
int bg_partition(const bg_choice *choice, const int *mode, int count, int *ports,
                 bg_port_block *found, int *blocks);

/* port_choose.c: the first consistent mode with the switches of `mode`, if one holds; else switches
 * that would have to change over. A status that ends the search. */
int bg_choose_rubbing(bg_choice *choice, int *mode, int *holds, bg_set *broken);

/* port_switch.c: the first consistent mode, at most one impact later, which goes to *blow; switches
 * that are barred stay as they are. */
int bg_choose_once(const bg_sight *sight, const bg_instant *at, const bg_set *barred, int *mode,
                   bg_blow *blow);

/* port_reset.c: of the transitions of each state machine that turn on the first alone does. */
void bg_take_first(const bg_switch *kinds, int ports, const int *before, int *mode);

/* port_reset.c: which resets are set off by what changed over and by stops that were hit, whether
 * any is; as a run `begins` those of transitions alone. And s with what these set, a status where
 * that is no number or one state is set twice. */
int bg_find_fired(const bg_reset *resets, int count, const bg_switch *kinds, const int *before,
                  const int *mode, const bg_set *hit, int begins, int *fired);
int bg_set_states(const bg_reset *resets, int count, const int *fired, const double *values,
                  double *s);

/* port_switch.c: the mode as bg_choose tells it, without resets; port_bounce.c: the same where
 * stops may be met. */
int bg_choose_mode(const bg_sight *sight, const bg_instant *at, int *mode);
int bg_choose_struck(const bg_sight *sight, const bg_instant *at, int *mode);

/* Stops that throw back what meets them, and how fast slips are to open after that. */
typedef struct {
    bg_set ports;
    double speed[BG_MOST_PORTS];
} bg_throw;

/* port_throw.c: the impact of stops that throw back what closes; what a push alone holds in the
 * mode takes part as what does not bounce, what else switches hold stays held. s after it goes to
 * sight->struck. None where no states move what closes. */
int bg_throw_back(const bg_sight *sight, const bg_instant *at, const int *mode,
                  const bg_throw *wanted, bg_blow *blow);

/* The same that stops these, all that is held in the mode staying held. */
int bg_bring_to_rest(const bg_sight *sight, const bg_instant *at, const int *mode,
                     const bg_throw *wanted, bg_blow *blow);

#endif
