/* Event-located runs whose samples become the rows of a table. */
#ifndef BG_LOCATED_ROWS_H
#define BG_LOCATED_ROWS_H

#include "model_located.h"

/* A row: what is kept of a sample, part by part, and the modes of the ports. */
#define BG_WIDTH(part, count) +(count)
enum { BG_ROW_WIDTH = BG_RECORDED(BG_WIDTH, BG_WIDTH) + BG_FRICTION };

/* Writes one. */
void bg_row_put(double *row, const double *w, const int *mode, const bg_snapshot *shot);

/* The sizes of an instance, a run and a row, in bytes. */
void bg_rows_sizes(unsigned long *sizes);

/* Where rows go, of which there is room for all, or for `room`: then `full` takes the first of them, or
 * the first events, and what follows comes to where these were; none of either now and then, so that
 * it can tell to stop. Not 0: it cannot. `taken`, `failed`, `steps` and `handed`, whether
 * anything was, are of whoever runs. */
typedef struct {
    double *table;
    int room, taken, failed, steps, handed;
    int (*full)(void *self, int samples, int events);
    void *self;
} bg_rows;

/* Lets a run's samples go there. */
void bg_rows_ask(bg_request *asked, bg_rows *rows);

/* Makes an instance and runs it; `asked` says all but where samples go. A status. */
int bg_rows_run(bg_located *c, bg_model *m, const double *parameters, const bg_signals *signals,
                bg_request *asked, bg_rows *rows);

#endif
