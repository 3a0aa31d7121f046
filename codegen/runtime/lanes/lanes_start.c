/* A multistep method's first instants, all at once: states whose rates are those of the polynomial
 * through them (collocation), found by going through it again and again; the slope is exact. */
#include <math.h>
#include <string.h>

#include "lanes_steps.h"

enum { TERMS = 24, TURNS = 12, MOST_PARTS = 64,  };
static const double LONGEST = 1.2,    /* step times the fastest rate */
                    SHORTEST = 0.05,  /* below that explicit steps go over many samples */
                    BESIDE = 0.1,     /* of a step: no two instants are nearer than that */
                    SETTLED = 1e-3;   /* of the tolerance: by so much the last turn may change it */

/* `times`: where the run is, and the instants after it; `x`: in steps of length h from there on. */
typedef struct {
    bg_lane_run *one;
    double h, times[LANE_NODES], x[LANE_NODES], factor[LANE_NODES][LANE_NODES][LANE_NODES];
    double y[LANE_NODES][BG_SIZE], rest[LANE_NODES][BG_SIZE];
} beginning;

double bg_lanes_time(const batch_job *job, long place, long parts)
{
    const long sample = place / parts, part = place % parts;
    if (sample >= job->samples - 1)
        return part || sample >= job->samples ? INFINITY : job->times[job->samples - 1];
    return job->times[sample] + (job->times[sample + 1] - job->times[sample]) * part / parts;
}

/* Steps of a part of what lies between samples; the first instants from where the run is. Whether
 * there are any. */
static int plan(const bg_lanes *a, beginning *b, bg_lane_start *start)
{
    bg_lane_run *const one = b->one;
    const bg_located *const c = one->room->run;
    const double gap = a->exponential.gap, wide = gap * c->stretch.fastest, t = c->run.at.t;
    one->waits = LANE_NEVER;
    if (!(wide >= SHORTEST) || !(wide <= MOST_PARTS * LONGEST))
        return 0;
    start->parts = (long)fmax((double)one->parts, ceil(wide / LONGEST));
    b->h = gap / (double)start->parts;
    const long first = (long)ceil((t - a->job->times[0]) / b->h + BESIDE);
    start->place = first + LANE_PAST - 1;
    if (!(bg_lanes_time(a->job, start->place + LANE_PAIR, start->parts) <= c->stretch.stop))
        return 0;
    b->times[0] = t;
    for (int j = 0; j < LANE_PAST; j++)
        b->times[j + 1] = bg_lanes_time(a->job, first + j, start->parts);
    for (int j = 0; j < LANE_NODES; j++)
        b->x[j] = (b->times[j] - t) / b->h;
    one->waits = 1; /* a sample may be passed by an explicit step */
    return c->next >= a->job->samples || a->job->times[c->next] == t
        || a->job->times[c->next] >= b->times[1];
}

/* The state at an instant from that at the one before it, by its series. */
static void advance(const beginning *b, const double *slope, int i)
{
    const double length = b->x[i] - b->x[i - 1];
    double term[BG_SIZE], next[BG_SIZE], sum[BG_SIZE], power = b->h;
    memcpy(term, b->y[i - 1], sizeof term);
    memcpy(sum, term, sizeof sum);
    for (int l = 0; l < TERMS; l++) {
        for (int k = 0; k < BG_SIZE; k++) {
            next[k] = 0.0;
            for (int j = 0; j < BG_SIZE; j++)
                next[k] += b->h * slope[k * BG_SIZE + j] * term[j];
            for (int j = 0; j < LANE_NODES && l < LANE_NODES; j++)
                next[k] += power * b->factor[i - 1][l][j] * b->rest[j][k];
        }
        power *= length / (l + 1);
        for (int k = 0; k < BG_SIZE; k++) {
            term[k] = next[k] * length / (l + 1);
            sum[k] += term[k];
        }
    }
    memcpy((double *)b->y[i], sum, sizeof sum);
}

/* What rates at an instant are more than the slope's; by how much of the tolerance that is another
 * than before. */
static double renew(beginning *b, const bg_lanes *a, const double *slope, int i)
{
    const bg_lanes_exponential *const e = &a->exponential;
    double most = 0.0;
    for (int k = 0; k < BG_SIZE; k++) {
        double rest = a->points.shot[BG_AT_rate + k][i];
        for (int j = 0; j < BG_SIZE; j++)
            rest -= slope[k * BG_SIZE + j] * b->y[i][j];
        most = fmax(most, b->h * fabs(rest - b->rest[i][k]) / (e->atol + e->rtol * fabs(b->y[i][k])));
        b->rest[i][k] = rest;
    }
    return most;
}

/* Finds the states; whether they are found. */
static int settle(beginning *b, const bg_lanes *a, const double *slope)
{
    for (int i = 0; i < LANE_NODES; i++) {
        bg_derivatives(b->x[i], LANE_NODES, b->x, b->factor[i]);
        memcpy(b->y[i], b->one->room->run->s, sizeof b->y[i]);
    }
    if (!bg_lanes_set(b->one, LANE_NODES, b->times)
        || !bg_lanes_see(b->one, LANE_NODES, (const double(*)[BG_SIZE])b->y))
        return 0;
    for (int i = 0; i < LANE_NODES; i++)
        (void)renew(b, a, slope, i);
    for (int turn = 0; turn < TURNS; turn++) {
        double most = 0.0;
        for (int i = 1; i < LANE_NODES; i++)
            advance(b, slope, i);
        if (!bg_lanes_see(b->one, LANE_NODES, (const double(*)[BG_SIZE])b->y))
            return 0;
        for (int i = 0; i < LANE_NODES; i++)
            most = fmax(most, renew(b, a, slope, i));
        if (most < SETTLED)
            return 1;
    }
    return 0;
}

/* Whether the polynomial follows closely enough: by what the newest value is more than the others
 * tell, as a step's error. */
static int is_fine(const beginning *b, const bg_lanes *a, const bg_lane_weights *weights)
{
    const bg_lanes_exponential *const e = &a->exponential;
    double factor[LANE_NODES][LANE_NODES], more[BG_SIZE], sum = 0.0;
    bg_derivatives(b->x[LANE_PAST], LANE_PAST, b->x, factor);
    for (int k = 0; k < BG_SIZE; k++) {
        more[k] = b->rest[LANE_PAST][k];
        for (int j = 0; j < LANE_PAST; j++)
            more[k] -= factor[0][j] * b->rest[j][k];
    }
    for (int k = 0; k < BG_SIZE; k++) {
        double change = 0.0;
        for (int j = 0; j < BG_SIZE; j++)
            change += weights->correction[k * BG_SIZE + j] * more[j];
        const double part = change / (e->atol + e->rtol * fabs(b->y[LANE_PAST][k]));
        sum += part * part;
    }
    return sum < BG_SIZE;
}

/* Whether nothing can happen between the instants. */
static int is_plain(bg_lane_run *one)
{
    const bg_lanes_points *const points = &one->all->points;
    const bg_lane *const shot = (const bg_lane *)points->shot;
    bg_located *const c = one->room->run;
    const bg_falling watch = c->watch.of, corners = c->corners.of;
    for (int i = 1; i + 1 < LANE_NODES; i += 2)
        if (!bg_lanes_pass(one, &points->own, (bg_lane_sight){i, shot}, (bg_lane_sight){i + 1, shot})) {
            c->watch.of = watch;
            c->corners.of = corners;
            return 0;
        }
    return 1;
}

int bg_lanes_start(bg_lanes *a, bg_lane_run *one)
{
    bg_lane_start *const start = &a->start;
    bg_located *const c = one->room->run;
    beginning b = {.one = one};
    if (!plan(a, &b, start))
        return 0;
    one->waits = one->patience;
    if (bg_located_jacobian(c, c->run.at.t, c->s, start->slope) != BG_OK
        || !bg_lanes_weigh(start->slope, b.h, &start->weights) || !settle(&b, a, start->slope)
        || !is_fine(&b, a, &start->weights)) {
        bg_lanes_too_coarse(one);
        return 0;
    }
    if (!is_plain(one))
        return 0;
    for (int i = 0; i < LANE_PAST; i++)
        if (c->next < a->job->samples && a->job->times[c->next] == b.times[i])
            bg_lanes_keep(one, i, (const bg_lane *)a->points.at.w, (const bg_lane *)a->points.shot);
    for (int i = 0; i < LANE_PAST; i++) {
        memcpy(start->y[i], b.y[LANE_PAST - i], sizeof start->y[i]);
        memcpy(start->rest[i], b.rest[LANE_PAST - i], sizeof start->rest[i]);
    }
    for (int i = 0; i < LANE_ROWS; i++)
        start->shot[i] = a->points.shot[i][LANE_PAST];
    one->waits = 0;
    return 1;
}
