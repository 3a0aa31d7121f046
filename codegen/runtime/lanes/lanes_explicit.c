/* Explicit steps of all lanes: as located_explicit.c, each number in so many lanes. */
#include <string.h>

#include "lanes_steps.h"
#include "located_explicit_table.h"

/* Adds so many stages, each times its weight, to `sum`; four at a time keep a processor busy. */
static void add_stages(const bg_lanes_explicit *a, int count, const double *weights, bg_lane *sum)
{
    enum { AT_ONCE = 4 };
    const bg_lane *of[DOP_ALL + AT_ONCE];
    double weight[DOP_ALL + AT_ONCE] = {0};
    int used = 0;
    for (int j = 0; j < count; j++)
        if (weights[j] != 0.0) {
            weight[used] = weights[j];
            of[used++] = a->stage[j];
        }
    for (int j = used; j < used + AT_ONCE; j++)
        of[j] = a->stage[0]; /* times zero */
    for (int j = 0; j < used; j += AT_ONCE) {
        const bg_lane *const s0 = of[j], *const s1 = of[j + 1], *const s2 = of[j + 2];
        const bg_lane *const s3 = of[j + 3];
        const double w0 = weight[j], w1 = weight[j + 1], w2 = weight[j + 2], w3 = weight[j + 3];
        for (int k = 0; k < BG_SIZE; k++)
            for (int l = 0; l < BG_LANES; l++)
                sum[k][l] += w0 * s0[k][l] + w1 * s1[k][l] + (w2 * s2[k][l] + w3 * s3[k][l]);
    }
}

/* Where stage i of a step is asked for, and when. */
static void lane_point(bg_lanes_explicit *a, int i)
{
    bg_lane sum[BG_SIZE] = {{0}};
    add_stages(a, i, DOP_A[i], sum);
    for (int k = 0; k < BG_SIZE; k++)
        for (int l = 0; l < BG_LANES; l++)
            a->tried[k][l] = a->y_old[k][l] + a->h[l] * sum[k][l];
    for (int l = 0; l < BG_LANES; l++)
        a->of.at.t[l] = a->t_old[l] + DOP_C[i] * a->h[l];
    bg_lanes_inputs(&a->of);
}

/* Rates of lanes that have no numbers on this side of a corner become those of laws as they are. */
static void lane_mend(const bg_lanes_own *own, const bg_lanes_at *at, const bg_lane *s,
                      bg_lane *rate)
{
    bg_lane sum = {0}, plain[BG_SIZE];
    int fine = 1;
    for (int k = 0; k < BG_SIZE; k++)
        for (int l = 0; l < BG_LANES; l++)
            sum[l] += 0.0 * rate[k][l];
    for (int l = 0; l < BG_LANES; l++)
        fine &= sum[l] == 0.0; /* else one is no number */
    if (fine)
        return;
    bg_lanes_plain(own, at, s, plain);
    for (int k = 0; k < BG_SIZE; k++)
        for (int l = 0; l < BG_LANES; l++)
            rate[k][l] = sum[l] == 0.0 ? rate[k][l] : plain[k][l];
}

static void lane_stage(bg_lanes_explicit *a, int i)
{
    lane_point(a, i);
    bg_lanes_rates(&a->of.own, &a->of.at, a->tried, a->stage[i]);
    if (BG_CORNERS)
        lane_mend(&a->of.own, &a->of.at, a->tried, a->stage[i]);
}

/* The sums of squares that estimate errors of order 5 and 3, in what the tolerance allows. */
static void lane_estimate(bg_lanes_explicit *a)
{
    bg_lane e5[BG_SIZE] = {{0}}, e3[BG_SIZE] = {{0}};
    add_stages(a, DOP_STAGES + 1, E5, e5);
    add_stages(a, DOP_STAGES + 1, E3, e3);
    memset(a->fifth, 0, sizeof a->fifth);
    memset(a->third, 0, sizeof a->third);
    for (int k = 0; k < BG_SIZE; k++)
        for (int l = 0; l < BG_LANES; l++) {
            const double one = fabs(a->y_old[k][l]), other = fabs(a->tried[k][l]);
            const double allowed = 1.0 / (a->atol + a->rtol * (one > other ? one : other));
            a->fifth[l] += e5[k][l] * allowed * (e5[k][l] * allowed);
            a->third[l] += e3[k][l] * allowed * (e3[k][l] * allowed);
        }
}

void bg_lanes_attempt(bg_lanes_explicit *a)
{
    memcpy(a->stage[0], a->f, sizeof a->f);
    for (int i = 1; i < DOP_STAGES; i++)
        lane_stage(a, i);
    lane_point(a, DOP_STAGES);
    bg_lanes_look(&a->of.own, &a->of.at, a->tried, a->end);
    memcpy(a->stage[DOP_STAGES], a->end + BG_AT_rate, sizeof a->f);
    if (BG_CORNERS)
        lane_mend(&a->of.own, &a->of.at, a->tried, a->stage[DOP_STAGES]);
    memcpy(a->y, a->tried, sizeof a->y);
    lane_estimate(a);
}

void bg_lanes_dense(bg_lanes_explicit *a)
{
    for (int i = DOP_STAGES + 1; i < DOP_ALL; i++)
        lane_stage(a, i);
    for (int k = 0; k < BG_SIZE; k++)
        for (int l = 0; l < BG_LANES; l++) {
            const double change = a->y[k][l] - a->y_old[k][l], h = a->h[l];
            const double first = a->stage[0][k][l], last = a->stage[DOP_STAGES][k][l];
            a->interpolation[0][k][l] = change;
            a->interpolation[1][k][l] = h * first - change;
            a->interpolation[2][k][l] = 2 * change - h * (last + first);
        }
    for (int r = 0; r < 4; r++) {
        bg_lane sum[BG_SIZE] = {{0}};
        add_stages(a, DOP_ALL, D[r], sum);
        for (int k = 0; k < BG_SIZE; k++)
            for (int l = 0; l < BG_LANES; l++)
                a->interpolation[3 + r][k][l] = a->h[l] * sum[k][l];
    }
}

void bg_lanes_between(bg_lanes_explicit *a, bg_lane *s)
{
    bg_lane x;
    for (int l = 0; l < BG_LANES; l++)
        x[l] = (a->of.at.t[l] - a->t_old[l]) / a->h[l];
    for (int k = 0; k < BG_SIZE; k++) {
        bg_lane sum = {0};
        for (int i = 6; i >= 0; i--)
            for (int l = 0; l < BG_LANES; l++)
                sum[l] = (sum[l] + a->interpolation[i][k][l]) * (i % 2 ? 1 - x[l] : x[l]);
        for (int l = 0; l < BG_LANES; l++)
            s[k][l] = a->y_old[k][l] + sum[l];
    }
}
