#include "located_rows.h"

#include <string.h>

static double *put(double *to, int count, const double *from)
{
    memcpy(to, from, sizeof(double) * (size_t)count);
    return to + count;
}

static void record(void *to, int sample, const double *w, const int *mode, const bg_snapshot *shot)
{
    double *row = (double *)to + (size_t)sample * BG_ROW_WIDTH;
    (void)mode;
    row = put(row, BG_STATES, shot->x);
    row = put(row, BG_LAW_STATES, shot->z);
    row = put(row, BG_INPUTS, shot->u);
    row = put(row, BG_INPUTS, shot->du);
    row = put(row, BG_READINGS, shot->y);
    row = put(row, BG_SIZE, shot->rate);
    put(row, BG_EXTERNAL, w);
}

void bg_rows_sizes(unsigned long *sizes)
{
    sizes[0] = (unsigned long)sizeof(bg_model);
    sizes[1] = (unsigned long)sizeof(bg_located);
    sizes[2] = (unsigned long)(BG_ROW_WIDTH * sizeof(double));
}

int bg_rows_run(bg_located *c, bg_model *m, const double *parameters, const bg_signals *signals,
                bg_request *asked, double *table)
{
    const int status = bg_model_init(m, parameters);
    asked->to = table;
    asked->record = record;
    return status == BG_OK ? bg_model_run(c, m, signals, asked) : status;
}
