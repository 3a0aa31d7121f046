/* One stretch: to a breakpoint or the first event, signals recorded at the samples on the way. */
#include "batch_internal.h"

#include <string.h>

/* Where signals go, and the latest sample with its triggers. */
typedef struct {
    batch_table table;
    double row[EX_ROW];
} recording;

/* Takes the state as the sample `p->at`, which is at p->t. */
static int record_signals(void *self, ex_context *c, ex_place *p)
{
    recording *const to = self;
    batch_sample(c->caller, &to->table, p->z, p->at);
    ex_see_places(c, p->z);
    memcpy(to->row, p->z, sizeof p->z);
    ex_fill(&c->stretch, to->row);
    p->base = p->at++;
    return ex_check_levels(c, p->t, to->row);
}

/* A step that leaps could not be sure of. */
static int look_closely(ex_context *c, ex_place *p, batch_leaps *l, double *row)
{
    const ex_entry *const e = c->stretch.entry;
    double end;
    for (int j = 0; j < EX_Z; j++)
        p->z[j] = l->origin[j] + l->beyond[j];
    const int status = ex_series(c, p->t + (double)l->done * e->step, e->step, p->z, &end, &p->ports);
    if (!bg_is_empty(&p->ports))
        p->stop = end;
    if (status || !bg_is_empty(&p->ports))
        return status;
    for (int j = 0; j < EX_Z; j++)
        l->beyond[j] = p->z[j] - l->origin[j];
    l->done++;
    if (l->done % e->parts)
        return BG_OK;
    batch_sample(l->room, &l->table, p->z, p->base + (int)(l->done / e->parts));
    memcpy(row, p->z, sizeof p->z);
    ex_fill(&c->stretch, row);
    return ex_check_levels(c, end, row);
}

/* Leaps over `count` samples of one distance, as far as they reach. */
static int leap_over(void *self, ex_context *c, ex_place *p, int count, double h)
{
    recording *const to = self;
    if (c->stretch.entry->h != h)
        batch_prepare(c, c->caller, &to->table, h);
    const long long parts = c->stretch.entry->parts;
    batch_leaps l = {.room = c->caller, .stretch = &c->stretch, .table = to->table};
    int status = BG_OK;
    batch_begin_leaps(&l, p->z, count * parts);
    while (!status && bg_is_empty(&p->ports) && l.done < l.total) {
        batch_leap(&l, p->base);
        if (l.done < l.total)
            status = look_closely(c, p, &l, to->row);
    }
    const int until = p->at + (int)(l.done / parts);
    p->at = until < p->last ? until : p->last;
    if (status || !bg_is_empty(&p->ports))
        return status;
    for (int j = 0; j < EX_Z; j++)
        p->z[j] = to->row[j] = l.origin[j] + l.beyond[j];
    p->base = p->at - 1;
    p->t = until > p->last ? p->stop : c->task->times[p->base];
    ex_fill(&c->stretch, to->row);
    return BG_OK;
}

int batch_advance(ex_context *c, double stop)
{
    const batch_room *const room = c->caller;
    const double begin = c->run.at.t;
    recording own = {.table = batch_table_of(room, c)};
    const ex_recorder to = {&own, own.row, record_signals, leap_over};
    ex_place p;
    ex_set_out(c, &p, stop);
    batch_show(c, room, &own.table);
    const int status = ex_advance_by(c, stop, &to);
    if (!status && room->job->products)
        batch_integrate(c, room, begin, p.z, c->run.at.t);
    return status;
}
