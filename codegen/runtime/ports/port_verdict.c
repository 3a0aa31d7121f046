/* Whether a mode contradicts nothing at an instant, or a moment later, where that is a tie. */
#include <math.h>
#include <stddef.h>

#include "port_choosing.h"
#include "run_pace.h"

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

/* Which way the slip of a coupled port goes: 1, -1, or 0 where neither shows. Its rate tells unless
 * it is not the whole rate: where another port holds, what that gives may change a slip, too. */
static int heading(const bg_port *later, const bg_port *now, double ahead)
{
    const double moved = later->slip - now->slip, least = BG_SEEN * now->near_slip;
    const double told = 0.5 * (now->push + later->push) * ahead;
    if (fabs(moved) > least)
        return sign_of(moved, 0.0);
    if (fabs(told - moved) > least)
        return sign_of(moved, BG_MOVING * now->near_slip);
    return sign_of(now->push, now->near_push);
}

/* A tie decided a little later: still holding to rounding, or really moving off. */
static int late_verdict(const bg_port *later, const bg_port *now, int coupled, int sign,
                        double ahead)
{
    if (sign == 0)
        return later->cap - fabs(later->effort) >= -now->near_effort;
    const int heads = coupled ? sign * heading(later, now, ahead) : 0;
    if (heads)
        return heads > 0;
    return sign * later->push > BG_MOVING * now->near_push || sign * later->slip > now->near_slip;
}

/* The port of a column of the ruling's rows. */
static int ruled_port(const bg_ruling *ruling, int column)
{
    return ruling->ports ? ruling->ports[column] : column;
}

/* Whether what other inputs rule of the slips that stick is not zero or, a moment later, moves. */
static int ruled_out(const bg_ruling *ruling, const bg_port *now, const bg_port *later)
{
    for (int r = 0; r < ruling->count; r++) {
        double slip = 0.0, rate = 0.0, near = 0.0, slow = 0.0;
        for (int c = 0; c < ruling->width; c++) {
            const double weight = ruling->rows[r * ruling->width + c];
            const int i = ruled_port(ruling, c);
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
static int is_torn(const bg_ruling *ruling, const bg_port *now, const int *touched)
{
    for (int k = 0; k < ruling->kept; k++) {
        double slip = 0.0, near = 0.0;
        int passed = 0;
        for (int c = 0; c < ruling->width; c++) {
            const double weight = ruling->mix[k * ruling->width + c];
            const int i = ruled_port(ruling, c);
            slip += weight * now[i].slip;
            near += fabs(weight) * now[i].near_slip;
            passed |= weight != 0.0 && touched[i] == BG_PASSED;
        }
        if (!passed && !(fabs(slip) <= BG_WIDE * near))
            return 1;
    }
    return 0;
}

/* Looks a moment later, by one midpoint step from the instant that was looked at in the mode. */
static int look_later(const bg_sight *sight, const bg_instant *at, double ahead, const double *s,
                      const int *mode)
{
    for (int i = 0; i < sight->size; i++)
        sight->point[i] = s[i] + 0.5 * ahead * sight->rate[i];
    const int status = sight->look(sight->self, at->t + 0.5 * ahead, sight->point, mode);
    if (status)
        return status;
    for (int i = 0; i < sight->size; i++)
        sight->point[i] = s[i] + ahead * sight->rate[i];
    return sight->look(sight->self, at->t + ahead, sight->point, mode);
}

/* Takes port i to contradict the mode: friction, or of switches which. */
static void contradict(const bg_sight *c, int i, const bg_port *now, bg_finding *found)
{
    found->holds = 0;
    if (!rubs(c, i)) {
        bg_add(&found->broken, i);
        return;
    }
    found->rubbing = 1;
    bg_add(&found->turned, i);
    if (now[i].effort > 0)
        bg_add(&found->up, i);
}

/* A moment later, where the instant itself is a tie. */
static int late(const bg_choice *choice, const int *mode, const bg_port *now, const bg_set *tied,
                bg_finding *found)
{
    const bg_sight *const c = choice->sight;
    bg_port later[BG_MOST_PORTS];
    bg_ruling ruling = {0};
    const double ahead = bg_look_ahead(choice->at->time, choice->at->t, choice->at->following);
    const int status = look_later(c, choice->at, ahead, choice->s, mode);
    found->holds = status == BG_OK;
    if (status)
        return bg_ends_search(status) ? status : BG_OK;
    c->tell(c->self, mode, NULL, later, &ruling);
    if (ruled_out(&ruling, now, later)) {
        found->holds = 0;
        found->rubbing = 1;
        return BG_OK;
    }
    for (int i = 0; i < c->ports; i++) {
        if (!bg_has(tied, i))
            continue;
        const int goes = rubs(c, i)
            ? late_verdict(later + i, now + i, c->coupled[i], mode[i], ahead)
            : later[i].stay - now[i].stay >= -BG_SEEN * now[i].near_stay;
        if (!goes)
            contradict(c, i, now, found);
    }
    return BG_OK;
}

void bg_tell(const bg_choice *choice, const int *mode, bg_port *now, bg_ruling *ruling)
{
    const bg_sight *const c = choice->sight;
    c->tell(c->self, mode, choice->at, now, ruling);
    for (int i = 0; i < c->ports; i++) {
        if (!bg_hangs(c->kinds + i))
            continue;
        const double more = BG_TOGETHER * choice->at->leapt[i] / now[i].near_gap;
        const double lingers = choice->at->lingers[i] ? BG_LINGERING : 1.0;
        now[i].near_slip =
            fmax(now[i].near_slip, sqrt(fmax(more, 1.0)) * lingers * now[i].unseen);
    }
}

int bg_find(bg_choice *choice, const int *mode, const bg_set *asked, bg_finding *found)
{
    const bg_sight *const c = choice->sight;
    bg_port now[BG_MOST_PORTS];
    bg_ruling ruling = {0};
    bg_set tied = {{0}};
    const int status = c->look(c->self, choice->at->t, choice->s, mode);
    *found = (bg_finding){0};
    if (status) {
        choice->why = choice->why ? choice->why : status;
        return bg_ends_search(status) ? status : BG_OK;
    }
    choice->why = BG_UNDECIDED;
    bg_tell(choice, mode, now, &ruling);
    if (ruled_out(&ruling, now, NULL) || is_torn(&ruling, now, choice->at->touched))
        return BG_OK;
    if (ruling.unknown)
        return ruling.unknown;
    found->holds = 1;
    for (int i = 0; i < c->ports; i++) {
        int sure = 1;
        if (!bg_has(asked, i))
            continue;
        if (!rubs(c, i))
            sure = choice->blow.shocks[i] ? choice->blow.shocks[i]
                                          : sign_of(now[i].stay, now[i].near_stay);
        else
            sure = verdict(now + i, c->coupled[i], mode[i]);
        if (sure == 0)
            bg_add(&tied, i);
        if (sure < 0)
            contradict(c, i, now, found);
    }
    if (!found->holds || (bg_is_empty(&tied) && !ruling.count))
        return BG_OK;
    return late(choice, mode, now, &tied, found);
}
