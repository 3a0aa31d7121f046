/* Stretches of one mode, cut where a law comes over a corner. As codegen/runs/cornered.py. */
#include <math.h>
#include <string.h>

#include "located_internal.h"

/* Tells of those that were crossed, where they are asked for. */
static int note_corners(bg_located *c)
{
    for (int k = 0; k < BG_CORNERS && c->asked->corners; k++)
        if (c->corners.crossed[k]
            && bg_append(&c->run.log, (bg_event){c->run.at.t, K + k, BG_CORNER, 0.0}))
            return BG_EVENTS;
    return BG_OK;
}

/* Where corners are crossed so often that the run goes nowhere: over them for a while. */
static int go_over(bg_located *c, double time, int *ended)
{
    const double stop = c->corners.stop;
    c->corners.over = fmax(2 * c->corners.over, time);
    c->corners.rounds.next = c->corners.rounds.full = 0;
    c->model->now.sided = 0.0;
    const double until = fmin(stop, c->run.at.t + c->corners.over);
    const int status = bg_located_stretch(c, until, 0.0, ended);
    if (status != BG_OK || *ended || c->run.at.t >= stop)
        return status;
    return bg_corners_begin(c, c->corners.fastest);
}

int bg_corners_set_off(bg_located *c, double stop)
{
    const int status = bg_located_fastest(c, c->run.at.t, c->s, &c->corners.fastest);
    c->corners.rounds.next = c->corners.rounds.full = 0;
    c->corners.over = 0.0;
    c->corners.stop = stop;
    return status == BG_OK ? bg_corners_begin(c, c->corners.fastest) : status;
}

int bg_corners_follow(bg_located *c, int *ended, double *first, int *more)
{
    int status = BG_OK;
    *more = 0;
    if (*ended == BG_AT_CORNER) {
        *ended = 0;
        *first = c->solver.h;
        status = note_corners(c);
        if (status == BG_OK)
            status = bg_corners_cross(c);
        const double time = bg_time_constant(c->corners.fastest, c->run.at.t - c->run.began);
        if (status == BG_OK && bg_stalls(&c->corners.rounds, c->run.at.t, time))
            status = go_over(c, time, ended);
        *more = status == BG_OK && !*ended && c->run.at.t < c->corners.stop;
    }
    if (!*more)
        c->model->now.sided = 0.0;
    return status;
}

int bg_corners_go(bg_located *c, double stop)
{
    double first = 0.0;
    int ended = 0, more = 1, status = bg_corners_set_off(c, stop);
    while (status == BG_OK && more) {
        status = bg_located_stretch(c, stop, first, &ended);
        if (status == BG_OK)
            status = bg_corners_follow(c, &ended, &first, &more);
    }
    c->model->now.sided = 0.0;
    return status;
}
