/* One stretch: to a breakpoint or the first event, signals recorded at the samples on the way. */
#include "batch_internal.h"

#include <string.h>

/* Records the state as the sample `p->at`, which is at p->t; its triggers go to `row`. */
static int record_signals(ex_context *c, const batch_table *table, ex_place *p, double *row)
{
    batch_sample(c->caller, table, p->z, p->at);
    memcpy(row, p->z, sizeof p->z);
    ex_fill(&c->stretch, row);
    p->base = p->at++;
    return ex_check_levels(c, p->t, row);
}

/* A step that leaps could not be sure of. */
static int look_closely(ex_context *c, ex_place *p, batch_leaps *l, double *row)
{
    const ex_entry *const e = c->stretch.entry;
    double end;
    for (int j = 0; j < EX_Z; j++)
        p->z[j] = l->origin[j] + l->beyond[j];
    const int status = ex_series(c, p->t + (double)l->done * e->step, e->step, p->z, &end, &p->ports);
    if (p->ports)
        p->stop = end;
    if (status || p->ports)
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
static int leap_over(ex_context *c, const batch_table *table, ex_place *p, int count, double *row)
{
    const long long parts = c->stretch.entry->parts;
    batch_leaps l = {.room = c->caller, .stretch = &c->stretch, .table = *table};
    int status = BG_OK;
    batch_begin_leaps(&l, p->z, count * parts);
    while (!status && !p->ports && l.done < l.total) {
        batch_leap(&l, p->base);
        if (l.done < l.total)
            status = look_closely(c, p, &l, row);
    }
    const int until = p->at + (int)(l.done / parts);
    p->at = until < p->last ? until : p->last;
    if (status || p->ports)
        return status;
    for (int j = 0; j < EX_Z; j++)
        p->z[j] = row[j] = l.origin[j] + l.beyond[j];
    p->base = p->at - 1;
    p->t = until > p->last ? p->stop : c->task->times[p->base];
    ex_fill(&c->stretch, row);
    return BG_OK;
}

/* One step by power series, to the next sample or the stop. */
static int step_over(ex_context *c, const batch_table *table, ex_place *p, double *row)
{
    const int sample = p->at < p->last;
    const double to = sample ? c->task->times[p->at] : p->stop;
    double end;
    const int status = ex_series(c, p->t, to - p->t, p->z, &end, &p->ports);
    if (p->ports)
        p->stop = end;
    if (status || p->ports)
        return status;
    p->t = to;
    p->base = -1;
    return sample ? record_signals(c, table, p, row) : BG_OK;
}

int batch_advance(ex_context *c, double stop)
{
    const batch_table table = batch_table_of(c->caller, c);
    const batch_room *const room = c->caller;
    const double begin = c->run.at.t;
    double row[EX_ROW], z[EX_Z];
    ex_place p;
    int status = BG_OK;
    ex_set_out(c, &p, stop);
    memcpy(z, p.z, sizeof z);
    batch_show(c, c->caller, &table);
    while (!status && !p.ports && (p.t < stop || p.at < p.last)) {
        double h = 0.0;
        const int count = p.base >= 0 ? ex_alike(c, &p, &h) : 0;
        if (count >= EX_STRIDE && ex_armed(c, row)) {
            if (c->stretch.entry->h != h)
                batch_prepare(c, c->caller, &table, h);
            status = leap_over(c, &table, &p, count, row);
        } else {
            status = step_over(c, &table, &p, row);
        }
    }
    ex_arrive(c, &p);
    if (!status && room->job->products)
        batch_integrate(c, room, begin, z, c->run.at.t);
    return status;
}
