/* Which ports stick and which way the others slip: one consistent mode at one instant. */
#include <math.h>
#include <string.h>

#include "fmu_common.h"

enum { K = BG_FRICTION };
#define PORTS BG_ROOM(BG_FRICTION)
static const double AHEAD = 1e-4 * FMU_SHORTEST; /* ties are decided so much later */
static const double HYSTERESIS = 10.0;           /* in units of rounding */

typedef struct {
    double slip[PORTS];
    fmu_scales size;
    int undecided[PORTS], touched[PORTS], count;
} choice;

/* Everything a little later in a mode, by one midpoint step. */
static fmu_error later(fmu_instance *f, const int *mode, const bg_snapshot *now, bg_snapshot *then)
{
    const double t = f->at.time;
    double following = INFINITY;
    fmu_error failed;
    fmu_next_break(f, &following);
    const double ahead = fmin(AHEAD, 0.5 * (following - t));
    for (int i = 0; i < BG_SIZE; i++)
        f->point[0][i] = f->at.s[i] + 0.5 * ahead * now->rate[i];
    failed = fmu_look(f, t + 0.5 * ahead, f->point[0], mode, then);
    for (int i = 0; i < BG_SIZE; i++)
        f->point[1][i] = f->at.s[i] + ahead * then->rate[i];
    return failed ? failed : fmu_look(f, t + ahead, f->point[1], mode, then);
}

/* 1: holds; -1: contradicts; 0: a tie. A slip that is none of rounding decides by itself. */
static int verdict(const fmu_instance *f, const choice *c, const bg_snapshot *now,
                   const fmu_scales *size, int port, int sign)
{
    double value, least;
    if (sign == 0) {
        value = now->caps[port] - fabs(now->u[bg_friction_inputs[port]]);
        least = size->effort[port];
    } else {
        const double slip = sign * now->y[bg_friction_readings[port]];
        if (fabs(slip) > (bg_beside[port] ? 1.0 : 1e2) * c->size.slip[port])
            return slip > 0 ? 1 : -1;
        value = sign * fmu_slip_rate(f, now, port);
        least = size->acceleration[port];
    }
    return fabs(value) <= least ? 0 : value > 0 ? 1 : -1;
}

/* A tie decided a little later: still holding to rounding, or really moving off. */
static int late_verdict(const fmu_instance *f, const bg_snapshot *then, const fmu_scales *size,
                        int port, int sign)
{
    if (sign == 0)
        return then->caps[port] - fabs(then->u[bg_friction_inputs[port]]) >= -size->effort[port];
    return sign * fmu_slip_rate(f, then, port) > 1e-4 * size->acceleration[port]
        || sign * then->y[bg_friction_readings[port]] > size->slip[port];
}

/* Whether a mode contradicts nothing. */
static fmu_error consistent(fmu_instance *f, const choice *c, const int *mode, int *holds)
{
    fmu_scales size;
    int looked = 0;
    fmu_error failed = fmu_look(f, f->at.time, f->at.s, mode, &f->look[0]);
    *holds = 0;
    if (failed)
        return failed;
    fmu_scale(f, &f->look[0], &size);
    for (int k = 0; k < c->count; k++) {
        const int port = c->undecided[k];
        int sure = verdict(f, c, &f->look[0], &size, port, mode[port]);
        if (sure == 0) {
            failed = looked ? NULL : later(f, mode, &f->look[0], &f->look[1]);
            if (failed)
                return failed;
            looked = 1;
            sure = late_verdict(f, &f->look[1], &size, port, mode[port]);
        }
        if (sure <= 0)
            return NULL;
    }
    *holds = 1;
    return NULL;
}

/* Choice `number` among three to the power of the undecided ports, the last changing fastest; how
 * many stick, and how many that were not touched change. */
static void candidate(const fmu_instance *f, const choice *c, int number, int *mode, int *sticking,
                      int *changed)
{
    *sticking = *changed = 0;
    for (int i = 0; i < K; i++)
        mode[i] = c->slip[i] > 0 ? 1 : -1;
    for (int k = c->count - 1; k >= 0; k--) {
        const int port = c->undecided[k], before = f->at.mode[port];
        const int digit = number % 3, forward = before ? before : 1;
        number /= 3;
        mode[port] = digit == 0 ? 0 : digit == 1 ? forward : -forward;
        *sticking += mode[port] == 0;
        *changed += !c->touched[port] && mode[port] != before;
    }
}

/* The first consistent mode: by the number of ports that stick, most first; then those that change
 * least. A mode that cannot be evaluated is none. */
static fmu_error choose(fmu_instance *f, const choice *c)
{
    fmu_error failed = NULL;
    int total = 1;
    for (int k = 0; k < c->count; k++)
        total *= 3;
    for (int stick = c->count; stick >= 0; stick--)
        for (int change = 0; change <= c->count; change++)
            for (int number = 0; number < total; number++) {
                int mode[PORTS], sticking, changed, holds = 0;
                fmu_error wrong;
                candidate(f, c, number, mode, &sticking, &changed);
                if (sticking != stick || changed != change)
                    continue;
                wrong = consistent(f, c, mode, &holds);
                failed = wrong ? wrong : failed;
                if (holds) {
                    memcpy(f->at.mode, mode, sizeof mode);
                    return NULL;
                }
            }
    return failed ? failed : "no way of sticking and slipping is consistent";
}

/* Ports whose event it is: by the indicators of the mode that was. */
static fmu_error note_touched(fmu_instance *f, choice *c)
{
    double indicators[BG_ROOM(FMU_INDICATORS)];
    fmu_error failed;
    memset(c->touched, 0, sizeof c->touched);
    if (!f->at.decided)
        return NULL;
    failed = fmu_look(f, f->at.time, f->at.s, f->at.mode, &f->look[0]);
    if (failed)
        return failed;
    fmu_indicators_of(f, &f->look[0], indicators);
    for (int i = 0; i < K; i++)
        c->touched[i] = indicators[2 * i] <= 0 || indicators[2 * i + 1] <= 0;
    return NULL;
}

/* The mode just after the instance's time; ports at rest, or that crossed it, stick if they can. */
fmu_error fmu_decide(fmu_instance *f)
{
    choice c;
    int slipping[PORTS];
    fmu_error failed = K > 0 ? note_touched(f, &c) : NULL;
    if (K == 0 || failed)
        return failed;
    for (int i = 0; i < K; i++)
        slipping[i] = f->at.mode[i] ? f->at.mode[i] : 1;
    failed = fmu_look(f, f->at.time, f->at.s, slipping, &f->look[0]);
    if (failed)
        return failed;
    fmu_note_peaks(f, &f->look[0]);
    fmu_scale(f, &f->look[0], &c.size);
    c.count = 0;
    for (int i = 0; i < K; i++) {
        const double slip = c.slip[i] = f->look[0].y[bg_friction_readings[i]];
        const double wide = f->at.decided && f->at.mode[i] == 0 ? 1e4 : 1e2;
        const int crossed = c.touched[i] && f->at.mode[i] != 0;
        if (bg_beside[i] || crossed || fabs(slip) <= wide * c.size.slip[i])
            c.undecided[c.count++] = i;
    }
    failed = choose(f, &c);
    if (failed)
        return failed;
    f->at.decided = 1;
    for (int i = 0; i < K; i++) {
        f->at.rest[i] = HYSTERESIS * c.size.slip[i];
        f->at.margin[i] = HYSTERESIS * c.size.effort[i];
    }
    f->stale = 1;
    return NULL;
}
