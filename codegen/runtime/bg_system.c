/* A mode with its inputs' generator as one affine system, z' = M z + b, and stretches in it. */
#include "bg_internal.h"

#include <math.h>
#include <string.h>

/* A row of affine maps over the slots: an input and its rate are sums of them. */
static void over_slots(const bg_chains *chains, const bg_mode *mode, double (*slots)[BG_SHOT])
{
    for (int i = 0; i < chains->count; i++) {
        const int first = chains->first[i], width = chains->width[i], j = chains->input[i];
        const double *by_w = mode->shot[BG_N + j], *by_dw = mode->shot[BG_N + BG_W + j];
        const double re = chains->rate[i][0], im = chains->rate[i][1];
        for (int r = 0; r < BG_SHOT; r++)
            slots[first][r] = by_w[r] + re * by_dw[r];
        if (width == 2)
            for (int r = 0; r < BG_SHOT; r++)
                slots[first + 1][r] = -im * by_dw[r];
        if (chains->depth[i] > 1)
            for (int r = 0; r < BG_SHOT; r++)
                slots[first + width][r] = by_dw[r];
    }
}

/* The generator's own columns of M. */
static void generate(const bg_chains *chains, double (*M)[BG_Z])
{
    for (int i = 0; i < chains->count; i++)
        for (int k = 0; k < chains->depth[i]; k++) {
            const int width = chains->width[i], at = BG_N + chains->first[i] + k * width;
            for (int part = 0; part < width; part++) {
                M[at + part][at + part] = chains->rate[i][0];
                if (k)
                    M[at + part][at + part - width] = 1.0;
            }
            if (width == 2) {
                M[at][at + 1] = chains->rate[i][1];
                M[at + 1][at] = -chains->rate[i][1];
            }
        }
}

/* Triggers from the rows of slips, efforts and caps: a port that slips has its slip, and its cap,
 * which is only watched; one that sticks the distances of its effort to both breakaway efforts, or,
 * where only inputs rule its slip, of that to what is no longer zero: it gives nothing then. */
static void triggers(const bg_mode *record, const signed char *mode, const double *shot, double *to)
{
    for (int i = 0; i < BG_K; i++) {
        const int rests = bg_rests(record, i);
        const double moved = shot[(rests ? BG_AT_SLIP : BG_AT_EFFORT) + i];
        const double cap = shot[BG_AT_CAP + i], below = rests ? 0.0 : cap;
        to[2 * i] = mode[i] ? mode[i] * shot[BG_AT_SLIP + i] : below - moved;
        to[2 * i + 1] = mode[i] ? cap : below + moved;
    }
}

/* Weights of the slots that keep what they feed from counting, and the norm of M in all. */
static void balance(bg_entry *e)
{
    double own = 0.0;
    e->norm = 0.0;
    for (int j = 0; j < BG_Z; j++) {
        double sum = 0.0;
        const int rows = j < BG_N ? BG_N : j;
        if (j == BG_N)
            own = e->norm;
        for (int i = 0; i < rows; i++)
            sum += (j < BG_N ? e->mode->weight[i] : e->weight[i]) * fabs(e->M[j][i]);
        e->weight[j] = j < BG_N ? e->mode->weight[j] : sum > 0 ? 4.0 * sum / (own + 1e-3) : 1.0;
        for (int i = rows; i < BG_Z; i++)
            sum += e->weight[j] * fabs(e->M[j][i]);
        e->norm = bg_greater(e->norm, sum / e->weight[j]);
    }
}

static void assemble(bg_context *c, bg_entry *e)
{
    double slots[BG_G][BG_SHOT];
    memset(e->M, 0, sizeof e->M);
    memset(slots, 0, sizeof slots);
    over_slots(&e->chains, e->mode, slots);
    generate(&e->chains, e->M);
    for (int j = 0; j < BG_Z; j++) {
        const double *shot = j < BG_N ? e->mode->shot[j] : slots[j - BG_N];
        for (int i = 0; i < BG_N; i++)
            e->M[j][i] = shot[BG_AT_RATE + i];
        triggers(e->mode, c->mode, shot, e->trigger[j]);
    }
    e->caps = 0;
    for (int i = 0; i < BG_K; i++)
        e->caps |= c->mode[i] ? 2u << 2 * i : 0u;
    balance(e);
    e->h = e->step = 0.0;
}

/* The entry of the present mode and generator, from the cache or in place of the oldest. */
static int entry(bg_context *c, bg_entry **found)
{
    const bg_chains *chains = c->inputs->structures + c->inputs->chains[c->segment];
    const bg_mode *mode;
    const int number = bg_number(c->mode), status = bg_find(c, number, &mode);
    int oldest = 0;
    if (status)
        return status;
    if (c->clock > 1000000000) {
        c->clock = 0;
        memset(c->used, 0, sizeof c->used);
    }
    c->clock++;
    for (int i = 0; i < BG_ENTRIES; i++) {
        bg_entry *e = c->entries + i;
        if (c->used[i] && e->number == number
            && (e->chains.count == chains->count
                && memcmp(&e->chains, chains, sizeof *chains) == 0)) {
            c->used[i] = c->clock;
            *found = e;
            return BG_OK;
        }
        if (c->used[i] < c->used[oldest])
            oldest = i;
    }
    *found = c->entries + oldest;
    c->used[oldest] = c->clock;
    (*found)->mode = mode;
    (*found)->number = number;
    (*found)->chains = *chains;
    assemble(c, *found);
    return isfinite((*found)->norm) ? BG_OK : BG_UNUSABLE;
}

/* The constant parts of rates and triggers: of the map itself and of inputs that don't change. */
static void constants(const bg_context *c, bg_stretch *stretch)
{
    const bg_mode *mode = stretch->entry->mode;
    bg_shot sum;
    memcpy(sum, mode->shot[BG_L - 1], sizeof sum);
    for (int j = 0; j < BG_W; j++) {
        const double w = c->inputs->constant[c->segment][j];
        if (w != 0.0)
            for (int i = 0; i < BG_SHOT; i++)
                sum[i] += mode->shot[BG_N + j][i] * w;
    }
    for (int i = 0; i < BG_N; i++)
        stretch->b[i] = sum[BG_AT_RATE + i];
    for (int i = BG_N; i < BG_Z; i++)
        stretch->b[i] = 0.0;
    triggers(mode, c->mode, sum, stretch->level);
}

/* How long a motion has to be followed: until its end, or until it has decayed. */
static double lasting(double rate, double decay, double span)
{
    return rate * (decay * span > BG_GONE ? BG_GONE / decay : span);
}

/* Whether a stretch takes a bearable number of steps, or none; a status. */
static int bearable(bg_context *c, const bg_entry *e, double span)
{
    const double steps = e->norm * span;
    const double few = BG_K || c->advance != bg_advance ? BG_MANY : BG_ROUNDED;
    double most = 0.0;
    if (!(steps > few))
        return isfinite(steps) ? BG_OK : BG_ENDLESS;
    if (BG_K == 0)
        return !e->mode->sharp ? BG_BLUNT : steps < ldexp(1.0, BG_RUNGS - 3) ? BG_OK : BG_ENDLESS;
    for (int i = 0; i < e->mode->rates; i++)
        most = bg_greater(most, lasting(e->mode->spectrum[i][0], e->mode->spectrum[i][1], span));
    for (int i = 0; i < e->chains.count; i++) {
        const double *rate = e->chains.rate[i];
        most = bg_greater(most, lasting(hypot(rate[0], rate[1]), -rate[0], span));
    }
    const double work = bg_lesser(steps, most / BG_LEAST_PART);
    return work > BG_MOST ? BG_ENDLESS : work < steps ? BG_STIFF : BG_OK;
}

/* A stretch from the context's instant on, in its mode. */
int bg_begin(bg_context *c, double stop)
{
    bg_stretch *stretch = &c->stretch;
    bg_shot now;
    bg_scales size;
    int status = entry(c, &stretch->entry);
    if (status)
        return status;
    status = bearable(c, stretch->entry, stop - c->t);
    if (status)
        return status;
    constants(c, stretch);
    stretch->t = c->t;
    stretch->blind = bg_moment(c->peaks.time);
    stretch->leaping = 0;
    if (BG_K == 0)
        return BG_OK;
    status = bg_look(c, c->t, c->s, stretch->entry->mode, now);
    if (status)
        return status;
    bg_scale(c, now, c->t, &size);
    for (int i = 0; i < BG_T; i++) {
        const int port = i / 2, rests = bg_rests(stretch->entry->mode, port);
        stretch->limit[i] = c->mode[port] || rests ? size.slip[port] : size.effort[port];
        stretch->level[i] += rests ? BG_LEFT * size.slip[port] : 0.0;
        stretch->armed[i] = c->mode[i / 2] && i % 2; /* caps need not be */
    }
    return BG_OK;
}
