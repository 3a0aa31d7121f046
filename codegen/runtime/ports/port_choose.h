/* Which ports hold and which are let go, and which way these slip: one consistent mode at one
 * instant, of whatever can be looked at in a given mode. */
#ifndef BG_PORT_CHOOSE_H
#define BG_PORT_CHOOSE_H

#include "config.h"
#include "port_log.h"
#include "port_set.h"
#include "port_switch.h"
#include "run_status.h"
#include "tuning.h"

enum {
    BG_MOST_RESETS = BG_RESETS > 0 ? BG_RESETS : 1,
    BG_MOST_CLOCKS = BG_CLOCKS > 0 ? BG_CLOCKS : 1,
};

/* What an instant is to a port: none of its own, its event, or an event that may be long past, as
 * whoever steps the model finds it no better. */
enum { BG_UNTOUCHED, BG_TOUCHED, BG_PASSED };

/* One port at one instant in one mode. `push`: how fast the slip changes; `stay`: what keeps a
 * switch from changing over; `gap`, `back`: of a stop, its restitution the latter; `gap`: what
 * a jump of second order hangs on; `near_..`: below these slip, margin, push, stay and gap count as
 * zero; `unseen`: the part of near_slip that leaps unseen. */
typedef struct {
    double slip, effort, cap, push, stay, gap, back;
    double near_slip, near_effort, near_push, near_stay, near_gap, unseen;
} bg_port;

/* Combinations of the slips of `width` ports, those of `ports` (NULL: the first), by rows. `count`
 * rows that only inputs rule and not what the ports of a mode give: those that stick hold only
 * while all are zero; `kept` of the mix, that the ports stop: friction does not do so at once.
 * `unknown`: the status of a mode of which no more is known than the rows. Valid until the next
 * look. */
typedef struct {
    int width, count, kept, unknown;
    const int *ports;
    const double *rows, *mix;
} bg_ruling;

/* An instant: the shortest time constant there, and the inputs' next breakpoint; `log`: where to
 * tell of impacts, or NULL; `lingers`: jumps of second order whose swings hardly shrink, and
 * `leapt`: how high any of those has leapt between two crossings. */
typedef struct {
    double t, time, following;
    double *s;
    int touched[BG_MOST_PORTS];
    bg_log *log;
    int lingers[BG_MOST_PORTS];
    double leapt[BG_MOST_PORTS];
} bg_instant;

/* An impact: whether there is one; what each port gives; 1 where that goes with its switch's mode,
 * -1 where against it, else 0. `near`: where speeds are wanted, below these slips after it are
 * rounding. */
typedef struct {
    int struck, shocks[BG_MOST_PORTS];
    double given[BG_MOST_PORTS], near[BG_MOST_PORTS];
} bg_blow;

/* What can be looked at; `coupled`: whether a port's slip depends at once on friction. `look`
 * evaluates everything at t, s in a mode and leaves the rate of s in `rate`; its status tells why
 * the mode is none, or ends the search. `tell` tells of the latest look: of every port what there
 * is and, unless `at` is NULL, what counts as zero there; and unless that is NULL of the ruling,
 * which comes with no rows. `strike` puts s, which is that of `at` before, to what it is once the
 * switches of a mode hold, by an impact if more than rounding has to stop; or, unless `speeds` is
 * NULL, by one after which those have these slips. `couple` tells of each port that is held in a
 * mode which ports it touches: those that its effort moves at once or accelerates, and those with
 * which it has part in what none of them rules alone; its status tells that this is not known. */
typedef struct {
    void *self;
    int size, ports;
    const bg_switch *switches; /* NULL where no port is one */
    const bg_switch *kinds;    /* the same of every model */
    int stopping;              /* whether any is a stop */
    const int *coupled;
    const double *rate;
    double *point, *struck; /* room for s, twice */
    int (*look)(void *self, double t, const double *s, const int *mode);
    void (*tell)(void *self, const int *mode, const bg_instant *at, bg_port *ports,
                 bg_ruling *ruling);
    int (*strike)(void *self, const bg_instant *at, const int *mode, const double *speeds,
                  double *s, bg_blow *blow);
    int (*couple)(void *self, const int *mode, bg_set *touched);
    int resets;
    const bg_reset *reset;
    /* What s becomes at the place of each reset, in a mode that can be looked at. */
    int (*become)(void *self, const bg_instant *at, const int *mode, double *values);
    const bg_clock *clocks;
} bg_sight;

/* port_reset.c: from the mode so far to the one just after the instant: 0 sticks or is held, 1
 * slips forwards or is let go, -1 backwards; s of the instant becomes what it is after an impact.
 * Ports at rest, or so close that it is an event's own rounding, stick if they can; switches stay
 * as long as nothing contradicts it. Where there is a log, resets set states, and the mode is
 * decided anew. A status: where no mode is consistent BG_UNDECIDED or, if none could be looked at,
 * that of the first. */
int bg_choose(const bg_sight *sight, const bg_instant *at, int *mode);

/* port_reset.c: sets what the tasks that are due set, all by what is before; a status. */
int bg_set_by_tasks(const bg_sight *sight, const bg_instant *at, const int *mode, const int *due);

/* What to try where a mode cannot be evaluated, by number: slipping as it does, the same backwards
 * where it sticks, the mode, of few ports the ways of slipping, all stuck; 0 where there are no
 * more. */
enum { BG_TRIES = 4 + (1 << 10) };
int bg_try(int ports, int number, const int *mode, int *tried);

/* Looks at a mode that can be: that of `mode`, or if `slipping` one that slips as it does; else any
 * other way of slipping, or all stuck. A status: that of the first if there is none. */
int bg_evaluated(const bg_sight *sight, const bg_instant *at, int slipping, int *mode);

/* Whether a status says nothing about the mode: it is a refusal, or asks for something. */
int bg_ends_search(int status);

#endif
