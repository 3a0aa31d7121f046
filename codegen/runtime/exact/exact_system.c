/* Affine systems of modes with inputs' generators as they are kept, and stretches in them. */
#include "exact_internal.h"

#include <math.h>
#include <string.h>

/* The entry of the present mode and generator, from the cache or in place of the oldest. */
static int entry(ex_context *c, ex_entry **found)
{
    const ex_chains *chains = c->inputs->structures + c->inputs->chains[c->run.span.segment];
    const ex_mode *mode;
    const int status = ex_find(c, c->run.mode, &mode);
    int oldest = 0;
    if (status)
        return status;
    if (c->clock > 1000000000) {
        c->clock = 0;
        memset(c->used, 0, sizeof c->used);
        c->stridden = 0;
    }
    c->clock++;
    int *const latest = c->latest + c->place % EX_ENTRIES;
    for (int n = -1; n < EX_ENTRIES; n++) {
        const int i = n < 0 ? *latest : n;
        ex_entry *e = c->entries + i;
        if (c->used[i] && ex_is_same(&e->key, &c->where)
            && (e->chains.count == chains->count
                && memcmp(&e->chains, chains, sizeof *chains) == 0)) {
            *latest = i;
            c->used[i] = c->clock;
            e->mode = mode;
            e->place = c->place;
            *found = e;
            return BG_OK;
        }
        if (c->used[i] < c->used[oldest])
            oldest = i;
    }
    *found = c->entries + oldest;
    c->used[oldest] = c->clock;
    for (int i = 0; i < c->stridden; i++)
        if (c->strides[i].entry == oldest)
            c->strides[i].entry = -1;
    (*found)->mode = mode;
    (*found)->key = c->where;
    (*found)->place = c->place;
    (*found)->chains = *chains;
    ex_assemble(c, *found);
    return isfinite((*found)->norm) ? BG_OK : BG_NOT_FINITE;
}

/* The constant parts of rates and triggers: of the map itself and of inputs that don't change. */
static void constants(const ex_context *c, ex_entry *e)
{
    const ex_mode *mode = e->mode;
    ex_shot sum;
    double stay[EX_PORTS];
    memcpy(sum, mode->shot[EX_L - 1], sizeof sum);
    memcpy(stay, mode->stay[EX_L - 1], sizeof stay);
    for (int j = 0; j < EX_W; j++) {
        const double w = c->inputs->constant[c->run.span.segment][j];
        if (w != 0.0) {
            for (int i = 0; i < EX_SHOT; i++)
                sum[i] += mode->shot[EX_N + j][i] * w;
            for (int i = 0; i < EX_K; i++)
                stay[i] += mode->stay[EX_N + j][i] * w;
        }
    }
    for (int i = 0; i < EX_N; i++)
        e->b[i] = sum[EX_AT_RATE + i];
    for (int i = EX_N; i < EX_Z; i++)
        e->b[i] = 0.0;
    ex_watch_gaps(c, -1, stay);
    ex_triggers(c, mode, sum, stay, e->level);
    e->segment = c->run.span.segment;
    e->run = c->runs;
}

/* How long a motion has to be followed: until its end, or until it has decayed. */
static double lasting(double rate, double decay, double span)
{
    return rate * (decay * span > BG_GONE ? BG_GONE / decay : span);
}

/* Whether a stretch takes a bearable number of steps, or none; a status. */
static int bearable(ex_context *c, const ex_entry *e, double span)
{
    const double steps = e->norm * span;
    const double few = EX_K || c->advance != ex_advance ? BG_MANY : BG_ROUNDED;
    double most = 0.0;
    if (!(steps > few))
        return isfinite(steps) ? BG_OK : BG_ENDLESS;
    if (EX_K == 0)
        return !e->mode->sharp ? BG_BLUNT : steps < ldexp(1.0, BG_RUNGS - 3) ? BG_OK : BG_ENDLESS;
    if (e->mode->rates < 0)
        return BG_BLUNT;
    for (int i = 0; i < e->mode->rates; i++)
        most = bg_greater(most, lasting(e->mode->spectrum[i][0], e->mode->spectrum[i][1], span));
    for (int i = 0; i < e->chains.count; i++) {
        const double *rate = e->chains.rate[i];
        most = bg_greater(most, lasting(hypot(rate[0], rate[1]), -rate[0], span));
    }
    const double work = bg_lesser(steps, most / BG_LEAST_PART);
    return work > BG_MOST_IN_C ? BG_ENDLESS : work < steps ? BG_STIFF : BG_OK;
}

/* A stretch from the context's instant on, in its mode. */
int ex_begin(ex_context *c, double stop)
{
    ex_stretch *stretch = &c->stretch;
    bg_port ports[EX_PORTS];
    int status = entry(c, &stretch->entry);
    if (status)
        return status;
    if (stretch->entry->segment != c->run.span.segment || stretch->entry->run != c->runs)
        constants(c, stretch->entry);
    memcpy(stretch->b, stretch->entry->b, sizeof stretch->b);
    memcpy(stretch->level, stretch->entry->level, sizeof stretch->level);
    stretch->t = c->run.at.t;
    stretch->leaping = 0;
    if (ex_foresee(c, stop))
        return BG_OK;
    status = bearable(c, stretch->entry, stop - c->run.at.t);
    if (status)
        return status;
    stretch->blind = bg_moment(c->run.at.time);
    if (EX_K == 0)
        return BG_OK;
    status = ex_show(c, c->run.at.t, c->s, stretch->entry->mode);
    if (status)
        return status;
    ex_round_shown(c, c->run.at.t, ports);
    ex_round_stay(c, stretch->entry->mode, c->seen, c->shot, c->run.at.t, ports);
    ex_round_hung(c, stretch->entry->mode, c->seen, c->run.at.t, ports);
    for (int i = 0; i < EX_T; i++) {
        const int port = i / 2, rests = ex_rests(stretch->entry->mode, port);
        stretch->limit[i] = c->run.mode[port] || rests ? ports[port].near_slip
                                                    : ports[port].near_effort;
        if (ex_switches(c, port) && !rests)
            stretch->limit[i] = ex_is_apart(c, port) ? ports[port].near_gap
                                                     : ports[port].near_stay;
        if (ex_hangs(c, port) && c->run.mode[port])
            stretch->limit[i] = ports[port].near_gap;
        stretch->level[i] += rests ? BG_LEFT * ports[port].near_slip : 0.0;
        /* caps need not be */
        stretch->armed[i] = i % 2 && ex_single(c, stretch->entry->mode, port);
    }
    return BG_OK;
}
