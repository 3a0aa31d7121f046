/* Events of model exchange: indicators that are positive while a mode holds, and what an event does. */
#include <math.h>
#include <string.h>

#include "fmu_common.h"

/* How far ports that stick are from leaving what inputs rule of their slips at zero. */
static void keep_at_rest(fmu_instance *f, const bg_snapshot *now, double *values)
{
    bg_hold *held = NULL;
    int sticking = 0;
    for (int i = 0; i < K; i++)
        sticking |= f->at.mode[i] == 0;
    if (!sticking || bg_hold_of(&f->model, f->at.mode, &held) != BG_OK || held->ruled == 0)
        return;
    for (int i = 0; i < K; i++) {
        const double most = now->caps[i] + f->at.margin[i];
        const double rest = f->at.mode[i] ? INFINITY : most * bg_room(held, i, now, f->at.rest);
        for (int k = 2 * i; k < 2 * i + 2; k++)
            values[k] = fmin(values[k], rest);
    }
}

/* What keeps switches in their mode. */
static void keep_switches(fmu_instance *f, const bg_snapshot *now, double *values)
{
    bg_port ports[BG_ROOM(K)] = {{0}};
    for (int i = 0; i < K; i++) {
        ports[i].slip = now->y[bg_friction_readings[i]];
        ports[i].effort = now->u[bg_friction_inputs[i]];
    }
    bg_view_keep(&f->located.view, f->at.mode, ports);
    for (int i = 0; i < K; i++)
        if (bg_hangs(bg_switches + i) && f->at.mode[i])
            values[2 * i] = f->at.mode[i] * ports[i].gap + f->at.margin[i];
        else if (bg_switches[i].kind != BG_RUBS) {
            const int apart = bg_is_apart(bg_switches + i, f->at.mode[i]);
            values[2 * i] = (apart ? ports[i].gap : ports[i].stay) + f->at.margin[i];
            values[2 * i + 1] = 1.0;
        }
}

/* Two for each friction port: its slip in its direction; margins to breakaway where it sticks. Two
 * for each switch, too: what keeps it, of a stop that is apart its gap, and none. Then one for each
 * expression at whose zero a law switches. A little below zero still counts as holding. */
void fmu_indicators_of(fmu_instance *f, const bg_snapshot *now, double *values)
{
    for (int i = 0; i < K; i++) {
        const int mode = f->at.mode[i];
        const double effort = now->u[bg_friction_inputs[i]];
        if (mode) {
            values[2 * i] = mode * now->y[bg_friction_readings[i]] + f->at.rest[i];
            values[2 * i + 1] = 1.0;
        } else {
            values[2 * i] = now->caps[i] - effort + f->at.margin[i];
            values[2 * i + 1] = now->caps[i] + effort + f->at.margin[i];
        }
    }
    keep_at_rest(f, now, values);
    if (BG_SWITCHES || BG_HUNG)
        keep_switches(f, now, values);
    for (int k = 0; k < FMU_SWITCHES; k++)
        values[2 * K + k] = f->at.side[k] * f->switches[k] + f->at.switch_rest[k];
}

fmu_error fmu_indicators(fmu_instance *f, double *values)
{
    const fmu_error failed = fmu_refresh(f);
    if (!failed)
        fmu_indicators_of(f, &f->located.view.shot, values);
    return failed;
}

/* The sides on which laws are, and how far beyond a change counts. */
static void note_sides(fmu_instance *f)
{
    for (int k = 0; k < FMU_SWITCHES; k++) {
        const double value = f->switches[k];
        double *const peak = &f->at.switch_peak[k];
        *peak = fmax(*peak, fabs(value));
        if (f->at.side[k] == 0 || f->at.side[k] * value + f->at.switch_rest[k] <= 0)
            f->at.side[k] = value >= 0 ? 1 : -1;
        f->at.switch_rest[k] = BG_SWITCH_PART * *peak + BG_SWITCH_FLOOR;
    }
}

/* Takes what slip is left at sticking ports from the states, along A^-1 F^T. */
static fmu_error remove_slips(fmu_instance *f)
{
    int sticking = 0;
    fmu_error failed = fmu_refresh(f);
    for (int i = 0; i < K; i++)
        sticking |= f->at.mode[i] == 0;
    if (failed || !sticking)
        return failed;
    memcpy(f->point, f->at.s, sizeof f->at.s);
    const int status = bg_remove_slips(&f->model, f->at.mode, &f->located.view.shot, f->at.s);
    if (memcmp(f->point, f->at.s, sizeof f->at.s) != 0)
        f->stale = 1;
    return fmu_message(f, status);
}

/* Whether a jump of second order has come to rest: what was left of its leap is gone then, and what
 * goes with it may rest, too. */
static int comes_to_rest(const fmu_instance *f, const int *before)
{
    int any = 0;
    for (int i = 0; i < K; i++)
        any |= bg_hangs(bg_switches + i) && before[i] && f->at.mode[i] == 0;
    return any;
}

/* The mode just after the instance's time, and slips that stick at rest. */
static fmu_error settle_ports(fmu_instance *f)
{
    int mode[BG_ROOM(K)];
    fmu_error failed;
    do {
        memcpy(mode, f->at.mode, sizeof mode);
        failed = fmu_decide(f);
        if (!failed)
            failed = remove_slips(f);
    } while (!failed && comes_to_rest(f, mode));
    return failed;
}

/* Everything just after the instance's time, first what ports do, then what tasks set; whether that,
 * an impact, or what is held, moved the states. */
static fmu_error settle_event(fmu_instance *f, int *states_changed)
{
    double before[BG_SIZE];
    int due[BG_ROOM(BG_CLOCKS)] = {0};
    fmu_error failed;
    memcpy(before, f->at.s, sizeof before);
    failed = BG_DELAYS && f->at.exchange ? fmu_read_late(f) : NULL;
    fmu_pass(f, f->at.time);
    if (!failed)
        failed = fmu_apply(f);
    bg_have_seen(&f->model, f->at.s);
    memcpy(f->at.seen, f->model.seen, sizeof f->at.seen);
    const int any = fmu_due(f, due);
    if (!failed)
        failed = settle_ports(f);
    if (!failed && any)
        failed = fmu_set_by_tasks(f, due);
    if (!failed && any)
        failed = settle_ports(f);
    if (!failed)
        failed = fmu_refresh(f);
    *states_changed = memcmp(before, f->at.s, sizeof before) != 0;
    if (!failed && BG_DELAYS && f->at.exchange)
        failed = fmu_go_on_late(f, 1);
    if (failed)
        return failed;
    note_sides(f);
    fmu_note_stays(f);
    return NULL;
}

/* The end of initialization: the vector, the mode, and slips that stick at rest. */
fmu_error fmu_initialize(fmu_instance *f)
{
    int moved = 0;
    fmu_error failed;
    if (BG_DELAYS)
        fmu_begin_late(f);
    fmu_pass(f, f->at.time);
    failed = fmu_refresh(f);
    if (failed)
        return failed;
    f->at.phase = f->at.exchange ? FMU_EVENT : FMU_STEPPING;
    memcpy(f->model.mode, f->at.mode, sizeof f->model.mode);
    return settle_event(f, &moved);
}

/* An event: breakpoints of sources, then the mode anew. Parameters of models whose states inputs move
 * at once cannot change here, so the vector stays as it is. */
fmu_error fmu_event(fmu_instance *f, int *states_changed)
{
    *states_changed = 0;
    return settle_event(f, states_changed);
}
