/* Jumps of second order in steps: each is on the side where the step would end with its share in
 * between, as in an implicit step; where one share ends the step at the jump it takes that, and
 * rests there from the next step on. As codegen/stops/hanging.py. */
#include <math.h>
#include <string.h>

#include "model_internal.h"

void bg_hang(bg_model *m, double h, bg_boxed *b)
{
    double told[BG_ROOM(BG_GUARDS)] = {0}, far[BG_ROOM(BG_GUARDS)] = {0};
    memset(m->work.aim, 0, sizeof m->work.aim);
    if (!BG_HUNG)
        return;
    bg_guards(&m->now, told);
    bg_told_terms(m, far);
    for (int i = 0; i < K; i++) {
        double terms, moves;
        if (!bg_hangs(bg_switches + i))
            continue;
        const int guard = bg_switches[i].guard;
        const double slip = bg_slip(m, &m->shot, i, &terms);
        const double rate = bg_slip_rate(m, &m->shot, i, &moves);
        const double ahead = told[guard] / h + slip + h * rate;
        const double least = BG_STEP_ROUNDING * (far[guard] / h + terms + h * moves);
        const int rests = b->way[i] == 0 && fabs(ahead) <= least + BG_STEP_DRIFT * h * moves;
        b->slip[i] = rests ? 0.0 : BG_BRIEF * ahead;
        b->near[i] = BG_BRIEF * least;
        m->work.aim[i] = -told[guard] / h;
    }
}

void bg_hang_on(int port, bg_boxed *b)
{
    if (!bg_hangs(bg_switches + port) || b->way[port] == 0)
        return;
    b->least[port] = b->most[port] = b->given[port];
    b->slip[port] = b->way[port] * BG_HUGE;
}
