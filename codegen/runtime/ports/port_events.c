/* What happens at ports, in order. */
#include "port_events.h"

#include <stddef.h>

int bg_slides(const int *mode)
{
    return (mode[0] == 0) - (mode[1] == 0);
}

static int rubbed(int before, int now)
{
    return now == before ? -1 : now == 0 ? BG_STICK : before == 0 ? BG_SLIP : BG_CROSS;
}

/* What a port has done, if it has; switches or friction alone. */
static int happened(const bg_switch *with, int switched, const int *before, const int *now)
{
    const int is_switch = with != NULL && with->kind != BG_RUBS && !with->slides;
    if (is_switch != switched || (with != NULL && with->slides < 0))
        return -1;
    if (with != NULL && with->slides)
        return rubbed(bg_slides(before), bg_slides(now));
    if (!switched || *now == *before)
        return switched ? -1 : rubbed(*before, *now);
    return with->on == (*now == 0) ? BG_ON : BG_OFF;
}

int bg_note(bg_event *events, int *count, int capacity, double t, int ports,
            const bg_switch *switches, const int *before, const int *mode)
{
    for (int switched = switches != NULL; switched >= 0; switched--)
        for (int i = 0; i < ports; i++) {
            const int kind =
                happened(switches ? switches + i : NULL, switched, before + i, mode + i);
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
