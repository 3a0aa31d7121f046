/* Where a stretch that recurs will end, and its samples. */
#include "exact_internal.h"

#include <math.h>
#include <string.h>

/* Whether nothing but what ends it can happen in a stride: triggers that the state moves differ from
 * straight lines by what bounds allow. */
static int is_foreseen(const ex_entry *e, const ex_ends *to)
{
    int sure = 1;
    for (int i = 0; i < EX_T; i++) {
        const double least = bg_lesser(to->begins[i], to->value[i]) - to->bend[i];
        const int timed = e->moves[i] == EX_TIMED && !e->cap[i];
        sure &= timed || least > 0.0 || (e->cap[i] && e->moves[i] == EX_STILL && least >= 0.0);
    }
    return sure;
}

/* How much later than told the first of its ports falls to zero; 0 at *alike where they differ. */
static double how_late(const ex_stride *k, const ex_ends *to, int *alike)
{
    double first = 0.0, last = 0.0;
    int any = 0;
    for (int i = 0; i < EX_K; i++) {
        if (!bg_has(&k->ports, i))
            continue;
        const double off = -to->value[2 * i] / to->slope[2 * i];
        first = any ? bg_lesser(first, off) : off;
        last = any ? bg_greater(last, off) : off;
        any = 1;
    }
    const double most = BG_ALIKE * k->h;
    *alike = last - first <= most && fabs(first) <= most && fabs(last) <= most;
    return first;
}

/* Whether more samples lie inside than are worth a series each. */
static int has_many(const ex_context *c, double end)
{
    const int far = c->next + EX_FEW;
    return far < c->task->samples && c->task->times[far] < end;
}

int ex_foresee(ex_context *c, double stop)
{
    ex_stretch *const stretch = &c->stretch;
    const double t = c->run.at.t;
    double z[EX_Z];
    ex_ends to;
    int alike = 1;
    stretch->foreseen = 0;
    if (!stretch->entry->foreseeable)
        return 0;
    memcpy(z, c->s, sizeof c->s);
    ex_know(c, t);
    memcpy(z + EX_N, c->slots, sizeof c->slots);
    ex_stride *const k = ex_known(c, z, stop);
    if (!k || has_many(c, t + k->h))
        return 0;
    const int told = bg_is_empty(&k->ports);
    ex_ends_of(stretch, k, z, &to);
    const double off = told ? stop - t - k->h : how_late(k, &to, &alike);
    if (!alike || !is_foreseen(stretch->entry, &to))
        return 0;
    for (int j = 0; j < EX_Z; j++)
        stretch->ahead.z[j] = to.z[j] + off * to.rates[j];
    stretch->ahead.end = told ? stop : t + (k->h + off);
    stretch->ahead.ports = k->ports;
    return stretch->foreseen = 1;
}

int ex_shows_after(const ex_context *c, double sample, double stop)
{
    const double begin = c->run.at.t;
    return sample > begin && stop - sample <= BG_TOGETHER * bg_greater(fabs(stop), stop - begin);
}

int ex_go_ahead(ex_context *c, ex_place *p, const ex_recorder *to)
{
    const ex_foresight *const ahead = &c->stretch.ahead;
    const double *const times = c->task->times;
    int status = BG_OK;
    p->stop = ahead->end;
    while (!status && p->at < c->task->samples && times[p->at] < p->stop) {
        const double next = times[p->at];
        if (!bg_is_empty(&ahead->ports) && ex_shows_after(c, next, p->stop)) {
            p->stop = next;
            break;
        }
        ex_glide(c, next - p->t, p->z);
        p->t = next;
        status = to->record(to->self, c, p);
    }
    memcpy(p->z, ahead->z, sizeof p->z);
    p->ports = ahead->ports;
    return status;
}
