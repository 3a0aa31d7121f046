/* Which ports are held and which way the others slip: one consistent mode at one instant. */
#include <limits.h>
#include <math.h>
#include <string.h>

#include "fmu_common.h"

/* How long ago a slip was zero, or will be: by its rate in the mode that was. */
static double time_from_zero(const fmu_instance *f, int port)
{
    const bg_snapshot *const shot = &f->located.view.shot;
    double terms;
    const double rate = bg_slip_rate(&f->model, shot, port, &terms);
    const double slip = shot->y[bg_friction_readings[port]];
    return slip == 0.0 ? 0.0 : rate == 0.0 ? INFINITY : fabs(slip / rate);
}

/* Slips that go through zero almost as near to an instant as the importer has found that of another
 * are at zero, too: jumps that cross ever faster, each found late, would circle and never slide. */
static void note_near(const fmu_instance *f, int *touched)
{
    double late = 0.0;
    for (int i = 0; i < K; i++)
        if (touched[i] == BG_PASSED)
            late = fmax(late, time_from_zero(f, i));
    for (int i = 0; i < K && late > 0.0; i++) {
        const int slips = bg_switches[i].kind == BG_RUBS && f->at.mode[i] != 0;
        if (slips && touched[i] == BG_UNTOUCHED && time_from_zero(f, i) <= BG_CIRCLES * late)
            touched[i] = BG_PASSED;
    }
}

/* What the instant is to each port: by the indicators of the mode that was. An importer may find an
 * event of a slip no better than to its own steps. */
static void note_touched(fmu_instance *f, int *touched)
{
    double indicators[BG_ROOM(FMU_INDICATORS)];
    if (!f->at.decided || fmu_look(f))
        return; /* a mode that can no longer be evaluated tells nothing */
    fmu_indicators_of(f, &f->located.view.shot, indicators);
    for (int i = 0; i < K; i++)
        if (indicators[2 * i] <= 0 || indicators[2 * i + 1] <= 0)
            touched[i] = f->at.mode[i] ? BG_PASSED : BG_TOUCHED;
    note_near(f, touched);
}

/* What later decisions and the indicators measure by. */
static void note_sizes(fmu_instance *f)
{
    bg_port ports[BG_ROOM(K)];
    bg_view_ports(&f->located.view, f->at.mode, FMU_SHORTEST, ports);
    for (int i = 0; i < K; i++) {
        f->at.rest[i] = BG_HYSTERESIS * ports[i].near_slip;
        f->at.margin[i] = BG_HYSTERESIS * ports[i].near_effort;
    }
}

void fmu_note_stays(fmu_instance *f)
{
    bg_port ports[BG_ROOM(K)];
    if (!BG_SWITCHES && !BG_HUNG)
        return;
    bg_view_ports(&f->located.view, f->at.mode, FMU_SHORTEST, ports);
    for (int i = 0; i < K; i++)
        if (bg_switches[i].kind != BG_RUBS)
            f->at.margin[i] = BG_HYSTERESIS
                * (bg_is_apart(bg_switches + i, f->at.mode[i]) ? ports[i].near_gap
                                                               : ports[i].near_stay);
        else if (bg_hangs(bg_switches + i) && f->at.mode[i])
            f->at.margin[i] = BG_HYSTERESIS * ports[i].near_gap;
}

/* The mode just after the instance's time; ports at rest, or that crossed it, stick if they can. */
fmu_error fmu_decide(fmu_instance *f)
{
    const bg_sight sight = bg_view_sight(&f->located.view);
    bg_log log = {.capacity = INT_MAX};
    bg_instant at = {.t = f->at.time, .time = FMU_SHORTEST, .following = INFINITY, .s = f->at.s,
                     .log = &log};
    int slipping[BG_MOST_PORTS] = {0};
    if (K == 0)
        return NULL;
    f->stale = 1;
    bg_begin_log(&log, f->at.mode);
    log.begins = !f->at.decided;
    fmu_next_break(f, &at.following);
    note_touched(f, at.touched);
    memcpy(slipping, f->at.mode, sizeof f->at.mode);
    int status = bg_evaluated(&sight, &at, 1, slipping);
    if (status == BG_OK) {
        bg_view_see(&f->located.view, f->at.s, slipping);
        note_sizes(f);
        status = bg_choose(&sight, &at, f->at.mode);
    }
    f->at.decided |= status == BG_OK;
    return fmu_message(f, status);
}
