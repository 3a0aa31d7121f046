/* What happens at friction ports, in order. */
#ifndef BG_PORT_EVENTS_H
#define BG_PORT_EVENTS_H

#include "config.h"

enum bg_kind { BG_STICK, BG_SLIP, BG_CROSS };

typedef struct {
    double time;
    int port, kind;
} bg_event;

/* Appends an event for each of `ports` modes that is not what it was; 0, or -1 where the events
 * have no room for it. */
int bg_note(bg_event *events, int *count, int capacity, double t, int ports,
            const int *before, const int *mode);

#endif
