/* A record of what happens at ports. */
#ifndef BG_PORT_LOG_H
#define BG_PORT_LOG_H

#include "port_events.h"
#include "port_set.h"

/* The first `count` of at most `capacity` events, which are but counted where `events` is NULL. At
 * the present instant: the impulse that each port gives, but for what was told of already, and
 * whether stops throw anything back. */
typedef struct {
    bg_event *events;
    int capacity, count, thrown;
    double given[BG_MOST_PORTS];
} bg_log;

/* Begins an instant. */
void bg_begin_log(bg_log *log);

/* Appends an event; 0, or -1 where there is no room for it. */
int bg_append(bg_log *log, bg_event event);

/* Appends a hit for each stop that took a shock and is as it was, then an event for each of `ports`
 * modes that is not what it was, of switches first, with what these have given; 0, or -1 where
 * there is no room. `switches`: NULL where no port is one. */
int bg_note(bg_log *log, double t, int ports, const bg_switch *switches, const int *before,
            const int *mode);

#endif
