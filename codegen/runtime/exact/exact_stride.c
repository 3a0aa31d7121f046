/* What is known of stretches that recur. */
#include "exact_internal.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* Whether a chain of inputs begins as it did, if it times events: values and slopes as they weigh. */
static int chain_is_alike(const ex_entry *e, int chain, const double *start, const double *slots)
{
    const int first = e->chains.first[chain];
    const int last = first + e->chains.depth[chain] * e->chains.width[chain];
    double off = 0.0, size = 0.0;
    for (int i = first; i < last && e->paced[i]; i++) {
        off = bg_greater(off, e->weight[EX_N + i] * fabs(slots[i] - start[i]));
        size = bg_greater(size, e->weight[EX_N + i] * fabs(start[i]));
    }
    return off <= BG_ALIKE * size;
}

/* Whether the inputs that time the events of an entry begin as they did, with the same constant parts. */
static int begins_alike(const ex_stretch *stretch, const ex_stride *k, const double *slots)
{
    const ex_entry *const e = stretch->entry;
    int same = 1;
    for (int i = 0; i < EX_T; i++)
        same &= e->moves[i] != EX_TIMED || stretch->level[i] == k->level[i];
    for (int i = 0; i < e->chains.count; i++)
        same &= chain_is_alike(e, i, k->start, slots);
    return same;
}

/* Whether a stretch of an entry, with `left` until it has to end, is this one. */
static int suits(const ex_context *c, const ex_stride *k, int entry, const double *slots, double left)
{
    if (k->entry != entry)
        return 0;
    if (bg_is_empty(&k->ports) ? fabs(left - k->h) > BG_ALIKE * k->h
                               : left <= k->h * (1.0 + BG_ALIKE))
        return 0;
    return !c->entries[entry].timed || begins_alike(&c->stretch, k, slots);
}

void ex_ends_of(const ex_stretch *stretch, const ex_stride *k, const double *restrict z,
                ex_ends *restrict to)
{
    const ex_entry *const e = stretch->entry;
    double rate[EX_Z], size[EX_Z], lifted[EX_LIFT] = {0};
    memcpy(rate, stretch->b, sizeof rate);
    memcpy(to->begins, stretch->level, sizeof to->begins);
    memset(to->bend, 0, sizeof to->bend);
    ex_add_columns(EX_Z, EX_Z, e->M[0], z, rate);
    ex_add_columns(EX_T, EX_TRIGGERS, e->trigger[0], z, to->begins);
    for (int i = 0; i < EX_Z; i++)
        size[i] = fabs(rate[i]);
    ex_add_columns(EX_LIFT, EX_LIFT, k->lift[0], rate, lifted);
    ex_add_columns(EX_T, EX_TRIGGERS, k->bend[0], size, to->bend);
    for (int i = 0; i < EX_Z; i++)
        to->z[i] = z[i] + lifted[EX_TO_STATE + i];
    memcpy(to->rates, lifted + EX_TO_RATES, sizeof to->rates);
    for (int i = 0; i < EX_T; i++)
        to->value[i] = to->begins[i] + lifted[EX_TO_VALUES + i];
    memcpy(to->slope, lifted + EX_TO_SLOPES, sizeof to->slope);
}

/* The rows of a stride, from the exponential over it and its integral. */
static void lift(const ex_entry *e, double (*E)[EX_Z], double (*gather)[EX_Z], ex_stride *k)
{
    double values[EX_Z][EX_TRIGGERS], slopes[EX_Z][EX_TRIGGERS];
    ex_rows_times((double(*)[EX_TRIGGERS])e->trigger, gather, values);
    ex_rows_times((double(*)[EX_TRIGGERS])e->trigger, E, slopes);
    memset(k->lift, 0, sizeof k->lift);
    for (int j = 0; j < EX_Z; j++) {
        memcpy(k->lift[j] + EX_TO_STATE, gather[j], sizeof gather[j]);
        memcpy(k->lift[j] + EX_TO_RATES, E[j], sizeof E[j]);
        for (int i = 0; i < EX_T; i++) {
            k->lift[j][EX_TO_VALUES + i] = values[j][i];
            k->lift[j][EX_TO_SLOPES + i] = slopes[j][i];
        }
    }
}

/* Whether inputs alone decide where it ends, and clearly: what falls does so with a slope, and all else
 * that they move is still far from that. */
static int is_clear(const ex_stretch *stretch, const ex_stride *k, const ex_ends *to)
{
    ex_entry *const e = stretch->entry;
    double size[EX_TRIGGERS], sizes[EX_Z];
    for (int i = 0; i < EX_T; i++)
        size[i] = fabs(stretch->level[i]);
    for (int j = 0; j < EX_Z; j++)
        sizes[j] = fabs(to->z[j]);
    for (int j = 0; j < EX_Z; j++)
        for (int i = 0; i < EX_T; i++)
            size[i] += fabs(e->trigger[j][i]) * sizes[j];
    for (int i = 0; i < EX_T; i++) {
        if (e->moves[i] != EX_TIMED || e->cap[i])
            continue;
        const int falls = bg_has(&k->ports, i / 2);
        if (!((falls ? -to->slope[i] * k->h : to->value[i]) > BG_WIDE * BG_ALIKE * size[i]))
            return 0;
    }
    return 1;
}

/* Works out what is to be known, where it comes to little. */
static void work_out(ex_context *c, ex_stride *k, const double *z)
{
    ex_entry *const e = c->stretch.entry;
    double(*E)[EX_Z] = c->work[5], gather[EX_Z][EX_Z], rows[EX_Z][EX_TRIGGERS];
    ex_ends to;
    const double parts = bg_greater(ceil(e->norm * k->h / BG_LONGEST), 1.0);
    const double bend = k->h * k->h / 8.0 * (1.0 + BG_BOUND_SLACK);
    k->known = -1;
    if (!(parts <= EX_PARTS))
        return;
    ex_exponential(c, e->M, e->norm, k->h / parts, E, gather);
    ex_rows_times(e->trigger, e->M, rows);
    ex_extremes(c, e, k->h / parts, (int)parts, E, rows, k->bend);
    for (int j = 0; j < EX_Z; j++)
        for (int i = 0; i < EX_T; i++)
            k->bend[j][i] *= bend;
    ex_exponential(c, e->M, e->norm, k->h, E, gather);
    lift(e, E, gather, k);
    ex_ends_of(&c->stretch, k, z, &to);
    if (is_clear(&c->stretch, k, &to))
        k->known = 1;
}

ex_stride *ex_known(ex_context *c, const double *z, double stop)
{
    const int entry = (int)(c->stretch.entry - c->entries);
    for (int i = 0; i < c->stridden; i++) {
        ex_stride *const k = c->strides + i;
        if (!suits(c, k, entry, z + EX_N, stop - c->run.at.t))
            continue;
        k->used = c->clock;
        if (k->known == 0)
            work_out(c, k, z);
        return k->known > 0 ? k : NULL;
    }
    return NULL;
}

/* The ports whose event has ended a stretch; 0 at *timed where it was not time that moved them all. */
static bg_set ended_by(const ex_context *c, const ex_entry *e, int *timed)
{
    bg_set ports = {{0}};
    *timed = 1;
    for (int i = 0; i < EX_K; i++)
        if (c->run.at.touched[i]) {
            bg_add(&ports, i);
            *timed &= e->moves[2 * i] == EX_TIMED && e->cap[2 * i + 1];
        }
    return ports;
}

void ex_notice(ex_context *c, double t, const double *slots)
{
    const ex_entry *const e = c->stretch.entry;
    const int entry = (int)(e - c->entries);
    int oldest = 0, timed;
    if (!e->foreseeable)
        return;
    const bg_set ports = ended_by(c, e, &timed);
    if (!timed)
        return;
    const double h = c->run.at.t - t;
    for (int i = 0; i < c->stridden; i++) {
        const ex_stride *const k = c->strides + i;
        if (k->entry == entry && bg_is_same(&k->ports, &ports)
            && fabs(k->h - h) <= BG_ALIKE * h && (!e->timed || begins_alike(&c->stretch, k, slots)))
            return;
        if (k->used < c->strides[oldest].used)
            oldest = i;
    }
    ex_stride *const k = c->strides + (c->stridden < EX_STRIDES ? c->stridden++ : oldest);
    k->entry = entry;
    k->used = c->clock;
    k->known = 0;
    k->ports = ports;
    k->h = h;
    memcpy(k->start, slots, sizeof k->start);
    memcpy(k->level, c->stretch.level, sizeof k->level);
}
