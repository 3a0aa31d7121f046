/* Which of two integrators a stretch goes by, told by its steps: runs/methods.py decides the same
 * way with the same numbers and says what they are. */
#include "located_internal.h"

void bg_turns_begin(bg_located *c)
{
    c->turns.count = 0;
    c->turns.begin = c->run.at.t;
    c->turns.patience = BG_PATIENCE;
}

/* Whether stability alone has held back explicit steps, many in a row. */
static int tired(bg_located *c, double fastest, double stop)
{
    const bg_solver *const s = &c->solver;
    const int held = (s->t - s->t_old) * fastest >= BG_HELD && s->error <= BG_EASED;
    c->turns.count = held ? c->turns.count + 1 : 0;
    return c->turns.count >= c->turns.patience && (stop - s->t) * fastest > BG_WORTH;
}

/* Whether implicit steps stand for few stable explicit ones. */
static int is_short(bg_located *c, double fastest)
{
    const double t = c->solver.t;
    c->turns.count++;
    if (c->turns.count == BG_LOT_IMPLICIT)
        c->turns.begin = t; /* they grow at first */
    if (c->turns.count < 2 * BG_LOT_IMPLICIT)
        return 0;
    const double mean = (t - c->turns.begin) / BG_LOT_IMPLICIT;
    c->turns.begin = t;
    c->turns.count = BG_LOT_IMPLICIT;
    return mean * fastest < BG_GAIN + BG_GAIN_SIZE * BG_SIZE;
}

int bg_turns_over(bg_located *c, double fastest, double stop)
{
    const int implicit = c->solver.method == BG_RADAU;
    if (!(implicit ? is_short(c, fastest) : tired(c, fastest, stop)))
        return 0;
    if (implicit && c->turns.patience < BG_PATIENCE * 1e6)
        c->turns.patience *= BG_LATER;
    c->turns.count = 0;
    return 1;
}
