/* A run that pauses: what of its loop has to be kept to go on from there. */
#ifndef BG_RUN_PAUSED_H
#define BG_RUN_PAUSED_H

#include "run_loop.h"

/* How it goes on: from the present instant as it was decided; or from where that was arrived at, to
 * decide it anew under other inputs, whose numbers are written already. */
enum { BG_GO_ON, BG_GO_ANEW };

/* Where a loop is, but for what the latest look has told. */
typedef struct {
    double t, began, done, time, leapt[BG_MOST_PORTS];
    int begun, decided, mode[BG_MOST_PORTS], touched[BG_MOST_PORTS], lingers[BG_MOST_PORTS];
    bg_rounds rounds;
    bg_crossings crossings;
} bg_kept;

void bg_keep(const bg_course *c, bg_kept *to);

/* Sets out from there, to `end`; s is the caller's, as it was. */
void bg_take_up(bg_course *c, const bg_kept *from, double end, double *s);

/* Numbers written one after the other, to `at` or, if `back`, from there: one order for both ways. */
typedef struct {
    double *at;
    int back;
} bg_carrier;

void bg_carry(bg_carrier *c, double *values, int count);
void bg_carry_kept(bg_carrier *c, bg_kept *kept);
enum {
    BG_KEPT_WIDTH = 8 + BG_STALLED + 8 * BG_MOST_PORTS /* of a loop */
};

#endif
