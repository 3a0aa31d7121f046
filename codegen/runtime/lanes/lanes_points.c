/* Several points of one run at once, a lane each, for what looks at it from several sides. */
#include <string.h>

#include "lanes.h"

void bg_lanes_triggers(const bg_lanes_own *own, int lane, const bg_lane *shot, double *values)
{
    for (int i = 0; i < K; i++) {
        const double slip = shot[BG_AT_y + bg_friction_readings[i]][lane];
        const double effort = shot[BG_AT_u + bg_friction_inputs[i]][lane];
        const double way = own->signs[i][lane];
        values[i] = way != 0.0 ? way * slip : shot[BG_AT_caps + i][lane] - fabs(effort);
    }
}

/* The same in every lane. */
static void lane_spread(bg_lane *of, int count, int from)
{
    for (int i = 0; i < count; i++) {
        const double value = of[i][from];
        for (int l = 0; l < BG_LANES; l++)
            of[i][l] = value;
    }
}

/* The numbers and the mode of a lane's run in every lane. */
static int make_points(bg_lanes *a, int lane)
{
    bg_lanes_own *const own = &a->points.own;
    const bg_located *const c = a->lane[lane].room->run;
    if (!bg_lanes_load_mode(own, 0, c))
        return 0;
    for (int i = 0; i < BG_LANE_CONSTANTS; i++)
        own->constants[i][0] = a->own.constants[i][lane];
    lane_spread(own->constants, BG_LANE_CONSTANTS, 0);
    lane_spread(own->signs, K, 0);
    lane_spread(own->held, K * LANE_WIDE, 0);
    lane_spread(own->sides, BG_CORNERS, 0);
    return 1;
}

/* The time of a point and inputs there. */
static void put_time(bg_lanes *a, int lane, int point, double t)
{
    bg_lanes_at *const at = &a->points.at;
    const bg_located *const c = a->lane[lane].room->run;
    double w[BG_ROOM(BG_EXTERNAL)], dw[BG_ROOM(BG_EXTERNAL)];
    bg_signals_at(c->signals, &c->run.span, t, w, dw);
    at->t[point] = t;
    for (int i = 0; i < BG_EXTERNAL; i++) {
        at->w[i][point] = w[i];
        at->dw[i][point] = dw[i];
    }
}

static void put_state(bg_lanes *a, int point, const double *s)
{
    for (int k = 0; k < BG_SIZE; k++)
        a->points.s[k][point] = s[k];
}

static int triggers_of_points(void *self, int count, const double *times,
                              double (*values)[BG_WATCHED])
{
    const bg_lane_run *const one = self;
    bg_lanes *const a = one->all;
    const int lane = (int)(one - a->lane);
    double s[BG_SIZE];
    int fine = count <= BG_LANES && make_points(a, lane);
    if (BG_CORNERS && !(one->room->run->model->now.sided > 0.0))
        return 0; /* laws as they are, over a corner */
    for (int k = 0; k < BG_LANES && fine; k++) {
        const double t = times[k < count ? k : 0];
        fine = bg_solver_dense(one->room->run, t, s) == BG_OK;
        put_time(a, lane, k, t);
        put_state(a, k, s);
    }
    if (!fine)
        return 0;
    bg_lanes_look(&a->points.own, &a->points.at, a->points.s, a->points.shot);
    for (int k = 0; k < count; k++) {
        bg_lanes_triggers(&a->points.own, k, a->points.shot, values[k]);
        fine &= bg_finite(K, values[k]);
    }
    return fine;
}

static int rates_of_points(void *self, double t, int count, double (*s)[BG_SIZE],
                           double (*rate)[BG_SIZE])
{
    const bg_lane_run *const one = self;
    bg_lanes *const a = one->all;
    bg_lane *const found = a->points.rate;
    const int lane = (int)(one - a->lane);
    int fine = count <= BG_LANES && make_points(a, lane);
    if (!fine)
        return 0;
    put_time(a, lane, 0, t);
    lane_spread(&a->points.at.t, 1, 0);
    lane_spread(a->points.at.w, BG_EXTERNAL, 0);
    lane_spread(a->points.at.dw, BG_EXTERNAL, 0);
    for (int k = 0; k < BG_LANES; k++)
        put_state(a, k, s[k < count ? k : 0]);
    if (BG_CORNERS && !(one->room->run->model->now.sided > 0.0))
        bg_lanes_plain(&a->points.own, &a->points.at, a->points.s, found);
    else
        bg_lanes_rates(&a->points.own, &a->points.at, a->points.s, found);
    for (int k = 0; k < count; k++) {
        for (int i = 0; i < BG_SIZE; i++)
            rate[k][i] = found[i][k];
        fine &= bg_finite(BG_SIZE, rate[k]);
    }
    return fine;
}

void bg_lanes_join(bg_lanes *a, int lane)
{
    bg_lane_run *const one = a->lane + lane;
    one->all = a;
    one->together = (bg_together){one, triggers_of_points, rates_of_points};
    one->room->run->together = &one->together;
}
