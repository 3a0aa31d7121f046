/* One stretch: to a breakpoint or the first event, recording the samples on the way. */
#include "exact_internal.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* The first sample that is not before a time, which is not far as a rule. */
static int first_not_before(const ex_task *task, int low, double stop)
{
    int high = low;
    for (int reach = 1; high < task->samples && task->times[high] < stop; reach *= 2) {
        low = high + 1;
        high = reach < task->samples - high ? high + reach : task->samples;
    }
    while (low < high) {
        const int middle = low + (high - low) / 2;
        if (task->times[middle] < stop)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Refuses a friction level below zero: a rough look at a sample, an exact one where it may be. */
int ex_check_levels(ex_context *c, double t, double *row)
{
    int below = 0;
    for (int i = 0; i < EX_K; i++) {
        const double *pair = row + EX_Z + 2 * i;
        const int single = ex_single(c, c->stretch.entry->mode, i);
        below |= (single ? 2.0 * pair[1] : pair[0] + pair[1]) < 0.0
            || ex_rests(c->stretch.entry->mode, i);
    }
    if (!below)
        return BG_OK;
    ex_shot shot;
    return ex_look(c, t, row, c->stretch.entry->mode, shot);
}

/* Writes the state as the sample `p->at`, which is at p->t. */
static int record(void *self, ex_context *c, ex_place *p)
{
    (void)self;
    const int status = ex_make_room(c, p->at);
    if (status)
        return status;
    double *row = ex_row_of(c, p->at);
    memcpy(row, p->z, sizeof p->z);
    ex_see_places(c, row);
    ex_fill(&c->stretch, row);
    *ex_mode_of(c, p->at) = c->stretch.entry->place;
    p->base = p->at++;
    return ex_check_levels(c, p->t, row);
}

/* How many steps from the present sample on have one length, but for rounding; the stop, too. */
static int alike(const ex_context *c, const ex_place *p, double *h)
{
    const double *times = c->task->times;
    int end = p->last;
    *h = c->task->grid;
    if (*h <= 0.0) {
        *h = p->at < p->last ? times[p->at] - p->t : 0.0;
        for (end = p->at; end < p->last; end++)
            if (fabs(times[end] - times[end - 1] - *h) > BG_ALIKE * *h)
                break;
    }
    if (end == p->last && fabs(p->stop - times[end - 1] - *h) <= BG_ALIKE * *h)
        end++;
    return end - p->at;
}

/* Whether all triggers are armed; those are that have risen above rounding. */
static int armed(ex_context *c, const double *row)
{
    int all = 1;
    for (int i = 0; i < EX_T; i++) {
        c->stretch.armed[i] |= row[EX_Z + i] >= c->stretch.limit[i];
        all &= c->stretch.armed[i];
    }
    return all;
}

/* Keeps those of `count` steps in scratch that are samples; `done` were there before. */
static void keep_samples(const ex_context *c, const ex_place *p, long long done, int count)
{
    const long long parts = c->stretch.entry->parts;
    for (long long k = parts - done % parts; k <= count; k += parts)
        memcpy(ex_row_of(c, p->base + (int)((done + k) / parts)), c->scratch[k], sizeof c->scratch[k]);
}

/* A step that leaps could not be sure of; its end is written to `next`. */
static int doubtful(ex_context *c, ex_place *p, long long done, double *next)
{
    const ex_entry *e = c->stretch.entry;
    double end;
    const int status = ex_series(c, p->t + (double)done * e->step, e->step, p->z, &end, &p->ports);
    if (status || !bg_is_empty(&p->ports)) {
        p->stop = end;
        return status;
    }
    memcpy(next, p->z, sizeof p->z);
    ex_fill(&c->stretch, next);
    return (done + 1) % e->parts ? BG_OK : ex_check_levels(c, end, next);
}

/* `count` samples by leaps of steps from sample `base`; how many steps there were goes to *done. */
static int steps(ex_context *c, ex_place *p, int count, long long *done)
{
    const long long parts = c->stretch.entry->parts, total = count * parts;
    *done = 0;
    if (parts > 1)
        memcpy(c->scratch[0], ex_row_of(c, p->base), sizeof c->scratch[0]);
    while (*done < total) {
        const long long left = total - *done;
        const int ahead = parts > 1 && left > EX_BLOCK ? EX_BLOCK : (int)left;
        double(*rows)[EX_ROW] = parts > 1 ? c->scratch : c->task->rows + (p->base - c->taken + *done);
        int sure = ex_leap(&c->stretch, ahead, rows);
        if (parts > 1)
            keep_samples(c, p, *done, sure);
        *done += sure;
        memcpy(p->z, rows[sure], sizeof p->z);
        if (sure < ahead) {
            const int status = doubtful(c, p, *done, rows[++sure]);
            if (status || !bg_is_empty(&p->ports))
                return status;
            if (parts > 1 && ++*done % parts == 0)
                memcpy(ex_row_of(c, p->base + (int)(*done / parts)), rows[sure], sizeof rows[sure]);
            else
                *done += parts == 1;
        }
        if (parts > 1)
            memcpy(c->scratch[0], rows[sure], sizeof c->scratch[0]);
    }
    return BG_OK;
}

/* Leaps over samples of one distance, as far as they reach. */
static int leap_on(void *self, ex_context *c, ex_place *p, int count, double h)
{
    (void)self;
    long long done;
    int status = ex_make_room(c, p->at);
    if (status)
        return status;
    if (!c->stretch.leaping || c->stretch.entry->h != h) {
        ex_leaps(c, &c->stretch, h, ex_row_of(c, p->base));
        ex_fill(&c->stretch, ex_row_of(c, p->base));
    }
    const int room = ex_room(c, p->at);
    status = steps(c, p, count < room ? count : room, &done);
    const int until = p->at + (int)(done / c->stretch.entry->parts);
    for (; p->at < until && p->at < p->last; p->at++) {
        *ex_mode_of(c, p->at) = c->stretch.entry->place;
        ex_see_places(c, ex_row_of(c, p->at));
    }
    if (status || !bg_is_empty(&p->ports))
        return status;
    p->base = p->at - 1;
    p->t = until > p->last ? p->stop : c->task->times[p->base];
    return BG_OK;
}

/* One step by power series, to the next sample or the stop. */
static int step_on(ex_context *c, ex_place *p, const ex_recorder *to)
{
    const int sample = p->at < p->last;
    const double next = sample ? c->task->times[p->at] : p->stop;
    double end;
    const int status = ex_series(c, p->t, next - p->t, p->z, &end, &p->ports);
    if (!bg_is_empty(&p->ports))
        p->stop = end;
    if (status || !bg_is_empty(&p->ports))
        return status;
    p->t = next;
    p->base = -1;
    return sample ? to->record(to->self, c, p) : BG_OK;
}

/* Whether leaps in an entry are worth their tables; told anew in each run, which so is the same
 * whatever was before. */
static int repays(const ex_context *c)
{
    ex_entry *const e = c->stretch.entry;
    if (e->walking != c->runs)
        e->walked = 0;
    e->walking = c->runs;
    return e->walked >= EX_WALKED || ++e->walked > EX_WALKED;
}

void ex_set_out(ex_context *c, ex_place *p, double stop)
{
    p->t = c->run.at.t;
    p->stop = stop;
    p->at = c->next;
    p->base = -1;
    memset(&p->ports, 0, sizeof p->ports);
    p->last = c->stretch.foreseen ? p->at : first_not_before(c->task, c->next, stop);
    memcpy(p->z, c->s, sizeof c->s);
    ex_know(c, p->t);
    memcpy(p->z + EX_N, c->slots, sizeof c->slots);
}

/* Where a switch changes over a rounding after a sample, that shows the instant just after, too. */
static double back_to_sample(const ex_context *c, ex_place *p)
{
    int switched = 0;
    for (int i = 0; i < EX_K; i++)
        switched |= bg_has(&p->ports, i) && ex_switches(c, i);
    if (!switched || p->at <= c->next)
        return p->stop;
    const double last = c->task->times[p->at - 1];
    if (!ex_shows_after(c, last, p->stop))
        return p->stop;
    p->at--;
    return last;
}

void ex_arrive(ex_context *c, ex_place *p)
{
    const double t = back_to_sample(c, p);
    c->next = p->at;
    memcpy(c->s, p->z, sizeof c->s);
    c->run.at.t = t;
    for (int i = 0; i < EX_K; i++)
        c->run.at.touched[i] = bg_has(&p->ports, i);
}

int ex_advance_by(ex_context *c, double stop, const ex_recorder *to)
{
    ex_place p;
    int status = BG_OK;
    ex_set_out(c, &p, stop);
    if (c->stretch.foreseen)
        status = ex_go_ahead(c, &p, to);
    while (!c->stretch.foreseen && !status && bg_is_empty(&p.ports)
           && (p.t < stop || p.at < p.last)) {
        double h = 0.0;
        const int count = p.base >= 0 ? alike(c, &p, &h) : 0;
        if (count >= EX_STRIDE && armed(c, to->row ? to->row : ex_row_of(c, p.base))
            && repays(c))
            status = to->leap(to->self, c, &p, count, h);
        else
            status = step_on(c, &p, to);
    }
    ex_arrive(c, &p);
    return status;
}

int ex_advance(ex_context *c, double stop)
{
    const ex_recorder rows = {NULL, NULL, record, leap_on};
    const int status = ex_make_room_for_events(c);
    if (status)
        return status;
    if (EX_K == 0 && c->stretch.entry->norm * (stop - c->run.at.t) > BG_ROUNDED)
        return ex_free(c, stop);
    return ex_advance_by(c, stop, &rows);
}
