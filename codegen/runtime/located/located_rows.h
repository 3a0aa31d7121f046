/* Event-located runs whose samples become the rows of a table. */
#ifndef BG_LOCATED_ROWS_H
#define BG_LOCATED_ROWS_H

#include "model_located.h"

/* A row: x, z, u, u', y, the rate of s, external inputs. */
enum {
    BG_ROW_WIDTH = BG_STATES + BG_LAW_STATES + 2 * BG_INPUTS + BG_READINGS + BG_SIZE + BG_EXTERNAL
};

/* The sizes of an instance, a run and a row, in bytes. */
void bg_rows_sizes(unsigned long *sizes);

/* Makes an instance and runs it; `asked` says all but where samples go: to the rows of a table. A
 * status. */
int bg_rows_run(bg_located *c, bg_model *m, const double *parameters, const bg_signals *signals,
                bg_request *asked, double *table);

#endif
