/* Explicit steps of all lanes: as located_explicit.c, each number in so many lanes. */
#include <string.h>

#include "lanes.h"
#include "located_explicit_table.h"

/* External inputs and their rates at the lanes' times. */
static void lane_inputs(bg_lanes *a)
{
    bg_lane x;
    for (int l = 0; l < BG_LANES; l++)
        x[l] = a->at.t[l] - a->origin[l];
    for (int i = 0; i < BG_EXTERNAL; i++) {
        bg_lane p = {0}, d = {0};
        for (int k = a->terms - 1; k >= 0; k--)
            for (int l = 0; l < BG_LANES; l++) {
                d[l] = d[l] * x[l] + p[l];
                p[l] = p[l] * x[l] + a->series[i][k][l];
            }
        memcpy(a->at.w[i], p, sizeof p);
        memcpy(a->at.dw[i], d, sizeof d);
    }
}

void bg_lanes_correct(const bg_lanes_own *own, const bg_lanes_at *at, bg_lane *rate)
{
    for (int k = 0; k < K; k++) {
        bg_lane drift = {0};
        for (int j = 0; j < N; j++)
            for (int l = 0; l < BG_LANES; l++)
                drift[l] += own->slip_x[k * N + j][l] * rate[j][l];
        for (int j = 0; j < BG_OUTSIDE; j++)
            for (int l = 0; l < BG_LANES; l++)
                drift[l] += own->fixed[k * BG_OUTSIDE + j][l] * at->dw[j][l];
        for (int i = 0; i < N; i++)
            for (int l = 0; l < BG_LANES; l++)
                rate[i][l] += own->take[k * N + i][l] * drift[l];
    }
}

/* Where stage i of a step is asked for, and when. */
static void lane_point(bg_lanes *a, int i)
{
    for (int k = 0; k < BG_SIZE; k++) {
        bg_lane sum = {0};
        for (int j = 0; j < i; j++) {
            const double weight = DOP_A[i][j];
            for (int l = 0; l < BG_LANES; l++)
                sum[l] += weight * a->stage[j][k][l];
        }
        for (int l = 0; l < BG_LANES; l++)
            a->tried[k][l] = a->y_old[k][l] + a->h[l] * sum[l];
    }
    for (int l = 0; l < BG_LANES; l++)
        a->at.t[l] = a->t_old[l] + DOP_C[i] * a->h[l];
    lane_inputs(a);
}

static void lane_stage(bg_lanes *a, int i)
{
    lane_point(a, i);
    bg_lanes_rates(&a->own, &a->at, a->tried, a->stage[i]);
    bg_lanes_correct(&a->own, &a->at, a->stage[i]);
}

void bg_lanes_shoot(bg_lanes *a, const bg_lane *s, bg_lane *shot)
{
    lane_inputs(a);
    bg_lanes_look(&a->own, &a->at, s, shot);
    bg_lanes_correct(&a->own, &a->at, shot + BG_AT_rate);
}

/* The sums of squares that estimate errors of order 5 and 3, in what the tolerance allows. */
static void lane_estimate(bg_lanes *a)
{
    memset(a->fifth, 0, sizeof a->fifth);
    memset(a->third, 0, sizeof a->third);
    for (int k = 0; k < BG_SIZE; k++) {
        bg_lane e5 = {0}, e3 = {0};
        for (int i = 0; i <= DOP_STAGES; i++)
            for (int l = 0; l < BG_LANES; l++) {
                e5[l] += E5[i] * a->stage[i][k][l];
                e3[l] += E3[i] * a->stage[i][k][l];
            }
        for (int l = 0; l < BG_LANES; l++) {
            const double one = fabs(a->y_old[k][l]), other = fabs(a->tried[k][l]);
            const double scale = a->atol + a->rtol * (one > other ? one : other);
            a->fifth[l] += e5[l] / scale * (e5[l] / scale);
            a->third[l] += e3[l] / scale * (e3[l] / scale);
        }
    }
}

void bg_lanes_attempt(bg_lanes *a)
{
    memcpy(a->stage[0], a->f, sizeof a->f);
    for (int i = 1; i < DOP_STAGES; i++)
        lane_stage(a, i);
    lane_point(a, DOP_STAGES);
    bg_lanes_shoot(a, a->tried, a->end);
    memcpy(a->stage[DOP_STAGES], a->end + BG_AT_rate, sizeof a->f);
    memcpy(a->y, a->tried, sizeof a->y);
    lane_estimate(a);
}

void bg_lanes_dense(bg_lanes *a)
{
    for (int i = DOP_STAGES + 1; i < DOP_ALL; i++)
        lane_stage(a, i);
    for (int k = 0; k < BG_SIZE; k++) {
        for (int l = 0; l < BG_LANES; l++) {
            const double change = a->y[k][l] - a->y_old[k][l], h = a->h[l];
            const double first = a->stage[0][k][l], last = a->stage[DOP_STAGES][k][l];
            a->interpolation[0][k][l] = change;
            a->interpolation[1][k][l] = h * first - change;
            a->interpolation[2][k][l] = 2 * change - h * (last + first);
        }
        for (int r = 0; r < 4; r++) {
            bg_lane sum = {0};
            for (int i = 0; i < DOP_ALL; i++)
                for (int l = 0; l < BG_LANES; l++)
                    sum[l] += D[r][i] * a->stage[i][k][l];
            for (int l = 0; l < BG_LANES; l++)
                a->interpolation[3 + r][k][l] = a->h[l] * sum[l];
        }
    }
}

void bg_lanes_between(bg_lanes *a, bg_lane *s)
{
    bg_lane x;
    for (int l = 0; l < BG_LANES; l++)
        x[l] = (a->at.t[l] - a->t_old[l]) / a->h[l];
    for (int k = 0; k < BG_SIZE; k++) {
        bg_lane sum = {0};
        for (int i = 6; i >= 0; i--)
            for (int l = 0; l < BG_LANES; l++)
                sum[l] = (sum[l] + a->interpolation[i][k][l]) * (i % 2 ? 1 - x[l] : x[l]);
        for (int l = 0; l < BG_LANES; l++)
            s[k][l] = a->y_old[k][l] + sum[l];
    }
}
