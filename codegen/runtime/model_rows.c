#include "model_rows.h"

#include <string.h>

static double *put(double *to, int count, const double *from)
{
    memcpy(to, from, sizeof(double) * (size_t)count);
    return to + count;
}

static void record(void *to, int sample, const double *w, const int *mode, const bg_snapshot *shot)
{
    const bg_rows *const rows = to;
    double *row = rows->table + (size_t)sample * BG_ROW_WIDTH;
    row = put(row, BG_STATES, shot->x);
    row = put(row, BG_LAW_STATES, shot->z);
    row = put(row, BG_INPUTS, shot->u);
    row = put(row, BG_INPUTS, shot->du);
    row = put(row, BG_READINGS, shot->y);
    row = put(row, BG_SIZE, shot->rate);
    put(row, BG_EXTERNAL, w);
    for (int i = 0; i < BG_FRICTION; i++)
        rows->modes[(size_t)sample * BG_FRICTION + i] = mode[i];
}

void bg_rows_sizes(unsigned long *sizes)
{
    sizes[0] = (unsigned long)sizeof(bg_model);
    sizes[1] = (unsigned long)sizeof(bg_located);
    sizes[2] = (unsigned long)(BG_ROW_WIDTH * sizeof(double));
}

int bg_rows_run(bg_located *c, bg_model *m, const double *parameters, const bg_signals *signals,
                bg_request *asked, bg_rows *rows)
{
    const int status = bg_model_init(m, parameters);
    asked->to = rows;
    asked->record = record;
    return status == BG_OK ? bg_model_run(c, m, signals, asked) : status;
}
