/* Modes in turn, those that stick most first, until one contradicts nothing. */
#include "bg_choose.h"

#include <math.h>

static const double WIDE = 1e3;     /* an event's own rounding, in what counts as zero */
static const double ROUNDING = 1e-4; /* a little later, above this part of it a change is real .. */
static const double SEEN = 1e-2;     /* .. above this, where efforts change a slip at once */

/* What a choice rests on: the slips, and which ports are undecided. */
typedef struct {
    const bg_chooser *chooser;
    const signed char *before;
    int forward[BG_MOST_PORTS], undecided[BG_MOST_PORTS], count;
} bg_choice;

static int sign_of(double value, double least)
{
    return fabs(value) <= least ? 0 : value > 0 ? 1 : -1;
}

/* 1: goes with the mode; -1: contradicts it; 0: a tie. A slip that efforts change at once, or that
 * is none of rounding, decides by itself. */
static int verdict(const bg_port *port, int coupled, int sign)
{
    if (sign == 0)
        return sign_of(port->cap - fabs(port->effort), port->near_effort);
    const int sure = sign_of(sign * port->slip, (coupled ? 1.0 : WIDE) * port->near_slip);
    return sure || coupled ? sure : sign_of(sign * port->push, port->near_push);
}

/* A tie decided a little later: still holding to rounding, or really moving off. */
static int late_verdict(const bg_port *later, const bg_port *now, int coupled, int sign)
{
    if (sign == 0)
        return later->cap - fabs(later->effort) >= -now->near_effort;
    if (coupled) {
        const int moved = sign_of(sign * (later->slip - now->slip), SEEN * now->near_slip);
        const int pushed = sign_of(sign * now->push, now->near_push);
        if (moved || pushed)
            return (moved ? moved : pushed) > 0;
    }
    return sign * later->push > ROUNDING * now->near_push || sign * later->slip > now->near_slip;
}

/* Whether what other inputs rule of the slips that stick is not zero or, a moment later, moves. */
static int ruled_out(int ports, const bg_ruling *ruling, const bg_port *now, const bg_port *later)
{
    for (int r = 0; r < ruling->count; r++) {
        double slip = 0.0, rate = 0.0, near = 0.0, slow = 0.0;
        for (int i = 0; i < ports; i++) {
            const double weight = ruling->rows[r][i];
            slip += weight * (later ? later[i].slip - now[i].slip : now[i].slip);
            rate += weight * (later ? later[i].push : now[i].push);
            near += fabs(weight) * now[i].near_slip;
            slow += fabs(weight) * now[i].near_push;
        }
        const double least = later ? ROUNDING : 1.0;
        if (!(fabs(slip) <= least * near && fabs(rate) <= least * slow))
            return 1;
    }
    return 0;
}

/* A moment later, where the instant itself is a tie. */
static int late(const bg_choice *choice, const signed char *mode, const bg_port *now,
                const int *tied, int *holds)
{
    const bg_chooser *const c = choice->chooser;
    bg_port later[BG_MOST_PORTS];
    bg_ruling ruling = {0};
    const int status = c->look(c->self, mode, 1, later, &ruling);
    if (status)
        return status == BG_NO_MODE ? 0 : status;
    *holds = !ruled_out(c->ports, &ruling, now, later);
    for (int k = 0; k < choice->count; k++) {
        const int i = choice->undecided[k];
        *holds &= !tied[k] || late_verdict(later + i, now + i, c->coupled[i], mode[i]);
    }
    return 0;
}

/* Whether a mode contradicts nothing. */
static int consistent(const bg_choice *choice, const signed char *mode, int *holds)
{
    const bg_chooser *const c = choice->chooser;
    bg_port now[BG_MOST_PORTS];
    bg_ruling ruling = {0};
    int tied[BG_MOST_PORTS] = {0}, ties = 0;
    const int status = c->look(c->self, mode, 0, now, &ruling);
    *holds = 0;
    if (status)
        return status == BG_NO_MODE ? 0 : status;
    if (ruled_out(c->ports, &ruling, now, 0))
        return 0;
    if (ruling.unknown)
        return ruling.unknown;
    for (int k = 0; k < choice->count; k++) {
        const int i = choice->undecided[k], sure = verdict(now + i, c->coupled[i], mode[i]);
        if (sure < 0)
            return 0;
        ties += tied[k] = sure == 0;
    }
    *holds = 1;
    return ties || ruling.count ? late(choice, mode, now, tied, holds) : 0;
}

/* Choice `number` among three to the power of the undecided ports, the last changing fastest; how
 * many stick, and how many that were not touched change. */
static void candidate(const bg_choice *choice, int number, signed char *mode, int *sticking,
                      int *changed)
{
    *sticking = *changed = 0;
    for (int i = 0; i < choice->chooser->ports; i++)
        mode[i] = (signed char)choice->forward[i];
    for (int k = choice->count - 1; k >= 0; k--) {
        const int i = choice->undecided[k], before = choice->before[i];
        const int digit = number % 3, forward = before ? before : 1;
        number /= 3;
        mode[i] = (signed char)(digit == 0 ? 0 : digit == 1 ? forward : -forward);
        *sticking += mode[i] == 0;
        *changed += !choice->chooser->touched[i] && mode[i] != before;
    }
}

/* The first consistent mode: by the number of ports that stick, most first; then those that change
 * least. */
static int first_consistent(const bg_choice *choice, signed char *found)
{
    int total = 1;
    for (int k = 0; k < choice->count; k++)
        total *= 3;
    for (int stick = choice->count; stick >= 0; stick--)
        for (int change = 0; change <= choice->count; change++)
            for (int number = 0; number < total; number++) {
                int sticking, changed, holds;
                candidate(choice, number, found, &sticking, &changed);
                if (sticking != stick || changed != change)
                    continue;
                const int status = consistent(choice, found, &holds);
                if (status || holds)
                    return status;
            }
    return BG_NO_MODE;
}

int bg_try(int ports, int number, const signed char *mode, signed char *tried)
{
    const int ways = 1 << ports;
    for (int i = 0; i < ports; i++) {
        if (number < 2)
            tried[i] = (signed char)(mode[i] ? mode[i] : number == 0 ? 1 : -1);
        else if (number == 2)
            tried[i] = mode[i];
        else
            tried[i] = (signed char)(number - 3 >= ways ? 0 : (number - 3) >> i & 1 ? -1 : 1);
    }
    return number < ways + 4;
}

int bg_evaluated(const bg_chooser *c, int slipping, signed char *mode, bg_port *ports)
{
    signed char tried[BG_MOST_PORTS];
    bg_ruling ruling = {0};
    int status = slipping ? BG_NO_MODE : c->look(c->self, mode, 0, ports, &ruling);
    if (status != BG_NO_MODE)
        return status;
    for (int k = 0; status == BG_NO_MODE && bg_try(c->ports, k, mode, tried); k++)
        status = c->look(c->self, tried, 0, ports, &ruling);
    for (int i = 0; i < c->ports && status == 0; i++)
        mode[i] = tried[i];
    return status;
}

int bg_choose(const bg_chooser *c, signed char *mode)
{
    bg_choice choice = {.chooser = c, .before = mode};
    signed char looked[BG_MOST_PORTS], found[BG_MOST_PORTS];
    bg_port now[BG_MOST_PORTS];
    for (int i = 0; i < c->ports; i++)
        looked[i] = mode[i];
    int status = bg_evaluated(c, 1, looked, now);
    for (int i = 0; i < c->ports && !status; i++) {
        const double slip = fabs(now[i].slip), near = now[i].near_slip;
        const int loose = c->touched[i] || mode[i] == 0, passed = c->touched[i] == BG_PASSED;
        choice.forward[i] = now[i].slip > 0 ? 1 : -1;
        if (c->coupled[i] || slip <= near || passed || (loose && slip <= WIDE * near))
            choice.undecided[choice.count++] = i;
    }
    if (!status)
        status = first_consistent(&choice, found);
    for (int i = 0; i < c->ports && !status; i++)
        mode[i] = found[i];
    return status;
}
