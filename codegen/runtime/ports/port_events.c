/* What happens at friction ports, in order. */
#include "port_events.h"

int bg_note(bg_event *events, int *count, int capacity, double t, int ports,
            const int *before, const int *mode)
{
    for (int i = 0; i < ports; i++) {
        if (mode[i] == before[i])
            continue;
        if (*count >= capacity)
            return -1;
        const int kind = mode[i] == 0 ? BG_STICK : before[i] == 0 ? BG_SLIP : BG_CROSS;
        events[(*count)++] = (bg_event){t, i, kind};
    }
    return 0;
}
