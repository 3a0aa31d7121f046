#include "located_rows.h"

/* So many steps are taken before it is asked whether to go on. */
enum { BG_STEPS_UNASKED = 4096 };

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
    bg_rows *const rows = to;
    if (rows->full && sample - rows->taken >= rows->room) {
        rows->failed = rows->failed || rows->full(rows->self, rows->room, 0);
        rows->taken += rows->room;
        rows->handed = 1;
    }
    bg_row_put(rows->table + (size_t)(sample - rows->taken) * BG_ROW_WIDTH, w, mode, shot);
}

/* After a step: whether all that had to be was taken; events are, too. */
static int take_events(void *to, void *run)
{
    bg_rows *const rows = to;
    bg_log *const log = &((bg_located *)run)->run.log;
    log->emptied = 1;
    if (log->events && log->count >= log->capacity / 2) {
        const bg_request *const asked = ((bg_located *)run)->asked;
        rows->failed = rows->failed || rows->full(rows->self, 0, log->count);
        rows->handed = 1;
        log->count = 0;
        log->events = asked->events;
        log->capacity = asked->capacity;
    }
    if (++rows->steps >= BG_STEPS_UNASKED) {
        rows->failed = rows->failed || rows->full(rows->self, 0, 0);
        rows->steps = 0;
        if (!log->events)
            log->count = 0; /* they would be counted beyond all numbers */
    }
    return rows->failed ? BG_UNTAKEN : BG_OK;
}

void bg_rows_sizes(unsigned long *sizes)
{
    sizes[0] = (unsigned long)sizeof(bg_model);
    sizes[1] = (unsigned long)sizeof(bg_located);
    sizes[2] = (unsigned long)(BG_ROW_WIDTH * sizeof(double));
}

void bg_rows_ask(bg_request *asked, bg_rows *rows)
{
    asked->to = rows;
    asked->record = put_row;
    asked->passed = rows->full ? take_events : 0;
    rows->taken = rows->failed = rows->steps = rows->handed = 0;
}

int bg_rows_run(bg_located *c, bg_model *m, const double *parameters, const bg_signals *signals,
                bg_request *asked, bg_rows *rows)
{
    int status = bg_model_init(m, parameters);
    bg_rows_ask(asked, rows);
    if (status == BG_OK)
        status = bg_model_run(c, m, signals, asked);
    return status == BG_OK && rows->failed ? BG_UNTAKEN : status;
}
