/* What happens at ports, in order. */
#ifndef BG_PORT_EVENTS_H
#define BG_PORT_EVENTS_H

#include "config.h"
#include "port_switch.h"

enum bg_kind { BG_STICK, BG_SLIP, BG_CROSS, BG_ON, BG_OFF };

typedef struct {
    double time;
    int port, kind;
} bg_event;

/* Which way friction slips that gives a flow, by the modes of its ways; 0: it sticks. */
int bg_slides(const int *mode);

/* Appends an event for each of `ports` modes that is not what it was, of switches first; 0, or -1
 * where the events have no room for it; where they are NULL they are but counted. `switches`: NULL
 * where no port is one. */
int bg_note(bg_event *events, int *count, int capacity, double t, int ports,
            const bg_switch *switches, const int *before, const int *mode);

#endif
