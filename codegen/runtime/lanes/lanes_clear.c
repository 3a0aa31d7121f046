/* Whether nothing happens between instants that are all that is known of a step. */
#include <math.h>
#include <string.h>

#include "lanes_steps.h"

enum { QUARTERS = 4, CLOSELY = 2 * QUARTERS + 1 };

/* What bends by less than so many times its least value between two instants stays above zero: a
 * parabola falls below both by an eighth of its second difference, a wave of five instants to a
 * period by a sixth; of many more by hardly more than an eighth. */
static const double CLEAR_BENDS = 2.0, CLEAR_CLOSE_BENDS = 4.0;

void bg_lanes_watched(const bg_lane_run *one, const bg_lanes_own *own, int lane,
                      const bg_lane *shot, double *values)
{
    double hung[2 * BG_ROOM(BG_CORNERS)];
    bg_lanes_triggers(own, lane, shot, values);
    for (int k = 0; k < 2 * BG_CORNERS; k++)
        hung[k] = shot[LANE_CORNERS + k][lane];
    bg_corners_away(&one->room->model->now, hung);
    for (int k = 0; k < BG_CORNERS; k++)
        values[K + k] = hung[k];
}

void bg_lanes_note(const bg_lane_run *one, const double *values)
{
    bg_located *const c = one->room->run;
    bg_note_pass(&c->watch.of, K, values);
    bg_note_pass(&c->corners.of, BG_CORNERS, values + K);
}

/* The largest slope's slope of parabolas through three points, two of which are k and k + 1. */
static double clear_bend(int count, const double *x, const double (*v)[LANE_WATCHED], int i, int k)
{
    double most = 0.0;
    for (int j = k > 0 ? k - 1 : 0; j <= k && j + 2 < count; j++) {
        const double one = (v[j + 1][i] - v[j][i]) / (x[j + 1] - x[j]);
        const double other = (v[j + 2][i] - v[j + 1][i]) / (x[j + 2] - x[j + 1]);
        const double bend = fabs(2.0 * (other - one) / (x[j + 2] - x[j]));
        most = bend <= most ? most : bend;
    }
    return most;
}

/* Whether nothing watched comes to zero between instants. */
static int clear_between(int count, const double *x, const double (*v)[LANE_WATCHED], double bends)
{
    for (int i = 0; i < K + BG_CORNERS; i++)
        for (int k = 0; k + 1 < count; k++) {
            const double wide = x[k + 1] - x[k], least = fmin(v[k][i], v[k + 1][i]);
            const int never = isinf(v[k][i]) && isinf(v[k + 1][i]) && least > 0.0;
            if (!never && !(bends * least > wide * wide * clear_bend(count, x, v, i, k)))
                return 0;
        }
    return 1;
}

int bg_lanes_is_clear(int count, const double *x, const double (*v)[LANE_WATCHED])
{
    return clear_between(count, x, v, CLEAR_BENDS);
}

/* The state at t by the polynomial with the values and slopes of four instants (Hermite). */
static void clear_state(const bg_lanes_known *known, double t, double *s)
{
    for (int k = 0; k < BG_SIZE; k++)
        s[k] = 0.0;
    for (int j = 0; j < LANE_AROUND; j++) {
        const double off = t - known->t[j];
        double share = 1.0, slope = 0.0;
        for (int i = 0; i < LANE_AROUND; i++)
            if (i != j) {
                share *= (t - known->t[i]) / (known->t[j] - known->t[i]);
                slope += 1.0 / (known->t[j] - known->t[i]);
            }
        share *= share;
        for (int k = 0; k < BG_SIZE; k++)
            s[k] += share
                * ((1.0 - 2.0 * off * slope) * known->y[j][k] + off * known->rate[j][k]);
    }
}

/* The ends and the quarters of two parts; how many of these are inside. */
static int clear_places(const double *ends, double *t, double *inner)
{
    int count = 0;
    for (int part = 0; part < 2; part++)
        for (int k = 0; k < QUARTERS; k++) {
            const double at = ends[part] + (ends[part + 1] - ends[part]) * k / QUARTERS;
            t[QUARTERS * part + k] = at;
            if (k > 0)
                inner[count++] = at;
        }
    t[CLOSELY - 1] = ends[2];
    return count;
}

int bg_lanes_is_clear_closely(bg_lane_run *one, const bg_lanes_known *known, int first,
                              const double (*ends)[LANE_WATCHED])
{
    const bg_lanes_points *const points = &one->all->points;
    double v[CLOSELY][LANE_WATCHED], t[CLOSELY], inner[CLOSELY], s[CLOSELY][BG_SIZE];
    const int count = clear_places(known->t + first, t, inner);
    for (int k = 0; k < count; k++)
        clear_state(known, inner[k], s[k]);
    if (!bg_lanes_set(one, count, inner) || !bg_lanes_see(one, count, (const double(*)[BG_SIZE])s))
        return 0;
    for (int k = 0, seen = 0; k < CLOSELY; k++)
        if (k % QUARTERS)
            bg_lanes_watched(one, &points->own, seen++, (const bg_lane *)points->shot, v[k]);
        else
            memcpy(v[k], ends[k / QUARTERS], sizeof v[k]);
    return clear_between(CLOSELY, t, (const double(*)[LANE_WATCHED])v, CLEAR_CLOSE_BENDS);
}
