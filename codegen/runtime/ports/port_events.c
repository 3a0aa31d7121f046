/* What happens at ports, in order. */
#include <math.h>
#include <string.h>

#include "port_log.h"
#include "tuning.h"

int bg_slides(const int *mode)
{
    return (mode[0] == 0) - (mode[1] == 0);
}

static int rubbed(int before, int now)
{
    return now == before ? -1 : now == 0 ? BG_STICK : before == 0 ? BG_SLIP : BG_CROSS;
}

/* A jump that is crossed is none of its events. */
static int jumped(int before, int now)
{
    return (before == 0) == (now == 0) ? -1 : now == 0 ? BG_SLIDE : BG_LEAVE;
}

/* What a port has done, if it has; switches or friction alone. */
static int happened(const bg_switch *with, int switched, const int *before, const int *now)
{
    const int is_switch = with->kind != BG_RUBS && !with->slides;
    if (is_switch != switched || with->slides < 0)
        return -1;
    if (with->slides)
        return rubbed(bg_slides(before), bg_slides(now));
    if (!switched)
        return with->order ? jumped(*before, *now) : rubbed(*before, *now);
    if (*now == *before)
        return -1;
    const int on = with->on == (*now == 0);
    if (with->machine)
        return on ? BG_ON : -1;
    return with->bound ? (on ? BG_APART : BG_TOUCH) : on ? BG_ON : BG_OFF;
}

/* The impulse that a switch has given; both ways of friction that gives a flow are one. */
static double given_by(const bg_log *log, const bg_switch *with, int port)
{
    if (with->kind == BG_RUBS)
        return 0.0;
    return log->given[port] + (with->slides > 0 ? log->given[port + 1] : 0.0);
}

/* Whether a stop took a shock, which is more than rounding of the largest, and stays as it is. */
static int is_hit(const bg_log *log, const bg_switch *with, int port, const int *mode,
                  double largest)
{
    return with->kind == BG_STOPS && log->before[port] == mode[port]
        && fabs(log->given[port]) > BG_ROUNDING * largest;
}

static double largest_given(const bg_log *log, int ports, const bg_switch *switches)
{
    double largest = 0.0;
    for (int i = 0; i < ports; i++)
        largest = fmax(largest, fabs(given_by(log, switches + i, i)));
    return largest;
}

/* Begins what comes after a mode. */
static void begin_part(bg_log *log, int ports, const int *mode)
{
    memcpy(log->before, mode, sizeof(int) * (size_t)ports);
    memset(log->given, 0, sizeof log->given);
    memset(&log->back, 0, sizeof log->back);
}

void bg_begin_log(bg_log *log, const int *mode)
{
    log->thrown = log->begins = 0;
    begin_part(log, BG_MOST_PORTS, mode);
}

int bg_append(bg_log *log, bg_event event)
{
    if (log->count >= log->capacity)
        return -1;
    if (log->events)
        log->events[log->count] = event;
    log->count++;
    return 0;
}

bg_set bg_hits(const bg_log *log, int ports, const bg_switch *switches, const int *mode)
{
    const double largest = largest_given(log, ports, switches);
    bg_set found = log->back;
    for (int i = 0; i < ports; i++)
        if (is_hit(log, switches + i, i, mode, largest))
            bg_add(&found, i);
    return found;
}

int bg_note(bg_log *log, double t, int ports, const bg_switch *switches, const int *mode)
{
    const double largest = log->begins ? 0.0 : largest_given(log, ports, switches);
    for (int i = 0; i < ports && largest > 0.0; i++)
        if (is_hit(log, switches + i, i, mode, largest)
            && bg_append(log, (bg_event){t, i, BG_HIT, log->given[i]}))
            return -1;
    for (int switched = 1; switched >= 0; switched--)
        for (int i = 0; i < ports; i++) {
            const int kind = happened(switches + i, switched, log->before + i, mode + i);
            if (kind >= 0 && (switches[i].machine || !log->begins)
                && bg_append(log, (bg_event){t, i, kind, given_by(log, switches + i, i)}))
                return -1;
        }
    log->begins = 0;
    begin_part(log, ports, mode);
    return 0;
}
