/* Which friction ports stick in a step: Karnopp's dead band, in at most 4 evaluations for each port
 * near rest; where that comes to what is no mode, all modes of those eight that slip most. */
#include <math.h>
#include <string.h>

#include "model_internal.h"
#include "port_choose.h"

enum { ENUMERATED = 8 };

static int sticks(const int *mode)
{
    int any = 0;
    for (int i = 0; i < K; i++)
        any |= mode[i] == 0;
    return any;
}

static int is_rubbing(int port)
{
    return bg_switches[port].kind == BG_RUBS;
}

/* Slips below that count as zero: of friction the dead band, or their rounding. */
static double least_slip(const bg_model *m, int port, double terms)
{
    const double rounding = BG_STEP_ROUNDING * terms;
    return is_rubbing(port) ? fmax(m->band[port], rounding) : rounding;
}

/* A port may stick if its slip is inside the band, has changed its sign since the step before, by
 * no more than a step of h can, or depends on its effort at once. First guess: all these stick;
 * their number. */
static int first_guess(bg_model *m, const bg_start *at, int *near)
{
    int count = 0;
    for (int i = 0; i < K; i++) {
        double around, terms;
        near[i] = 0;
        m->work.turning[i] = 0.0;
        if (!is_rubbing(i))
            continue;
        const double slip = bg_slip(m, &m->shot, i, &around);
        const double rate = bg_slip_rate(m, &m->shot, i, &terms);
        near[i] = fabs(slip) <= least_slip(m, i, around) || bg_beside[i];
        /* An input that steps may turn a slip round too; what a step can't reach slips on. */
        m->work.turning[i] = at->started ? 2 * at->h * fabs(rate) : 0.0;
        near[i] |= slip * at->before[i] < 0 && fabs(slip) <= m->work.turning[i];
        m->work.part[i] =
            fabs(slip) / (least_slip(m, i, around) + m->work.turning[i] + BG_TINY);
        m->mode[i] = near[i] ? 0 : slip > 0 ? 1 : -1;
    }
    bg_bring(m, at->h, near);
    for (int i = 0; i < K; i++)
        count += near[i];
    return count;
}

/* Lets the sticking port go that is held farthest beyond its breakaway effort; 0: there is none. */
static int let_go(bg_model *m)
{
    double worst = 0.0, most = 0.0;
    int found = -1;
    for (int i = 0; i < K; i++)
        most = fmax(most, fabs(m->shot.u[bg_friction_inputs[i]]));
    for (int i = 0; i < K; i++) {
        const double effort = fabs(m->shot.u[bg_friction_inputs[i]]), cap = m->shot.caps[i];
        const int sticking = is_rubbing(i) && m->mode[i] == 0;
        const double over = sticking ? effort - cap * (1 + BG_BREAKAWAY) : 0.0;
        if (over > 0 && (found < 0 || over / (cap + BG_BREAKAWAY * most) > worst)) {
            found = i;
            worst = over / (cap + BG_BREAKAWAY * most);
        }
    }
    if (found >= 0)
        m->mode[found] = m->shot.u[bg_friction_inputs[found]] > 0 ? 1 : -1;
    return found >= 0;
}

/* Catches a port let go that would slip against its direction; 0: there is none. */
static int caught(bg_model *m, const int *near)
{
    for (int i = 0; i < K; i++) {
        double terms, moves;
        if (!near[i] || m->mode[i] == 0)
            continue;
        moves = bg_beside[i] ? bg_slip(m, &m->shot, i, &terms)
                             : bg_slip_rate(m, &m->shot, i, &terms);
        if (moves * m->mode[i] < -BG_STEP_ROUNDING * terms) {
            m->mode[i] = 0;
            return 1;
        }
    }
    return 0;
}

/* Whether friction ports would have to stop at once what they receive together; what a step can
 * bring to rest counts as being there. Of a single port its own slip has told. */
static int is_torn_in_step(const bg_model *m, const bg_hold *held)
{
    for (int k = 0; k < held->kept; k++) {
        double slip = 0.0, least = 0.0;
        int together = 0, switched = 0;
        for (int c = 0; c < held->count; c++) {
            const double weight = held->mix[k * held->count + c];
            const int port = held->ports[c];
            double terms;
            slip += weight * bg_slip(m, &m->shot, port, &terms);
            least += fabs(weight) * (least_slip(m, port, terms) + m->work.turning[port]);
            together += weight != 0.0;
            switched |= weight != 0.0 && !is_rubbing(port);
        }
        if (together > 1 && !switched && fabs(slip) > least)
            return 1;
    }
    return 0;
}

/* Whether slips that only inputs rule are not zero though ports are to be held there. */
static int rules_out(bg_model *m)
{
    bg_hold *held = NULL;
    if (!sticks(m->mode) || bg_hold_of(m, m->mode, &held) != BG_OK)
        return 0;
    for (int r = 0; r < held->ruled; r++) {
        double slip = 0.0, least = 0.0;
        for (int c = 0; c < held->count; c++) {
            const double weight = held->share[r * held->count + c];
            double terms;
            slip += weight * bg_slip(m, &m->shot, held->ports[c], &terms);
            least += fabs(weight) * least_slip(m, held->ports[c], terms);
        }
        if (fabs(slip) > least)
            return 1;
    }
    return is_torn_in_step(m, held);
}

int bg_look(bg_model *m, const bg_start *at, const int *mode)
{
    return bg_evaluate(m, at->t, at->s, at->w, at->dw, mode, 1, &m->shot);
}

int bg_held(bg_model *m, const bg_start *at)
{
    const int status = bg_look(m, at, m->mode);
    return status != BG_OK ? status : rules_out(m) ? BG_UNDECIDED : BG_OK;
}

/* By a mode in which there are values: laws may have no solution one way. */
int bg_look_slipping(bg_model *m, const bg_start *at, const int *mode)
{
    int tried[BG_MOST_PORTS] = {0};
    int status = BG_NO_SOLUTION, first = BG_OK;
    for (int k = 0; status != BG_OK && bg_try(K, k, mode, tried); k++) {
        status = bg_look(m, at, tried);
        first = k ? first : status;
    }
    return status == BG_OK ? BG_OK : first;
}

/* The mode of a number: a digit of base 3 for each port near rest; how many stick. */
static int numbered(bg_model *m, const int *near, const int *rest, int number)
{
    int sticking = 0;
    for (int i = 0; i < K; i++) {
        m->mode[i] = near[i] ? (number % 3 + 1) % 3 - 1 : rest[i];
        number /= near[i] ? 3 : 1;
        sticking += near[i] && m->mode[i] == 0;
    }
    return sticking;
}

/* Of the ports near rest those that slip most, as many as all ways are tried of; others stick. */
static void leave_most(bg_model *m, int *near)
{
    int count = 0;
    for (int i = 0; i < K; i++)
        count += near[i];
    for (; count > ENUMERATED; count--) {
        int least = -1;
        for (int i = 0; i < K; i++)
            if (near[i] && (least < 0 || m->work.part[i] < m->work.part[least]))
                least = i;
        near[least] = 0;
        m->mode[least] = 0;
    }
}

/* The first mode that contradicts nothing, those in which most ports stick first: where one change
 * at a time has come to what is no mode, for a reason that is told if there is none. */
static int search_all(bg_model *m, const bg_start *at, int *near, int reason)
{
    int rest[PORTS] = {0}, kept[PORTS] = {0}, count = 0, total = 1;
    leave_most(m, near);
    memcpy(rest, m->mode, sizeof m->mode);
    for (int i = 0; i < K; i++) {
        count += near[i];
        total *= near[i] ? 3 : 1;
    }
    for (int stick = count; stick >= 0; stick--)
        for (int number = 0; number < total; number++) {
            if (numbered(m, near, rest, number) != stick || bg_held(m, at) != BG_OK)
                continue;
            memcpy(kept, m->mode, sizeof m->mode);
            if (!let_go(m) && !caught(m, near))
                return BG_OK;
            memcpy(m->mode, kept, sizeof m->mode);
        }
    return reason;
}

/* One port changes at a time. */
int bg_stick(bg_model *m, const bg_start *at)
{
    int near[PORTS], now[BG_MOST_PORTS] = {0};
    for (int i = 0; i < K; i++)
        now[i] = at->started ? at->before[i] : is_rubbing(i) ? 0 : m->mode[i];
    int status = bg_look_slipping(m, at, now);
    const int tries = status == BG_OK ? 4 * first_guess(m, at, near) : 0;
    for (int k = 0; k < tries; k++) {
        status = bg_held(m, at);
        if (status == BG_NEEDS_SLOPE || status == BG_STRUCTURE)
            return status;
        if (status != BG_OK)
            return search_all(m, at, near, status);
        if (!let_go(m) && !caught(m, near))
            return BG_OK;
    }
    return status;
}
