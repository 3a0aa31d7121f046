/* Rows and events of a run that are taken while it goes on. */
#include "exact_internal.h"

#include <limits.h>
#include <string.h>

/* So many stretches are taken before it is asked whether to go on. */
enum { EX_UNASKED = 4096 };

int ex_room(const ex_context *c, int sample)
{
    return c->task->full ? c->task->room - (sample - c->taken) : INT_MAX;
}

int ex_make_room(ex_context *c, int sample)
{
    const ex_task *const task = c->task;
    const int count = sample - c->taken - 1;
    if (ex_room(c, sample) > 0)
        return BG_OK;
    if (task->full(task->self, count, 0))
        return BG_UNTAKEN;
    memcpy(task->rows[0], task->rows[count], sizeof task->rows[0]);
    task->modes[0] = task->modes[count];
    c->taken += count;
    return BG_OK;
}

int ex_make_room_for_events(ex_context *c)
{
    const ex_task *const task = c->task;
    bg_log *const log = &c->run.log;
    if (!task->full)
        return BG_OK;
    c->unasked++;
    if ((!log->events || log->count < log->capacity / 2) && c->unasked < EX_UNASKED)
        return BG_OK;
    c->unasked = 0;
    if (task->full(task->self, 0, log->events ? log->count : 0))
        return BG_UNTAKEN;
    log->count = 0; /* those that are not kept would be counted beyond all numbers */
    log->events = task->events;
    log->capacity = task->capacity;
    return BG_OK;
}
