/* A record of what happens at ports. */
#ifndef BG_PORT_LOG_H
#define BG_PORT_LOG_H

#include "port_events.h"
#include "port_set.h"

/* The first `count` of at most `capacity` events, which are but counted where `events` is NULL. At
 * the present instant: the mode before what is not told of yet, the impulse that each port gives in
 * that, which stops throw back, and whether any has at this instant; `begins`: whether a run begins
 * with that, which is no event but of state machines; `emptied`: whether events are taken on the
 * way, so that there may be any number of them. */
typedef struct {
    bg_event *events;
    int capacity, count, thrown, begins, emptied;
    int before[BG_MOST_PORTS];
    double given[BG_MOST_PORTS];
    bg_set back;
} bg_log;

/* Begins an instant in a mode. */
void bg_begin_log(bg_log *log, const int *mode);

/* Appends an event; 0, or -1 where there is no room for it. */
int bg_append(bg_log *log, bg_event event);

/* The stops that threw back, or took a shock and are as they were. */
bg_set bg_hits(const bg_log *log, int ports, const bg_switch *switches, const int *mode);

/* Appends a hit for each stop that took a shock and is as it was, then an event for each of `ports`
 * modes that is not what it was, of switches first, with what these have given; 0, or -1 where
 * there is no room. The present mode is that before what comes then. As a run begins transitions
 * alone are told. */
int bg_note(bg_log *log, double t, int ports, const bg_switch *switches, const int *mode);

#endif
