/* Two exponential steps of all lanes: predicted, corrected once, looked at. */
#include <string.h>

#include "lanes_steps.h"

/* sum += matrix times of */
static void pair_add_product(const bg_lane (*matrix)[BG_SIZE], const bg_lane *of, bg_lane *sum)
{
    for (int i = 0; i < BG_SIZE; i++) {
        bg_lane row = {0};
        for (int j = 0; j < BG_SIZE; j++)
            for (int l = 0; l < BG_LANES; l++)
                row[l] += matrix[i][j][l] * of[j][l];
        for (int l = 0; l < BG_LANES; l++)
            sum[i][l] += row[l];
    }
}

/* What rates are more than the slope's. */
static void pair_rest_of(const bg_lanes_exponential *a, const bg_lane *rate, const bg_lane *y,
                    bg_lane *rest)
{
    bg_lane linear[BG_SIZE] = {{0}};
    pair_add_product((const bg_lane(*)[BG_SIZE])a->slope, y, linear);
    for (int i = 0; i < BG_SIZE; i++)
        for (int l = 0; l < BG_LANES; l++)
            rest[i][l] = rate[i][l] - linear[i][l];
}

/* The end of a step by what is known before it, and what the rest would be there. */
static void pair_predict(const bg_lanes_exponential *a, int n, bg_lane *y, bg_lane *rest)
{
    memset(y, 0, BG_SIZE * sizeof *y);
    memset(rest, 0, BG_SIZE * sizeof *rest);
    pair_add_product((const bg_lane(*)[BG_SIZE])a->E, (const bg_lane *)a->y[n + 1], y);
    for (int p = 0; p < LANE_PAST; p++) {
        const bg_lane *const known = (const bg_lane *)a->rest[n + 1 + p];
        pair_add_product((const bg_lane(*)[BG_SIZE])a->weight[p], known, y);
        for (int i = 0; i < BG_SIZE; i++)
            for (int l = 0; l < BG_LANES; l++)
                rest[i][l] += a->ahead[p] * known[i][l];
    }
}

/* Corrects `y` by what the rest is more than was expected, which tells the error. */
static void pair_correct(bg_lanes_exponential *a, int n, const bg_lane *more, bg_lane *y)
{
    bg_lane change[BG_SIZE] = {{0}}, sum = {0};
    pair_add_product((const bg_lane(*)[BG_SIZE])a->correction, more, change);
    for (int i = 0; i < BG_SIZE; i++)
        for (int l = 0; l < BG_LANES; l++) {
            const double one = fabs(a->y[n + 1][i][l]), other = fabs(y[i][l]);
            const double part =
                change[i][l] / (a->atol + a->rtol * (one > other ? one : other));
            sum[l] += part * part;
            y[i][l] += change[i][l];
        }
    memcpy(a->error[n], sum, sizeof sum);
}

/* The step to place n of the window. */
static void pair_step(bg_lanes_exponential *a, int n)
{
    bg_lane *const shot = a->shot[LANE_PAIR - n];
    bg_lane y[BG_SIZE], expected[BG_SIZE], rate[BG_SIZE], rest[BG_SIZE];
    pair_predict(a, n, y, expected);
    memcpy(a->of.at.t, a->time[n], sizeof a->of.at.t);
    bg_lanes_inputs(&a->of);
    bg_lanes_rates(&a->of.own, &a->of.at, (const bg_lane *)y, rate);
    pair_rest_of(a, (const bg_lane *)rate, (const bg_lane *)y, rest);
    for (int i = 0; i < BG_SIZE; i++)
        for (int l = 0; l < BG_LANES; l++)
            rest[i][l] -= expected[i][l];
    pair_correct(a, n, (const bg_lane *)rest, y);
    bg_lanes_look(&a->of.own, &a->of.at, (const bg_lane *)y, shot);
    memcpy(a->w[LANE_PAIR - n], a->of.at.w, sizeof a->of.at.w);
    memcpy(a->y[n], y, sizeof y);
    pair_rest_of(a, (const bg_lane *)(shot + BG_AT_rate), (const bg_lane *)y, a->rest[n]);
}

/* The largest sizes of states so far. */
static void pair_note_seen(bg_lanes_exponential *a)
{
    for (int i = 0; i < BG_SIZE; i++)
        for (int l = 0; l < BG_LANES; l++) {
            const double size = fabs(a->y[0][i][l]), seen = a->seen[i][l];
            a->seen[i][l] = size > seen ? size : seen;
        }
}

void bg_lanes_pair(bg_lanes_exponential *a)
{
    pair_note_seen(a);
    memmove(a->y[LANE_PAIR], a->y[0], LANE_PAST * sizeof *a->y);
    memmove(a->rest[LANE_PAIR], a->rest[0], LANE_PAST * sizeof *a->rest);
    memcpy(a->shot[0], a->shot[LANE_PAIR], sizeof *a->shot);
    memcpy(a->w[0], a->w[LANE_PAIR], sizeof *a->w);
    for (int n = LANE_PAIR - 1; n >= 0; n--)
        pair_step(a, n);
}
