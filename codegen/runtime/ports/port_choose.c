/* Modes in turn, those that stick most first, until one contradicts nothing. */
#include "port_choosing.h"

#include <math.h>
#include <stddef.h>

#include "run_pace.h"

/* Whether a status says nothing about the mode: it is a refusal, or asks for something. */
static int ends_search(int status)
{
    return status == BG_NEEDS_SLOPE || status == BG_STRUCTURE || status == BG_NOT_AFFINE
        || status >= BG_MISSING;
}

static int rubs(const bg_sight *c, int port)
{
    return !c->switches || c->switches[port].kind == BG_RUBS;
}

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
    const int sure = sign_of(sign * port->slip, (coupled ? 1.0 : BG_WIDE) * port->near_slip);
    return sure || coupled ? sure : sign_of(sign * port->push, port->near_push);
}

/* A tie decided a little later: still holding to rounding, or really moving off. */
static int late_verdict(const bg_port *later, const bg_port *now, int coupled, int sign)
{
    if (sign == 0)
        return later->cap - fabs(later->effort) >= -now->near_effort;
    if (coupled) {
        const int moved = sign_of(sign * (later->slip - now->slip), BG_SEEN * now->near_slip);
        const int pushed = sign_of(sign * now->push, now->near_push);
        if (moved || pushed)
            return (moved ? moved : pushed) > 0;
    }
    return sign * later->push > BG_MOVING * now->near_push || sign * later->slip > now->near_slip;
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
        const double least = later ? BG_MOVING : 1.0;
        if (!(fabs(slip) <= least * near && fabs(rate) <= least * slow))
            return 1;
    }
    return 0;
}

/* Whether ports of a mode would have to stop at once what they receive together: friction gives no
 * impulse, and what switches stop they have stopped before. What is only found long after it has
 * happened may have moved on. */
static int is_torn(int ports, const bg_ruling *ruling, const bg_port *now, const int *touched)
{
    for (int k = 0; k < ruling->kept; k++) {
        double slip = 0.0, near = 0.0;
        int passed = 0;
        for (int i = 0; i < ports; i++) {
            slip += ruling->mix[k][i] * now[i].slip;
            near += fabs(ruling->mix[k][i]) * now[i].near_slip;
            passed |= ruling->mix[k][i] != 0.0 && touched[i] == BG_PASSED;
        }
        if (!passed && !(fabs(slip) <= BG_WIDE * near))
            return 1;
    }
    return 0;
}

/* Looks a moment later, by one midpoint step from the instant that was looked at in the mode. */
static int look_later(const bg_sight *sight, const bg_instant *at, const double *s, const int *mode)
{
    const double ahead = bg_look_ahead(at->time, at->t, at->following);
    for (int i = 0; i < sight->size; i++)
        sight->point[i] = s[i] + 0.5 * ahead * sight->rate[i];
    const int status = sight->look(sight->self, at->t + 0.5 * ahead, sight->point, mode);
    if (status)
        return status;
    for (int i = 0; i < sight->size; i++)
        sight->point[i] = s[i] + ahead * sight->rate[i];
    return sight->look(sight->self, at->t + ahead, sight->point, mode);
}

/* Takes port i to contradict the mode, if it does: friction, or of switches which. */
static void contradict(const bg_sight *c, int i, bg_finding *found)
{
    found->rubbing |= rubs(c, i);
    found->broken |= rubs(c, i) ? 0u : 1u << i;
    found->holds = 0;
}

/* A moment later, where the instant itself is a tie. */
static int late(const bg_choice *choice, const int *mode, const bg_port *now, const int *tied,
                bg_finding *found)
{
    const bg_sight *const c = choice->sight;
    bg_port later[BG_MOST_PORTS];
    bg_ruling ruling = {0};
    const int status = look_later(c, choice->at, choice->s, mode);
    found->holds = status == BG_OK;
    if (status)
        return ends_search(status) ? status : BG_OK;
    c->tell(c->self, mode, NULL, later, &ruling);
    if (ruled_out(c->ports, &ruling, now, later)) {
        found->holds = 0;
        found->rubbing = 1;
    }
    for (int i = 0; i < c->ports; i++) {
        const int goes = rubs(c, i)
            ? late_verdict(later + i, now + i, c->coupled[i], mode[i])
            : later[i].stay - now[i].stay >= -BG_SEEN * now[i].near_stay;
        if (tied[i] && !goes)
            contradict(c, i, found);
    }
    return BG_OK;
}

/* Whether a mode contradicts nothing. */
static int consistent(bg_choice *choice, const int *mode, bg_finding *found)
{
    const bg_sight *const c = choice->sight;
    bg_port now[BG_MOST_PORTS];
    bg_ruling ruling = {0};
    int tied[BG_MOST_PORTS] = {0}, ties = 0;
    const int status = c->look(c->self, choice->at->t, choice->s, mode);
    *found = (bg_finding){0};
    if (status) {
        choice->why = choice->why ? choice->why : status;
        return ends_search(status) ? status : BG_OK;
    }
    choice->why = BG_UNDECIDED;
    c->tell(c->self, mode, choice->at, now, &ruling);
    if (ruled_out(c->ports, &ruling, now, 0)
        || is_torn(c->ports, &ruling, now, choice->at->touched))
        return BG_OK;
    if (ruling.unknown)
        return ruling.unknown;
    found->holds = 1;
    for (int i = 0; i < c->ports; i++) {
        int sure = 1;
        if (!rubs(c, i))
            sure = choice->shocks[i] ? choice->shocks[i] : sign_of(now[i].stay, now[i].near_stay);
        else if (choice->open >> i & 1u)
            sure = verdict(now + i, c->coupled[i], mode[i]);
        ties += tied[i] = sure == 0;
        if (sure < 0)
            contradict(c, i, found);
    }
    return found->holds && (ties || ruling.count) ? late(choice, mode, now, tied, found) : BG_OK;
}

/* Choice `number` among three to the power of the undecided ports, the last changing fastest; how
 * many stick, and how many that were not touched change. */
static void candidate(const bg_choice *choice, int number, int *mode, int *sticking, int *changed)
{
    *sticking = *changed = 0;
    for (int i = 0; i < choice->sight->ports; i++)
        mode[i] = choice->forward[i];
    for (int k = choice->count - 1; k >= 0; k--) {
        const int i = choice->undecided[k], before = choice->before[i];
        const int digit = number % 3, forward = before ? before : 1;
        number /= 3;
        mode[i] = digit == 0 ? 0 : digit == 1 ? forward : -forward;
        *sticking += mode[i] == 0;
        *changed += !choice->at->touched[i] && mode[i] != before;
    }
}

/* The first consistent mode: by the number of ports that stick, most first; then those that change
 * least. *broken: switches that alone contradict the first that could be one. */
static int first_consistent(bg_choice *choice, int *mode, int *holds, unsigned *broken)
{
    int total = 1;
    *broken = 0;
    for (int k = 0; k < choice->count; k++)
        total *= 3;
    for (int stick = choice->count; stick >= 0; stick--)
        for (int change = 0; change <= choice->count; change++)
            for (int number = 0; number < total; number++) {
                int sticking, changed;
                bg_finding found;
                candidate(choice, number, mode, &sticking, &changed);
                if (sticking != stick || changed != change)
                    continue;
                const int status = consistent(choice, mode, &found);
                *holds = found.holds;
                if (status || *holds)
                    return status;
                if (*broken == 0 && !found.rubbing)
                    *broken = found.broken;
            }
    return BG_OK;
}

int bg_try(int ports, int number, const int *mode, int *tried)
{
    const int ways = 1 << ports;
    for (int i = 0; i < ports; i++) {
        if (number < 2)
            tried[i] = mode[i] ? mode[i] : number == 0 ? 1 : -1;
        else if (number == 2)
            tried[i] = mode[i];
        else
            tried[i] = number - 3 >= ways ? 0 : (number - 3) >> i & 1 ? -1 : 1;
    }
    return number < ways + 4;
}

int bg_evaluated(const bg_sight *c, const bg_instant *at, int slipping, int *mode)
{
    int tried[BG_MOST_PORTS], first = BG_OK;
    int status = slipping ? BG_UNDECIDED : c->look(c->self, at->t, at->s, mode);
    if (!slipping && (status == BG_OK || ends_search(status)))
        return status;
    first = slipping ? BG_OK : status;
    for (int k = 0; bg_try(c->ports, k, mode, tried); k++) {
        status = c->look(c->self, at->t, at->s, tried);
        for (int i = 0; i < c->ports && status == BG_OK; i++)
            mode[i] = tried[i];
        if (status == BG_OK || ends_search(status))
            return status;
        first = first ? first : status;
    }
    return first;
}

int bg_choose_rubbing(bg_choice *choice, int *mode, int *holds, unsigned *broken)
{
    const bg_sight *const c = choice->sight;
    const bg_instant here = {.t = choice->at->t, .time = choice->at->time, .s = choice->s};
    int looked[BG_MOST_PORTS];
    bg_port now[BG_MOST_PORTS];
    *holds = 0;
    *broken = 0;
    for (int i = 0; i < c->ports; i++)
        looked[i] = mode[i];
    const int status = bg_evaluated(c, &here, 1, looked);
    if (status) {
        choice->why = choice->why ? choice->why : status;
        return ends_search(status) ? status : BG_OK;
    }
    c->tell(c->self, looked, choice->at, now, NULL);
    choice->count = 0;
    choice->open = 0;
    for (int i = 0; i < c->ports; i++) {
        const double slip = fabs(now[i].slip), near = now[i].near_slip;
        const int touched = choice->at->touched[i];
        const int loose = touched || mode[i] == 0, passed = touched == BG_PASSED;
        choice->forward[i] = !rubs(c, i) ? mode[i] : now[i].slip > 0 ? 1 : -1;
        if (rubs(c, i)
            && (c->coupled[i] || slip <= near || (passed && !choice->struck)
                || (loose && slip <= BG_WIDE * near))) {
            choice->undecided[choice->count++] = i;
            choice->open |= 1u << i;
        }
    }
    choice->before = mode;
    int found[BG_MOST_PORTS];
    const int ended = first_consistent(choice, found, holds, broken);
    for (int i = 0; i < c->ports && *holds; i++)
        mode[i] = found[i];
    return ended;
}
