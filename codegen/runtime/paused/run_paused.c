/* Where a loop is, kept and taken up again. */
#include "run_paused.h"

#include <math.h>
#include <string.h>

void bg_keep(const bg_course *c, bg_kept *to)
{
    to->t = c->at.t;
    to->began = c->began;
    to->done = c->done;
    to->time = c->at.time;
    to->begun = c->started;
    to->decided = c->decided && !c->excused;
    memcpy(to->leapt, c->at.leapt, sizeof to->leapt);
    memcpy(to->mode, c->mode, sizeof to->mode);
    memcpy(to->touched, c->at.touched, sizeof to->touched);
    memcpy(to->lingers, c->at.lingers, sizeof to->lingers);
    to->rounds = c->rounds;
    to->crossings = c->crossings;
}

void bg_take_up(bg_course *c, const bg_kept *from, double end, double *s)
{
    bg_set_out(c, from->t, end, s, from->mode);
    c->began = from->began;
    c->done = from->done;
    c->at.time = from->time;
    c->started = from->begun;
    c->decided = from->decided;
    c->paused = from->begun && !from->decided;
    memcpy(c->at.leapt, from->leapt, sizeof from->leapt);
    memcpy(c->at.touched, from->touched, sizeof from->touched);
    memcpy(c->at.lingers, from->lingers, sizeof from->lingers);
    c->rounds = from->rounds;
    c->crossings = from->crossings;
}

void bg_carry(bg_carrier *c, double *values, int count)
{
    for (int i = 0; i < count; i++)
        if (c->back)
            values[i] = c->at[i];
        else
            c->at[i] = values[i];
    c->at += count;
}

static void carry_whole(bg_carrier *c, int *values, int count)
{
    for (int i = 0; i < count; i++)
        if (c->back)
            values[i] = (int)c->at[i];
        else
            c->at[i] = values[i];
    c->at += count;
}

void bg_carry_kept(bg_carrier *c, bg_kept *kept)
{
    bg_carry(c, &kept->t, 1);
    bg_carry(c, &kept->began, 1);
    bg_carry(c, &kept->done, 1);
    bg_carry(c, &kept->time, 1);
    carry_whole(c, &kept->begun, 1);
    carry_whole(c, &kept->decided, 1);
    carry_whole(c, &kept->rounds.next, 1);
    carry_whole(c, &kept->rounds.full, 1);
    bg_carry(c, kept->rounds.time, BG_STALLED);
    carry_whole(c, kept->mode, BG_MOST_PORTS);
    carry_whole(c, kept->touched, BG_MOST_PORTS);
    carry_whole(c, kept->lingers, BG_MOST_PORTS);
    bg_carry(c, kept->leapt, BG_MOST_PORTS);
    bg_carry(c, kept->crossings.last, BG_MOST_PORTS);
    carry_whole(c, kept->crossings.unseen, BG_MOST_PORTS);
    bg_carry(c, kept->crossings.speed[0], 2 * BG_MOST_PORTS);
}
