#include "located_rows.h"

void bg_row_put(double *row, const double *w, const int *mode, const bg_snapshot *shot)
{
#define SHOWN(part, count) row = bg_put(row, count, shot->part);
#define GIVEN(part, count) row = bg_put(row, count, part);
    BG_RECORDED(SHOWN, GIVEN)
#undef SHOWN
#undef GIVEN
    for (int i = 0; i < BG_FRICTION; i++)
        row[i] = mode[i];
}

static void put_row(void *to, int sample, const double *w, const int *mode, const bg_snapshot *shot)
{
    bg_row_put((double *)to + (size_t)sample * BG_ROW_WIDTH, w, mode, shot);
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
    asked->record = put_row;
    return status == BG_OK ? bg_model_run(c, m, signals, asked) : status;
}
