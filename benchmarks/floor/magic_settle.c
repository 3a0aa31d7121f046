/* What a multistep method begins with. */
#include "magic_steps.h"

#include <string.h>

static void push(magic_run *run, const magic_vector *at)
{
    const double *const z = magic_read(at);
    memmove(run->wheel[1], run->wheel[0], (HISTORY - 1) * sizeof *run->wheel);
    run->wheel[0][0] = z[T1];
    run->wheel[0][1] = z[T2];
    run->known++;
}

/* A step passes or reaches an instant that may be a sample's. */
static void pass(magic_run *run, double x, const magic_vector *z)
{
    push(run, z);
    if (fmod(x, SUB) == 0.0)
        magic_sample(run, x, z);
}

static void stop_there(magic_run *run)
{
    if (magic_breaks(run)) {
        run->known = 0;
        magic_renew(run);
        push(run, &run->z);
    }
}

/* Where a step from x is to end: after one instant or two, and not beyond what is needed. */
static double goal(const magic_run *run, double least)
{
    const double below = floor(run->x), needed = fmax(below + HISTORY - run->known, below + 1);
    const double target = ceil(fmax(needed, least) / SUB) * SUB;
    return fmin(fmin(target, below + 2), magic_stop(run));
}

static void short_step(magic_run *run, double least)
{
    const double below = floor(run->x), to = goal(run, least), length = to - run->x;
    double g0, r0, g1, r1;
    magic_step p;
    magic_vector between;
    magic_attempt(run, length * run->h, &p);
    magic_guard(&run->s, run->mode, run->demand, magic_read(&p.y), &g0, &r0);
    magic_guard(&run->s, run->mode, run->demand, magic_read(&p.z), &g1, &r1);
    const double share = magic_sure(g0, p.h * r0, g1, p.h * r1) ? 2.0 : magic_ends(run, &p, 0, 1);
    run->result->steps++;
    if (to > below + 1 && share * length >= below + 1 - run->x) {
        magic_fill(run, &p);
        magic_between(&p, (below + 1 - run->x) / length, &between);
        pass(run, below + 1, &between);
    }
    if (share <= 1) {
        magic_between(&p, share, &between);
        magic_turn(run, run->x + share * length, &between);
        return;
    }
    run->x = to;
    run->z = p.z;
    run->f = p.stage[DOP_STAGES];
    pass(run, to, &run->z);
    stop_there(run);
}

int magic_settle(magic_run *run, double least)
{
    magic_renew(run);
    if (run->known == 0 && floor(run->x) == run->x)
        push(run, &run->z);
    while (run->x < run->end
           && (run->known < HISTORY || fmod(run->x, SUB) != 0 || run->x < least)) {
        short_step(run, least);
        if (run->result->events > MANY)
            return -1;
    }
    return 0;
}
