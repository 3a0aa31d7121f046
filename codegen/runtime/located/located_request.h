/* What an event-located run is asked, and what it tells. */
#ifndef BG_LOCATED_REQUEST_H
#define BG_LOCATED_REQUEST_H

#include "port_events.h"
#include "model_signals.h"

/* How to integrate: BG_AUTO takes the implicit method where time constants are much shorter than
 * the run. */
enum bg_method { BG_AUTO, BG_DOP853, BG_RADAU };

/* What a run is asked. `times`: samples, increasing, the first where the run begins; `states` are
 * those there, law states last. `record` is called for each sample in turn, with the instant just
 * after it if it is an event's. `smooth`, if there is one, is called for the part of each step that
 * is kept, with the run, and `passed` after each step; they give a status. The run tells `count`
 * events and `time`, where it ended. */
typedef struct {
    const double *times, *states;
    int samples, method;
    double rtol, atol;
    void *to;
    void (*record)(void *to, int sample, const double *w, const int *mode,
                   const bg_snapshot *shot);
    bg_event *events;
    int capacity, count;
    double time;
    int (*smooth)(void *to, void *run, double begin, double end);
    const int *first; /* a mode for each port before the run; NULL: all switches are off */
    const int *named; /* whether each state is kept as it is; NULL: all are */
    double *moved;    /* NULL, or for what each state gains as the start is completed */
    int corners;      /* whether those of laws are events, too */
    int (*passed)(void *to, void *run);
} bg_request;

#endif
