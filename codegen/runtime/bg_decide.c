/* Which ports stick and which way the others slip: one consistent mode at one instant. */
#include "bg_internal.h"

#include <math.h>

/* What the choice at an instant rests on: the slips, and which ports are undecided. */
typedef struct {
    bg_shot now;
    bg_scales size;
    int undecided[BG_PORTS], count;
    double ahead;
} bg_choice;

/* Everything a little later in a mode, by one midpoint step. */
static int later(bg_context *c, const bg_mode *mode, const double *now, double ahead, double *shot)
{
    double s[BG_N];
    bg_shot half;
    for (int i = 0; i < BG_N; i++)
        s[i] = c->s[i] + 0.5 * ahead * now[BG_AT_RATE + i];
    const int status = bg_look(c, c->t + 0.5 * ahead, s, mode, half);
    if (status)
        return status;
    for (int i = 0; i < BG_N; i++)
        s[i] = c->s[i] + ahead * half[BG_AT_RATE + i];
    return bg_look(c, c->t + ahead, s, mode, shot);
}

/* 1: holds; -1: contradicts; 0: a tie. A slip that efforts change at once decides by itself. */
static int verdict(const bg_context *c, const double *shot, const bg_scales *size, int port,
                   int sign)
{
    double value, least;
    if (sign == 0) {
        value = shot[BG_AT_CAP + port] - fabs(shot[BG_AT_EFFORT + port]);
        least = size->effort[port];
    } else {
        const double slip = sign * shot[BG_AT_SLIP + port];
        if (c->model->coupled[port] && fabs(slip) > size->slip[port])
            return slip > 0 ? 1 : -1;
        value = sign * shot[BG_AT_PUSH + port];
        least = size->acceleration[port];
    }
    return fabs(value) <= least ? 0 : value > 0 ? 1 : -1;
}

/* A tie decided a little later: still holding to rounding, or really moving off. */
static int late_verdict(const double *shot, const bg_scales *size, int port, int sign)
{
    if (sign == 0)
        return shot[BG_AT_CAP + port] - fabs(shot[BG_AT_EFFORT + port]) >= -size->effort[port];
    const double rounding = 1e-4 * size->acceleration[port];
    return sign * shot[BG_AT_PUSH + port] > rounding
           || sign * shot[BG_AT_SLIP + port] > size->slip[port];
}

/* Whether a mode contradicts nothing. */
static int consistent(bg_context *c, const bg_choice *choice, const signed char *mode, int *holds)
{
    const bg_mode *found;
    bg_shot now, moment;
    bg_scales size;
    int looked = 0, status = bg_find(c, bg_number(mode), &found);
    if (status == BG_OK)
        status = bg_look(c, c->t, c->s, found, now);
    if (status)
        return status;
    bg_scale(c, now, c->t, &size);
    *holds = 0;
    for (int k = 0; k < choice->count; k++) {
        const int port = choice->undecided[k];
        int sure = verdict(c, now, &size, port, mode[port]);
        if (sure == 0) {
            status = looked ? BG_OK : later(c, found, now, choice->ahead, moment);
            if (status)
                return status;
            looked = 1;
            sure = late_verdict(moment, &size, port, mode[port]);
        }
        if (sure <= 0)
            return BG_OK;
    }
    *holds = 1;
    return BG_OK;
}

/* Choice `number` among three to the power of the undecided ports, the last changing fastest; how
 * many stick, and how many that were not touched change. */
static void candidate(const bg_context *c, const bg_choice *choice, int number, signed char *mode,
                      int *sticking, int *changed)
{
    *sticking = *changed = 0;
    for (int i = 0; i < BG_K; i++)
        mode[i] = choice->now[BG_AT_SLIP + i] > 0 ? 1 : -1;
    for (int k = choice->count - 1; k >= 0; k--) {
        const int port = choice->undecided[k], before = c->mode[port];
        const int digit = number % 3, forward = before ? before : 1;
        number /= 3;
        mode[port] = (signed char)(digit == 0 ? 0 : digit == 1 ? forward : -forward);
        *sticking += mode[port] == 0;
        *changed += !c->touched[port] && mode[port] != before;
    }
}

/* The first consistent mode: by the number of ports that stick, most first; then those that change
 * least. */
static int choose(bg_context *c, const bg_choice *choice)
{
    int total = 1;
    for (int k = 0; k < choice->count; k++)
        total *= 3;
    for (int stick = choice->count; stick >= 0; stick--)
        for (int change = 0; change <= choice->count; change++)
            for (int number = 0; number < total; number++) {
                signed char mode[BG_PORTS];
                int sticking, changed, holds = 0;
                candidate(c, choice, number, mode, &sticking, &changed);
                if (sticking != stick || changed != change)
                    continue;
                const int status = consistent(c, choice, mode, &holds);
                if (status)
                    return status;
                if (holds) {
                    for (int i = 0; i < BG_K; i++)
                        c->mode[i] = mode[i];
                    return BG_OK;
                }
            }
    return BG_UNDECIDED;
}

/* Ports at rest, or so close that it is an event's own rounding, stick if they can. */
int bg_decide(bg_context *c, double time)
{
    bg_choice choice;
    const bg_mode *found;
    signed char slipping[BG_PORTS];
    if (BG_K == 0)
        return BG_OK;
    for (int i = 0; i < BG_K; i++)
        slipping[i] = c->mode[i] ? c->mode[i] : 1;
    int status = bg_find(c, bg_number(slipping), &found);
    if (status == BG_OK)
        status = bg_look(c, c->t, c->s, found, choice.now);
    if (status)
        return status;
    bg_see(c, found, choice.now);
    c->peaks.time = time;
    bg_scale(c, choice.now, c->t, &choice.size);
    choice.ahead = BG_LOOK_AHEAD * time;
    choice.count = 0;
    for (int i = 0; i < BG_K; i++) {
        const double slip = fabs(choice.now[BG_AT_SLIP + i]), near = choice.size.slip[i];
        const int loose = c->touched[i] || c->mode[i] == 0;
        if (c->model->coupled[i] || slip <= near || (loose && slip <= 1e3 * near))
            choice.undecided[choice.count++] = i;
    }
    return choose(c, &choice);
}
