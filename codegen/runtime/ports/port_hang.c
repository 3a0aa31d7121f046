/* Jumps of second order in steps: each is on the side where the step would end with its share in
 * between, as in an implicit step; where one share ends the step at the jump it takes that, and
 * rests there from the next step on. As codegen/stops/hanging.py. */
#include <math.h>
#include <string.h>

#include "model_internal.h"

/* How a port's effort moves its slip's rate. */
static double pull_of(const bg_model *m, int port)
{
    const double *const F = m->numbers.F + bg_friction_readings[port] * N;
    double sum = 0.0;
    for (int i = 0; i < N; i++)
        sum += F[i] * m->numbers.Q[i * M + bg_friction_inputs[port]];
    return sum;
}

void bg_bring(bg_model *m, double h, int *near)
{
    double told[BG_ROOM(BG_GUARDS)] = {0};
    memset(m->work.aim, 0, sizeof m->work.aim);
    if (!BG_HUNG)
        return;
    bg_guards(&m->now, told);
    for (int i = 0; i < K; i++) {
        double terms;
        if (!bg_hangs(bg_switches + i))
            continue;
        const double gap = told[bg_switches[i].guard], pull = pull_of(m, i);
        const double slip = bg_slip(m, &m->shot, i, &terms);
        const double free = bg_slip_rate(m, &m->shot, i, &terms)
            - pull * m->shot.u[bg_friction_inputs[i]];
        const double ahead = gap + h * (slip + h * free);
        near[i] = fabs(ahead) <= fmax(-pull, 0.0) * h * h;
        m->mode[i] = near[i] ? 0 : (pull < 0.0 ? ahead : gap) > 0.0 ? 1 : -1;
        m->work.aim[i] = -gap / h;
    }
}
