/* What happens at ports, in order. */
#ifndef BG_PORT_EVENTS_H
#define BG_PORT_EVENTS_H

#include "config.h"
#include "port_switch.h"

enum bg_kind {
    BG_STICK,
    BG_SLIP,
    BG_CROSS,
    BG_ON,
    BG_OFF,
    BG_HIT,
    BG_TOUCH,
    BG_APART,
    BG_SLIDE,
    BG_LEAVE,
    BG_CORNER
};

/* `impulse`: of an impact, that of what the port gives. Corners of laws are counted after ports. */
typedef struct {
    double time;
    int port, kind;
    double impulse;
} bg_event;

/* Which way friction slips that gives a flow, by the modes of its ways; 0: it sticks. */
int bg_slides(const int *mode);

#endif
