/* Modes in turn, those that stick most first, until one contradicts nothing. */
#include "bg_choose.h"

#include <math.h>

/* What a choice rests on: the slips, and which ports are undecided. */
typedef struct {
    const bg_chooser *chooser;
    const signed char *before;
    int forward[BG_MOST_PORTS], undecided[BG_MOST_PORTS], count;
} bg_choice;

/* 1: holds; -1: contradicts; 0: a tie. A slip that efforts change at once decides by itself. */
static int verdict(const bg_port *port, int coupled, int sign)
{
    double value = port->cap - fabs(port->effort), least = port->near_effort;
    if (sign) {
        const double slip = sign * port->slip;
        if (coupled && fabs(slip) > port->near_slip)
            return slip > 0 ? 1 : -1;
        value = sign * port->push;
        least = port->near_push;
    }
    return fabs(value) <= least ? 0 : value > 0 ? 1 : -1;
}

/* A tie decided a little later: still holding to rounding, or really moving off. */
static int late_verdict(const bg_port *later, const bg_port *now, int sign)
{
    if (sign == 0)
        return later->cap - fabs(later->effort) >= -now->near_effort;
    return sign * later->push > 1e-4 * now->near_push || sign * later->slip > now->near_slip;
}

/* Whether a mode contradicts nothing. */
static int consistent(const bg_choice *choice, const signed char *mode, int *holds)
{
    const bg_chooser *const c = choice->chooser;
    bg_port now[BG_MOST_PORTS], later[BG_MOST_PORTS];
    int looked = 0, status = c->look(c->self, mode, 0, now);
    *holds = 0;
    for (int k = 0; k < choice->count && !status; k++) {
        const int i = choice->undecided[k];
        int sure = verdict(now + i, c->coupled[i], mode[i]);
        if (sure == 0) {
            status = looked ? 0 : c->look(c->self, mode, 1, later);
            looked = 1;
            sure = status ? 0 : late_verdict(later + i, now + i, mode[i]);
        }
        if (sure <= 0)
            return status;
    }
    *holds = !status;
    return status;
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

int bg_choose(const bg_chooser *c, signed char *mode)
{
    bg_choice choice = {.chooser = c, .before = mode};
    signed char slipping[BG_MOST_PORTS], found[BG_MOST_PORTS];
    bg_port now[BG_MOST_PORTS];
    for (int i = 0; i < c->ports; i++)
        slipping[i] = mode[i] ? mode[i] : 1;
    int status = c->look(c->self, slipping, 0, now);
    for (int i = 0; i < c->ports && !status; i++) {
        const double slip = fabs(now[i].slip), near = now[i].near_slip;
        const int loose = c->touched[i] || mode[i] == 0;
        choice.forward[i] = now[i].slip > 0 ? 1 : -1;
        if (c->coupled[i] || slip <= near || (loose && slip <= 1e3 * near))
            choice.undecided[choice.count++] = i;
    }
    if (!status)
        status = first_consistent(&choice, found);
    for (int i = 0; i < c->ports && !status; i++)
        mode[i] = found[i];
    return status;
}
