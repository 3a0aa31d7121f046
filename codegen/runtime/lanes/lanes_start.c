/* A multistep method's first instants, all at once: states whose rates are those of the polynomial
 * through them (collocation), found by going through it again and again; the slope is exact. */
#include <math.h>
#include <string.h>

#include "lanes_steps.h"

enum { START_TERMS = 24, START_TURNS = 12, MOST_PARTS = 64 };
static const double LONGEST = 1.2,    /* step times the fastest rate */
                    SHORTEST = 0.4,   /* below that explicit steps go over many samples */
                    BESIDE = 0.1;     /* of a step: no two instants are nearer than that */

/* `times`: where the run is, and the instants after it; `x`: in steps of length h from there on;
 * `columns`: of the slope, times h. */
typedef struct {
    bg_lane_run *one;
    double h, times[LANE_NODES], x[LANE_NODES], factor[LANE_NODES][LANE_NODES][LANE_NODES];
    bg_lane_functions functions;
    double columns[BG_SIZE][LANE_ROW], y[LANE_NODES][LANE_ROW], rest[LANE_NODES][LANE_ROW];
    double watched[LANE_NODES][LANE_WATCHED];
} lane_beginning;

double bg_lanes_time(const bg_lanes *a, long place, long parts)
{
    const long sample = place / parts, part = place % parts;
    if (sample >= a->samples - 1)
        return part || sample >= a->samples ? INFINITY : a->times[a->samples - 1];
    return a->times[sample] + (a->times[sample + 1] - a->times[sample]) * part / parts;
}

long bg_lanes_parts(const bg_lanes *a, const bg_lane_run *one)
{
    const double wide = a->exponential.gap * one->room->run->stretch.fastest;
    return one->finer * (long)fmax(ceil(wide / LONGEST), 1.0);
}

/* Steps of a part of what lies between samples; the first instants from where the run is. Whether
 * there are any. */
static int start_plan(const bg_lanes *a, lane_beginning *b, bg_lane_start *start)
{
    bg_lane_run *const one = b->one;
    const bg_located *const c = one->room->run;
    const double gap = a->exponential.gap, wide = gap * c->stretch.fastest, t = c->run.at.t;
    one->waits = LANE_NEVER;
    if (!(wide >= SHORTEST) || !(wide <= MOST_PARTS * LONGEST))
        return 0;
    start->parts = bg_lanes_parts(a, one);
    b->h = gap / (double)start->parts;
    const long first = (long)ceil((t - a->times[0]) / b->h + BESIDE);
    start->place = first + LANE_PAST - 1;
    if (!(bg_lanes_time(a, start->place + LANE_PAIR, start->parts) <= c->stretch.stop))
        return 0;
    b->times[0] = t;
    for (int j = 0; j < LANE_PAST; j++)
        b->times[j + 1] = bg_lanes_time(a, first + j, start->parts);
    for (int j = 0; j < LANE_NODES; j++)
        b->x[j] = (b->times[j] - t) / b->h;
    one->waits = LANE_FEW_STEPS;
    for (int i = 0; i < K; i++)
        if (c->watch.of.before[i] <= c->watch.of.limit[i])
            return 0; /* it has just begun */
    one->waits = 1; /* a sample may be passed by an explicit step */
    return c->next >= a->samples || a->times[c->next] == t
        || a->times[c->next] >= b->times[1];
}

/* The state at the first instant after the run's, some way from it, by its series. */
static void start_first(lane_beginning *b)
{
    const double length = b->x[1];
    double term[LANE_ROW], sum[LANE_ROW], power = b->h;
    memcpy(term, b->y[0], sizeof term);
    memcpy(sum, term, sizeof sum);
    for (int l = 0; l < START_TERMS; l++) {
        double next[LANE_ROW] = {0};
        bg_lanes_add_product((const double(*)[LANE_ROW])b->columns, term, next);
        for (int j = 0; j < LANE_NODES && l < LANE_NODES; j++)
            for (int k = 0; k < LANE_ROW; k++)
                next[k] += power * b->factor[0][l][j] * b->rest[j][k];
        power *= length / (l + 1);
        for (int k = 0; k < LANE_ROW; k++) {
            term[k] = next[k] * length / (l + 1);
            sum[k] += term[k];
        }
    }
    memcpy(b->y[1], sum, sizeof sum);
}

/* The state at an instant a step after the one before. */
static void start_advance(lane_beginning *b, int i)
{
    double sum[LANE_ROW] = {0};
    bg_lanes_add_product((const double(*)[LANE_ROW])b->functions.of[0], b->y[i - 1], sum);
    for (int p = 0; p < LANE_NODES; p++) {
        double slope[LANE_ROW] = {0};
        for (int j = 0; j < LANE_NODES; j++)
            for (int k = 0; k < LANE_ROW; k++)
                slope[k] += b->h * b->factor[i - 1][p][j] * b->rest[j][k];
        bg_lanes_add_product((const double(*)[LANE_ROW])b->functions.of[p + 1], slope, sum);
    }
    memcpy(b->y[i], sum, sizeof sum);
}

/* What rates at an instant are more than the slope's; by how much of the tolerance that is another
 * than before. */
static double start_renew(lane_beginning *b, const bg_lanes *a, int i)
{
    const bg_lanes_exponential *const e = &a->exponential;
    double most = 0.0, linear[LANE_ROW] = {0};
    bg_lanes_add_product((const double(*)[LANE_ROW])b->columns, b->y[i], linear);
    for (int k = 0; k < BG_SIZE; k++) {
        const double rest = a->points.shot[BG_AT_rate + k][i] - linear[k] / b->h;
        const double size = e->atol + e->rtol * fabs(b->y[i][k]);
        most = fmax(most, b->h * fabs(rest - b->rest[i][k]) / size);
        b->rest[i][k] = rest;
    }
    return most;
}

/* Looks at all instants. */
static int start_see(lane_beginning *b)
{
    double s[LANE_NODES][BG_SIZE];
    for (int i = 0; i < LANE_NODES; i++)
        memcpy(s[i], b->y[i], sizeof s[i]);
    return bg_lanes_see(b->one, LANE_NODES, (const double(*)[BG_SIZE])s);
}

/* Finds the states; whether they are found. */
static int start_settle(lane_beginning *b, const bg_lanes *a, const double *slope)
{
    for (int k = 0; k < BG_SIZE * BG_SIZE; k++)
        b->columns[k % BG_SIZE][k / BG_SIZE] = b->h * slope[k];
    for (int i = 0; i < LANE_NODES; i++) {
        bg_derivatives(b->x[i], LANE_NODES, b->x, b->factor[i]);
        memcpy(b->y[i], b->one->room->run->s, sizeof(double) * BG_SIZE);
    }
    if (!bg_lanes_set(b->one, LANE_NODES, b->times) || !start_see(b))
        return 0;
    for (int i = 0; i < LANE_NODES; i++)
        (void)start_renew(b, a, i);
    for (int turn = 0; turn < START_TURNS; turn++) {
        double most = 0.0;
        start_first(b);
        for (int i = 2; i < LANE_NODES; i++)
            start_advance(b, i);
        if (!start_see(b))
            return 0;
        for (int i = 0; i < LANE_NODES; i++)
            most = fmax(most, start_renew(b, a, i));
        if (most < BG_SETTLED)
            return 1;
    }
    return 0;
}

/* Whether the polynomial follows closely enough: by what the newest value is more than the others
 * tell, as a step's error. */
static int start_is_fine(const lane_beginning *b, const bg_lanes *a, const bg_lane_weights *weights)
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

/* The four instants around two that follow the i-th. */
static void start_around(const lane_beginning *b, int i, const double *slope, bg_lanes_known *known)
{
    const int from = i > 0 ? i - 1 : 0;
    for (int j = 0; j < LANE_AROUND; j++) {
        known->t[j] = b->times[from + j];
        memcpy(known->y[j], b->y[from + j], sizeof known->y[j]);
        for (int k = 0; k < BG_SIZE; k++) {
            known->rate[j][k] = b->rest[from + j][k];
            for (int l = 0; l < BG_SIZE; l++)
                known->rate[j][k] += slope[k * BG_SIZE + l] * b->y[from + j][l];
        }
    }
}

/* Whether nothing can happen between the instants. */
static int start_is_clear(lane_beginning *b, bg_lanes_points *points, const double *slope)
{
    double (*const v)[LANE_WATCHED] = b->watched;
    int closely = 0;
    for (int i = 0; i < LANE_NODES; i++)
        bg_lanes_watched(b->one, &points->own, i, (const bg_lane *)points->shot, v[i]);
    for (int i = 0; i + 2 < LANE_NODES; i += 2) {
        const int from = i > 0 ? i - 1 : 0;
        bg_lanes_known known;
        if (bg_lanes_is_clear(i + 3 - from, b->x + from, (const double(*)[LANE_WATCHED])v + from))
            continue;
        start_around(b, i, slope, &known);
        closely = 1;
        if (!bg_lanes_is_clear_closely(b->one, &known, i - from,
                                       (const double(*)[LANE_WATCHED])v + i)) {
            b->one->after = b->times[i + 2];
            return 0;
        }
    }
    /* What the points showed is asked for again. */
    return !closely || (bg_lanes_set(b->one, LANE_NODES, b->times) && start_see(b));
}

/* The samples before the last instant. A status. */
static int start_keep(const lane_beginning *b, const bg_lanes *a)
{
    const bg_lanes_points *const of = &a->points;
    const bg_located *const c = b->one->room->run;
    int status = BG_OK;
    for (int i = 0; i < LANE_PAST && status == BG_OK; i++)
        if (c->next < a->samples && a->times[c->next] == b->times[i])
            status = bg_lanes_keep(b->one, i, (const bg_lane *)of->s, (const bg_lane *)of->at.w,
                                   (const bg_lane *)of->shot);
    return status;
}

int bg_lanes_start(bg_lanes *a, bg_lane_run *one)
{
    bg_lane_start *const start = &a->start;
    bg_located *const c = one->room->run;
    lane_beginning b = {.one = one};
    if (!start_plan(a, &b, start))
        return 0;
    if (bg_located_jacobian(c, c->run.at.t, c->s, start->slope) != BG_OK
        || !bg_lanes_functions(start->slope, b.h, &b.functions)
        || !start_settle(&b, a, start->slope)) {
        bg_lanes_too_coarse(one);
        return 0;
    }
    one->waits = 0;
    if (!start_is_clear(&b, &a->points, start->slope))
        return 0;
    bg_lanes_weigh(&b.functions, &start->weights);
    if (!start_is_fine(&b, a, &start->weights)) {
        bg_lanes_too_coarse(one);
        return 0;
    }
    if (start_keep(&b, a) != BG_OK)
        return 0;
    memcpy(one->was, b.watched + LANE_NODES - LANE_PAIR, sizeof one->was);
    bg_lanes_note(one, b.watched[LANE_PAST]);
    for (int i = 0; i < LANE_PAST; i++) {
        memcpy(start->y[i], b.y[LANE_PAST - i], sizeof start->y[i]);
        memcpy(start->rest[i], b.rest[LANE_PAST - i], sizeof start->rest[i]);
    }
    for (int i = 0; i < LANE_ROWS; i++)
        start->shot[i] = a->points.shot[i][LANE_PAST];
    return 1;
}
