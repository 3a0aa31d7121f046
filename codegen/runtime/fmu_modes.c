/* Which ports stick and which way the others slip: one consistent mode at one instant. */
#include <math.h>
#include <string.h>

#include "fmu_common.h"
#include "model_ruling.h"

enum { K = BG_FRICTION };
#define PORTS BG_ROOM(BG_FRICTION)
static const double HYSTERESIS = 10.0; /* in units of rounding */

/* An instance under choice, and why modes could not be evaluated as long as none could. */
typedef struct {
    fmu_instance *f;
    fmu_error failed;
    int sound;
} choice;

/* Everything a little later in a mode, by one midpoint step. */
static fmu_error later(fmu_instance *f, const int *mode, const bg_snapshot *now, bg_snapshot *then)
{
    const double t = f->at.time;
    double following = INFINITY;
    fmu_error failed;
    fmu_next_break(f, &following);
    const double ahead = fmin(BG_LOOK_AHEAD * FMU_SHORTEST, 0.5 * (following - t));
    for (int i = 0; i < BG_SIZE; i++)
        f->point[0][i] = f->at.s[i] + 0.5 * ahead * now->rate[i];
    failed = fmu_look(f, t + 0.5 * ahead, f->point[0], mode, then);
    for (int i = 0; i < BG_SIZE; i++)
        f->point[1][i] = f->at.s[i] + ahead * then->rate[i];
    return failed ? failed : fmu_look(f, t + ahead, f->point[1], mode, then);
}

static int look(void *self, const signed char *mode, int moved, bg_port *ports, bg_ruling *ruling)
{
    choice *const c = self;
    fmu_instance *const f = c->f;
    bg_snapshot *const now = &f->look[moved];
    fmu_scales size;
    int signs[PORTS] = {0};
    for (int i = 0; i < K; i++)
        signs[i] = mode[i];
    fmu_error failed = fmu_look(f, f->at.time, f->at.s, signs, &f->look[0]);
    if (!failed && moved)
        failed = later(f, signs, &f->look[0], now);
    if (failed) {
        c->failed = c->failed ? c->failed : failed;
        return BG_NO_MODE;
    }
    c->sound = 1;
    fmu_scale(f, now, &size);
    for (int i = 0; i < K; i++)
        ports[i] = (bg_port){
            now->y[bg_friction_readings[i]], now->u[bg_friction_inputs[i]], now->caps[i],
            fmu_slip_rate(f, now, i), size.slip[i], size.effort[i], size.acceleration[i],
        };
    bg_rule(&f->model, mode, ruling);
    return BG_OK;
}

/* What the instant is to each port: by the indicators of the mode that was. An importer may find an
 * event of a slip no better than to its own steps. */
static fmu_error note_touched(fmu_instance *f, signed char *touched)
{
    double indicators[BG_ROOM(FMU_INDICATORS)];
    fmu_error failed = NULL;
    memset(touched, BG_UNTOUCHED, PORTS);
    if (f->at.decided)
        failed = fmu_look(f, f->at.time, f->at.s, f->at.mode, &f->look[0]);
    if (failed || !f->at.decided)
        return NULL; /* a mode that can no longer be evaluated tells nothing */
    fmu_indicators_of(f, &f->look[0], indicators);
    for (int i = 0; i < K; i++)
        if (indicators[2 * i] <= 0 || indicators[2 * i + 1] <= 0)
            touched[i] = f->at.mode[i] ? BG_PASSED : BG_TOUCHED;
    return NULL;
}

/* What later decisions and the indicators measure by. */
static void note_sizes(fmu_instance *f)
{
    fmu_scales size;
    fmu_scale(f, &f->look[0], &size);
    for (int i = 0; i < K; i++) {
        f->at.rest[i] = HYSTERESIS * size.slip[i];
        f->at.margin[i] = HYSTERESIS * size.effort[i];
    }
}

/* The mode just after the instance's time; ports at rest, or that crossed it, stick if they can. */
fmu_error fmu_decide(fmu_instance *f)
{
    signed char mode[PORTS] = {0}, looked[PORTS] = {0}, touched[PORTS];
    choice own = {f, NULL, 0};
    const bg_chooser chooser = {K, touched, bg_beside, &own, look};
    bg_port ports[PORTS];
    fmu_error failed = K > 0 ? note_touched(f, touched) : NULL;
    if (K == 0 || failed)
        return failed;
    for (int i = 0; i < K; i++)
        looked[i] = mode[i] = (signed char)f->at.mode[i];
    int status = bg_evaluated(&chooser, 1, looked, ports);
    if (status == BG_OK) {
        fmu_note_peaks(f, &f->look[0]);
        note_sizes(f);
        status = bg_choose(&chooser, mode);
    }
    if (status != BG_OK)
        return !own.sound && own.failed ? own.failed
                                        : "no way of sticking and slipping is consistent";
    for (int i = 0; i < K; i++)
        f->at.mode[i] = mode[i];
    f->at.decided = 1;
    f->stale = 1;
    return NULL;
}
