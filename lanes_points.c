/* Several points of one run at once, a lane each, for what looks at it from several sides. */
#include <string.h>

#include "lanes_steps.h"

/* The same in every lane. */
static void lane_spread(bg_lane *of, int count, int from)
{
    for (int i = 0; i < count; i++) {
        const double value = of[i][from];
        for (int l = 0; l < BG_LANES; l++)
            of[i][l] = value;
    }
}

/* The numbers and the mode of a run in every lane. */
static int make_points(bg_lane_run *one)
{
    bg_lanes_own *const own = &one->all->points.own;
    if (!bg_lanes_load_mode(own, 0, one->room->run))
        return 0;
    for (int i = 0; i < BG_LANE_CONSTANTS; i++)
        own->constants[i][0] = one->constants[i];
    lane_spread(own->constants, BG_LANE_CONSTANTS, 0);
    lane_spread(own->signs, K, 0);
    lane_spread(own->held, K * LANE_WIDE, 0);
    lane_spread(own->sides, BG_CORNERS, 0);
    return 1;
}

/* The time of a point and inputs there. */
static void put_time(bg_lane_run *one, int point, double t)
{
    bg_lanes_at *const at = &one->all->points.at;
    const bg_located *const c = one->room->run;
    double w[BG_ROOM(BG_EXTERNAL)], dw[BG_ROOM(BG_EXTERNAL)];
    bg_signals_at(c->signals, &c->run.span, t, w, dw);
    at->t[point] = t;
    for (int i = 0; i < BG_EXTERNAL; i++) {
        at->w[i][point] = w[i];
        at->dw[i][point] = dw[i];
    }
}

static void put_state(bg_lane_run *one, int point, const double *s)
{
    for (int k = 0; k < BG_SIZE; k++)
        one->all->points.s[k][point] = s[k];
}

int bg_lanes_set(bg_lane_run *one, int count, const double *times)
{
    if (count > BG_LANES || !make_points(one))
        return 0;
    for (int k = 0; k < BG_LANES; k++)
        put_time(one, k, times[k < count ? k : 0]);
    return 1;
}

int bg_lanes_see(bg_lane_run *one, int count, const double (*s)[BG_SIZE])
{
    bg_lanes_points *const points = &one->all->points;
    int fine = 1;
    for (int k = 0; k < BG_LANES; k++)
        put_state(one, k, s[k < count ? k : 0]);
    bg_lanes_look(&points->own, &points->at, points->s, points->shot);
    for (int k = 0; k < count; k++)
        for (int i = 0; i < BG_SIZE; i++)
            fine &= isfinite(points->shot[BG_AT_rate + i][k]) != 0;
    return fine;
}

static int triggers_of_points(void *self, int count, const double *times,
                              double (*values)[BG_WATCHED])
{
    bg_lane_run *const one = self;
    bg_lanes_points *const points = &one->all->points;
    double s[BG_LANES][BG_SIZE];
    int fine = 1;
    if (BG_CORNERS && !(one->room->run->model->now.sided > 0.0))
        return 0; /* laws as they are, over a corner */
    for (int k = 0; k < count && k < BG_LANES && fine; k++)
        fine = bg_solver_dense(one->room->run, times[k], s[k]) == BG_OK;
    if (!fine || !bg_lanes_set(one, count, times))
        return 0;
    (void)bg_lanes_see(one, count, (const double(*)[BG_SIZE])s);
    for (int k = 0; k < count; k++) {
        bg_lanes_triggers(&points->own, k, points->shot, values[k]);
        fine &= bg_finite(K, values[k]);
    }
    return fine;
}

static int rates_of_points(void *self, double t, int count, double (*s)[BG_SIZE],
                           double (*rate)[BG_SIZE])
{
    bg_lane_run *const one = self;
    bg_lanes_points *const points = &one->all->points;
    int fine = count <= BG_LANES && make_points(one);
    if (!fine)
        return 0;
    put_time(one, 0, t);
    lane_spread(&points->at.t, 1, 0);
    lane_spread(points->at.w, BG_EXTERNAL, 0);
    lane_spread(points->at.dw, BG_EXTERNAL, 0);
    for (int k = 0; k < BG_LANES; k++)
        put_state(one, k, s[k < count ? k : 0]);
    if (BG_CORNERS && !(one->room->run->model->now.sided > 0.0))
        bg_lanes_plain(&points->own, &points->at, points->s, points->rate);
    else
        bg_lanes_rates(&points->own, &points->at, points->s, points->rate);
    for (int k = 0; k < count; k++) {
        for (int i = 0; i < BG_SIZE; i++)
            rate[k][i] = points->rate[i][k];
        fine &= bg_finite(BG_SIZE, rate[k]);
    }
    return fine;
}

void bg_lanes_join(bg_lane_run *one)
{
    one->together = (bg_together){one, triggers_of_points, rates_of_points};
    one->room->run->together = &one->together;
}
