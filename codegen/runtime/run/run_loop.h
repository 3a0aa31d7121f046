/* The event-driven loop: stretches between breakpoints, sticking, release and zero crossings; of
 * whatever can be looked at and advanced. */
#ifndef BG_RUN_LOOP_H
#define BG_RUN_LOOP_H

#include "port_choose.h"
#include "port_events.h"
#include "run_pace.h"

/* Where a run is. `began`, `end` [s]: of all of it; `span`: the pieces of its inputs;
 * `goes_on`: whether it goes on with one before, so that its begin may have events; `started`,
 * `decided`: whether its first instant has been decided, and the present one; `paused`: whether it
 * came to the present one as to its end; `excused`: whether the mode there is none that could go
 * on. `done` [s]: up to when tasks have set what they set; `due`: those whose instant it is. */
typedef struct {
    bg_instant at;
    double began, end;
    bg_span span;
    int goes_on, started, decided, paused, excused;
    double done;
    int due[BG_MOST_CLOCKS];
    int mode[BG_MOST_PORTS];
    bg_log log;
    bg_rounds rounds;
    bg_crossings crossings;
} bg_course;

/* What runs. `pass` tells the pieces of the inputs at t and just after; `see` takes the instant,
 * which was looked at with friction slipping so, into what rounding is relative to; `fastest` tells
 * the largest rate [1/s] there in the mode so far; `choose` decides the mode there as bg_choose
 * does, NULL where that is to do it; `rest` takes the slips of ports that stick away; `advance`
 * goes on to `stop` or the first event, whose ports it tells in `touched`. All but `see` give a
 * status. */
typedef struct {
    bg_sight sight;
    void *self;
    int (*pass)(void *self, double t, bg_span *span);
    void (*see)(void *self, const int *slipping);
    int (*fastest)(void *self, double *fastest);
    int (*choose)(void *self, const bg_sight *sight);
    int (*rest)(void *self);
    int (*advance)(void *self, double stop);
} bg_engine;

/* Sets out at t, with BG_MOST_PORTS modes as they are before, all let go unless told; and runs to
 * the end: arrives there, and decides what is just after it. */
void bg_set_out(bg_course *c, double t, double end, double *s, const int *first);
int bg_arrive(const bg_engine *engine, bg_course *c);
int bg_finish(const bg_engine *engine, bg_course *c);
int bg_run(const bg_engine *engine, bg_course *c);

/* How often a run may go on: events are followed as long as there may be more. */
double bg_most_turns(const bg_log *log);

#endif
