/* From a run to a lane, and what a lane shows of it. */
#include <string.h>

#include "lanes_steps.h"

/* How holding efforts follow from states, inputs and their rates: X x + U u + V u' = 0 solved. */
static void load_held(bg_lanes_own *own, int lane, const bg_hold *held)
{
    for (int r = 0; r < held->count; r++)
        for (int q = 0; q < held->count; q++) {
            bg_lane *const to = own->held + held->ports[r] * LANE_WIDE;
            const double part = -held->inverse[r * held->count + q];
            for (int j = 0; j < N; j++)
                to[j][lane] += part * held->X[q * N + j];
            for (int j = 0; j < M; j++)
                to[N + j][lane] += part * held->U[q * M + j];
            for (int j = 0; j < BG_OUTSIDE; j++)
                to[N + M + j][lane] += part * held->V[q * M + bg_outside_inputs[j]];
        }
}

/* Ports that hold may share a load, or inputs may rule whether they do: these runs go alone. */
static int can_hold(const bg_hold *held)
{
    return !held->share_count && !held->ruled;
}

int bg_lanes_load_mode(bg_lanes_own *own, int lane, const bg_located *c)
{
    bg_hold *held = NULL;
    int sticking = 0;
    for (int i = 0; i < K; i++) {
        own->signs[i][lane] = c->run.mode[i];
        sticking |= c->run.mode[i] == 0;
    }
    for (int i = 0; i < BG_CORNERS; i++)
        own->sides[i][lane] = c->model->now.side[i];
    for (int i = 0; i < K * LANE_WIDE; i++)
        own->held[i][lane] = 0.0;
    if (!sticking)
        return 1;
    if (bg_hold_of(c->model, c->run.mode, &held) != BG_OK || !can_hold(held))
        return 0;
    load_held(own, lane, held);
    return 1;
}

int bg_lanes_may(bg_lane_run *one)
{
    const bg_located *const c = one->room->run;
    bg_hold *held = NULL;
    int sticking = 0;
    if (c->stretch.method != BG_DOP853 || (BG_CORNERS && !(c->model->now.sided > 0.0)))
        return 0; /* over corners that it does not get past */
    for (int i = 0; i < K; i++)
        sticking |= c->run.mode[i] == 0;
    return !sticking || (bg_hold_of(c->model, c->run.mode, &held) == BG_OK && can_hold(held));
}

void bg_lanes_load(bg_lanes_group *group, int lane, bg_lane_run *one)
{
    group->run[lane] = one;
    one->seated = 1;
    one->reach = -1.0;
    for (int i = 0; i < BG_LANE_CONSTANTS; i++)
        group->own.constants[i][lane] = one->constants[i];
    (void)bg_lanes_load_mode(&group->own, lane, one->room->run);
}

void bg_lanes_triggers(const bg_lanes_own *own, int lane, const bg_lane *shot, double *values)
{
    for (int i = 0; i < K; i++) {
        const double slip = shot[BG_AT_y + bg_friction_readings[i]][lane];
        const double effort = shot[BG_AT_u + bg_friction_inputs[i]][lane];
        const double way = own->signs[i][lane];
        values[i] = way != 0.0 ? way * slip : shot[BG_AT_caps + i][lane] - fabs(effort);
    }
}

int bg_lanes_keep(bg_lane_run *one, int lane, const bg_lane *s, const bg_lane *w,
                  const bg_lane *shot)
{
    located_room *const room = one->room;
    const batch_job *const job = one->all->job;
    double state[BG_SIZE];
    if (!job) {
        for (int k = 0; k < BG_SIZE; k++)
            state[k] = s[k][lane];
        return bg_located_hand_over(room->run, state);
    }
    const int sample = room->run->next++;
    for (int k = 0; k < job->signals; k++) {
        const int place = job->signal[k];
        const double value = place < 0 ? w[-1 - place][lane] : shot[place][lane];
        room->values[k * job->samples + sample] = value;
    }
    return BG_OK;
}

bg_lane_steps bg_lanes_kind(const bg_lane_run *one)
{
    const bg_located *const c = one->room->run;
    const int even = one->all->exponential.gap > 0.0;
    const int asked = c->asked->method == BG_AUTO && !c->asked->smooth && even;
    const int waits = one->waits || c->run.at.t < one->after;
    return asked && !waits && BG_SIZE <= BG_LANE_FEW ? LANE_EXPONENTIAL : LANE_EXPLICIT;
}
