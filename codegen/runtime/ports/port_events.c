/* What happens at ports, in order. */
#include "port_events.h"

#include <stddef.h>

/* What a port has done, if it has; switches or friction alone. */
static int happened(const bg_switch *with, int switched, int before, int now)
{
    const int is_switch = with != NULL && with->kind != BG_RUBS;
    if (now == before || is_switch != switched)
        return -1;
    if (switched)
        return with->on == (now == 0) ? BG_ON : BG_OFF;
    return now == 0 ? BG_STICK : before == 0 ? BG_SLIP : BG_CROSS;
}

int bg_note(bg_event *events, int *count, int capacity, double t, int ports,
            const bg_switch *switches, const int *before, const int *mode)
{
    for (int switched = switches != NULL; switched >= 0; switched--)
        for (int i = 0; i < ports; i++) {
            const int kind =
                happened(switches ? switches + i : NULL, switched, before[i], mode[i]);
            if (kind < 0)
                continue;
            if (*count >= capacity)
                return -1;
            if (events)
                events[*count] = (bg_event){t, i, kind};
            ++*count;
        }
    return 0;
}
