/* Corners of laws: which side of each a run is on, how they are watched, and what follows when one
 * is crossed. As codegen/corners/sides.py. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "located_internal.h"

enum {
    HUNG = BG_ROOM(BG_CORNERS),
    FIRST = 1, /* states to inputs .. */
    END = offsetof(bg_values, dw) / sizeof(double)
};

/* What corners hang on at t, s, then for each whether it counts; also in the model's instant. */
static int hung_at(bg_located *c, double t, const double *s, double *values)
{
    bg_values *const now = &c->model->now;
    if (BG_CORNERS_TOLD) {
        now->t = t;
        memcpy(now->x, s, sizeof(double) * N);
        memcpy(now->z, s + N, sizeof(double) * OWN);
        c->view.given(c->view.self, t, now->w, now->dw);
        for (int i = 0; i < BG_OUTSIDE; i++)
            now->u[bg_outside_inputs[i]] = now->w[i];
    } else {
        const int status = bg_view_look(&c->view, t, s, c->run.mode);
        if (status != BG_OK)
            return status;
    }
    bg_corners(now, values);
    return BG_OK;
}

/* Below these what corners hang on counts as zero: what moves it where all that it reads is off by
 * a tolerance. Of the latest instant, where it is `values`. */
static void find_limits(bg_located *c, const double *values, double *limits)
{
    double *const read = (double *)&c->model->now, moved[2 * HUNG];
    for (int k = 0; k < BG_CORNERS; k++)
        limits[k] = BG_TINY;
    for (int j = FIRST; j < END; j++) {
        const double kept = read[j];
        read[j] += copysign(c->asked->atol + c->asked->rtol * fabs(kept), kept);
        bg_corners(&c->model->now, moved);
        read[j] = kept;
        for (int k = 0; k < BG_CORNERS; k++) {
            const double change = fabs(moved[k] - values[k]);
            limits[k] += isfinite(change) ? change : 0.0;
        }
    }
}

/* Which way what is at zero goes, in a moment. */
static int look_ahead(bg_located *c, double moment, const double *values, double *ahead)
{
    double rate[BG_SIZE], s[BG_SIZE], moved[2 * HUNG];
    int status = bg_located_rate(c, c->run.at.t, c->s, rate);
    for (int i = 0; i < BG_SIZE; i++)
        s[i] = c->s[i] + moment * rate[i];
    if (status == BG_OK)
        status = hung_at(c, c->run.at.t + moment, s, moved);
    for (int k = 0; k < BG_CORNERS && status == BG_OK; k++)
        ahead[k] = moved[k] - values[k];
    return status;
}

static double time_now(const bg_located *c, double fastest)
{
    return bg_time_constant(fastest, c->run.at.t - c->run.began);
}

int bg_corners_begin(bg_located *c, double fastest)
{
    bg_values *const now = &c->model->now;
    double values[2 * HUNG], limits[HUNG], ahead[HUNG] = {0};
    int zero = 0;
    now->sided = 0.0;
    int status = hung_at(c, c->run.at.t, c->s, values);
    if (status == BG_OK)
        find_limits(c, values, limits);
    for (int k = 0; k < BG_CORNERS && status == BG_OK; k++)
        zero |= fabs(values[k]) <= limits[k];
    if (zero)
        status = look_ahead(c, bg_moment(time_now(c, fastest)), values, ahead);
    for (int k = 0; k < BG_CORNERS && status == BG_OK; k++) {
        const int near = fabs(values[k]) <= limits[k] && ahead[k] != 0.0;
        now->side[k] = (near ? ahead[k] > 0.0 : values[k] >= 0.0) ? 1.0 : -1.0;
    }
    now->sided = 1.0;
    return status;
}

/* On this side what each hangs on is positive; what does not count is far from zero, and what has
 * no value: that is beyond another corner, which comes before. */
void bg_corners_away(const bg_values *now, double *values)
{
    for (int k = 0; k < BG_CORNERS; k++) {
        const int counts = values[BG_CORNERS + k] > 0.0 && !isnan(values[k]);
        values[k] = counts ? now->side[k] * values[k] : INFINITY;
    }
}

int bg_corners_watch(bg_located *c, double fastest)
{
    bg_falling *const f = &c->corners.of;
    double values[2 * HUNG];
    const int status = hung_at(c, c->run.at.t, c->s, values);
    if (status != BG_OK)
        return status;
    f->blind = c->run.at.t + bg_moment(time_now(c, fastest));
    find_limits(c, values, f->limit);
    bg_corners_away(&c->model->now, values);
    memcpy(f->before, values, sizeof(double) * BG_CORNERS);
    memset(f->armed, 0, sizeof f->armed);
    return BG_OK;
}

static int away_at(void *located, double t, double *values)
{
    bg_located *const c = located;
    double s[BG_SIZE], hung[2 * HUNG];
    int status = bg_solver_dense(c, t, s);
    if (status == BG_OK)
        status = hung_at(c, t, s, hung);
    bg_corners_away(&c->model->now, hung);
    memcpy(values, hung, sizeof(double) * BG_CORNERS);
    return status;
}

int bg_corners_step(bg_located *c, double *time)
{
    const bg_triggers of = {c, away_at, BG_CORNERS, NULL};
    const double begin = c->solver.t_old, stop = c->solver.t;
    double middle[BG_WATCHED] = {0}, end[BG_WATCHED] = {0};
    int status = away_at(c, begin + 0.5 * (stop - begin), middle);
    if (status == BG_OK)
        status = away_at(c, stop, end);
    if (status != BG_OK)
        return status;
    if (bg_passes(&c->corners.of, BG_CORNERS, middle, end)) {
        bg_note_pass(&c->corners.of, BG_CORNERS, end);
        return BG_OK;
    }
    return bg_first_fall(&c->corners.of, &of, c->solver.t_old, c->solver.t, time,
                         c->corners.crossed);
}

int bg_corners_cross(bg_located *c)
{
    double *const side = c->model->now.side, values[2 * HUNG], limits[HUNG];
    const int *const crossed = c->corners.crossed;
    int wrong = 1;
    for (int k = 0; k < BG_CORNERS; k++)
        side[k] = crossed[k] ? -side[k] : side[k];
    for (int looks = 0; looks < BG_CORNERS && wrong; looks++) {
        const int status = hung_at(c, c->run.at.t, c->s, values);
        if (status != BG_OK)
            return status;
        find_limits(c, values, limits);
        bg_corners_away(&c->model->now, values);
        wrong = 0;
        for (int k = 0; k < BG_CORNERS; k++)
            if (!crossed[k] && values[k] < -limits[k]) {
                side[k] = -side[k];
                wrong = 1;
            }
    }
    return BG_OK;
}
