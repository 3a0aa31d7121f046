/* A step in one mode by a linearly implicit method of order 4, for stiff laws: RODASP, L-stable
 * and stiffly accurate, with an embedded method of order 3 (G. Steinebach, Order-reduction of
 * ROW-methods for DAEs and method of lines applications, Preprint 1741, TH Darmstadt 1995; as in
 * E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, section IV.7). Each step
 * solves six linear systems with one matrix, whose slopes are differences: as many evaluations
 * as there are states, one for the slope in time, and six. */
#include <math.h>
#include <string.h>

#include "model_internal.h"

enum { ROS_STAGES = BG_STAGES };

static const double ROS_GAMMA = 0.25;
static const double ROS_WEIGHTS[ROS_STAGES][ROS_STAGES - 1] = {
    {0.0},
    {3.0},
    {1.831036793486759, 0.4955183967433795},
    {2.304376582692669, -0.05249275245743001, -1.176798761832782},
    {-7.170454962423024, -4.741636671481785, -16.31002631330971, -1.062004044111401},
    {-7.170454962423024, -4.741636671481785, -16.31002631330971, -1.062004044111401, 1.0},
};
static const double ROS_COUPLES[ROS_STAGES][ROS_STAGES - 1] = {
    {0.0},
    {-12.0},
    {-8.791795173947035, -2.207865586973518},
    {10.81793056857153, 6.780270611428266, 19.53485944642410},
    {34.19095006749676, 15.49671153725963, 54.74760875964130, 14.16005392148534},
    {34.62605830930532, 15.30084976114473, 56.99955578662667, 18.40807009793095,
     -5.714285714285717},
};
static const double ROS_ALONG[ROS_STAGES] = {0.0, 0.75, 0.21, 0.63, 1.0, 1.0};
static const double ROS_IN_TIME[ROS_STAGES] = {0.25, -0.5, -0.023504, -0.0362, 0.0, 0.0};

/* Inputs and their rates at a part of a step, by the parabola through three values. */
static void inputs_along(bg_model *m, const double *w, double part)
{
    double *const now = m->work.external[0], *const rates = m->work.external[1];
    const double first = (1 - part) * (1 - 2 * part), last = part * (2 * part - 1);
    for (int i = 0; i < BG_EXTERNAL; i++) {
        const double begin = m->work.rates[0][i];
        now[i] = first * w[i] + 4 * part * (1 - part) * w[BG_EXTERNAL + i]
            + last * w[2 * BG_EXTERNAL + i];
        rates[i] = begin + part * (m->work.rates[2][i] - begin);
    }
}

/* The rates at m->work.point, a part of the step on. */
static int stage_rates(bg_model *m, double t, double h, double part, const double *w, int checked)
{
    inputs_along(m, w, part);
    return bg_evaluate(m, t + part * h, m->work.point, m->work.external[0], m->work.external[1],
                       m->mode, checked, &m->shot);
}

/* How rates change with one state, by a difference to whichever side they have values. */
static int find_column(bg_model *m, double t, double h, const double *s, const double *w, int j)
{
    bg_work *const work = &m->work;
    double step = BG_DIFFERENCE * work->reach[j];
    int status = BG_NOT_FINITE;
    memcpy(work->point, s, sizeof(double) * BG_SIZE);
    for (int tries = 0; tries < 2 && status != BG_OK; tries++, step = -step) {
        work->point[j] = s[j] + step;
        status = stage_rates(m, t, h, 0.0, w, 0);
        for (int i = 0; i < ALL && status == BG_OK; i++)
            work->implicit[i * BG_SIZE + j] =
                (work->stage[0][i] - m->shot.rate[i]) / (work->point[j] - s[j]);
    }
    return status;
}

/* The matrix 1/(gamma h) - J in factors, and the slope in time, which goes to work->next. */
static int find_matrix(bg_model *m, double t, double h, const double *s, const double *w)
{
    bg_work *const work = &m->work;
    const double later = t + BG_PART_IN_TIME * h;
    memset(work->implicit, 0, sizeof work->implicit);
    int status = BG_OK;
    for (int j = 0; j < ALL && status == BG_OK; j++)
        status = find_column(m, t, h, s, w, j);
    if (status == BG_OK) {
        memcpy(work->point, s, sizeof(double) * BG_SIZE);
        status = stage_rates(m, t, h, (later - t) / h, w, 0);
    }
    for (int i = 0; i < BG_SIZE; i++) {
        work->implicit[i * BG_SIZE + i] += 1 / (ROS_GAMMA * h);
        work->next[i] = (m->shot.rate[i] - work->stage[0][i]) / (later - t);
    }
    if (status == BG_OK && !bg_finite(BG_SIZE * BG_SIZE, work->implicit))
        return BG_NOT_FINITE;
    if (status == BG_OK && !bg_factor(BG_SIZE, work->implicit, work->implicit_pivots))
        return BG_SINGULAR;
    return status;
}

/* One stage: its argument in work->point, what it solves for in work->stage. */
static int find_stage(bg_model *m, double t, double h, const double *s, const double *w, int k)
{
    bg_work *const work = &m->work;
    double sum[BG_SIZE] = {0};
    memcpy(work->point, s, sizeof(double) * BG_SIZE);
    for (int j = 0; j < k; j++) {
        const double couple = ROS_COUPLES[k][j] / h;
        for (int i = 0; i < BG_SIZE; i++) {
            work->point[i] += ROS_WEIGHTS[k][j] * work->stage[j][i];
            sum[i] += couple * work->stage[j][i];
        }
    }
    const int status = stage_rates(m, t, h, ROS_ALONG[k], w, 1);
    for (int i = 0; i < BG_SIZE; i++)
        work->stage[k][i] = m->shot.rate[i] + sum[i] + ROS_IN_TIME[k] * h * work->next[i];
    bg_solve(BG_SIZE, work->implicit, work->implicit_pivots, 1, work->stage[k]);
    return status;
}

/* Whether the error of a step is beyond its part of the range of a state. */
static int is_inaccurate(bg_model *m, const double *s, const double *error)
{
    const bg_work *const work = &m->work;
    double range[BG_SIZE], square = 0.0;
    for (int i = 0; i < ALL; i++) {
        range[i] = fmax(m->seen[i], fabs(s[i]));
        square += range[i] * range[i] * work->weight[i] * work->weight[i];
    }
    for (int i = 0; i < ALL; i++) {
        range[i] += (BG_REACH_PART * sqrt(square) + BG_REACH_FLOOR) / work->weight[i];
        if (!(fabs(error[i]) <= BG_RANGE_PART * range[i]))
            return 1;
    }
    return 0;
}

int bg_rosenbrock(bg_model *m, double t, double h, double *s, const double *w)
{
    bg_work *const work = &m->work;
    bg_have_seen(m, s);
    memcpy(work->point, s, sizeof(double) * BG_SIZE);
    int status = stage_rates(m, t, h, 0.0, w, 1);
    if (status != BG_OK)
        return status;
    bg_note_given(m, 0.5, 1);
    memcpy(work->stage[0], m->shot.rate, sizeof work->stage[0]);
    bg_weigh(m, h);
    bg_reach(m, h, s);
    status = find_matrix(m, t, h, s, w);
    for (int k = 0; k < ROS_STAGES && status == BG_OK; k++)
        status = find_stage(m, t, h, s, w, k);
    for (int i = 0; i < BG_SIZE; i++)
        work->point[i] += work->stage[ROS_STAGES - 1][i];
    if (status != BG_OK || !bg_finite(BG_SIZE, work->point))
        return status != BG_OK ? status : BG_NOT_FINITE;
    memcpy(s, work->point, sizeof(double) * BG_SIZE);
    return is_inaccurate(m, s, work->stage[ROS_STAGES - 1]) ? BG_INACCURATE : BG_OK;
}
