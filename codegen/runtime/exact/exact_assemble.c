/* A mode with its inputs' generator as one affine system, z' = M z + b, and what is watched in it. */
#include "exact_internal.h"

#include <math.h>
#include <string.h>

/* Columns of affine maps, `rows` long, over the slots: an input and its rate are sums of them. */
static void over_slots(const ex_chains *chains, int rows, const double *map, double *slots)
{
    for (int i = 0; i < chains->count; i++) {
        const int width = chains->width[i], j = chains->input[i];
        const double *by_w = map + (EX_N + j) * rows, *by_dw = map + (EX_N + EX_W + j) * rows;
        const double re = chains->rate[i][0], im = chains->rate[i][1];
        double *const to = slots + chains->first[i] * rows;
        for (int r = 0; r < rows; r++)
            to[r] = by_w[r] + re * by_dw[r];
        if (EX_G > 1 && width == 2)
            for (int r = 0; r < rows; r++)
                to[rows + r] = -im * by_dw[r];
        if (EX_G > 1 && chains->depth[i] > 1)
            for (int r = 0; r < rows; r++)
                to[width * rows + r] = by_dw[r];
    }
}

/* The generator's own columns of M. */
static void generate(const ex_chains *chains, double (*M)[EX_Z])
{
    for (int i = 0; i < chains->count; i++)
        for (int k = 0; k < chains->depth[i]; k++) {
            const int width = chains->width[i], at = EX_N + chains->first[i] + k * width;
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
 * where only inputs rule its slip, of that to what is no longer zero: it gives nothing then. A switch
 * has what keeps it, and a cap of zero. */
void ex_triggers(const ex_context *c, const ex_mode *record, const double *shot, const double *stay,
                 double *to)
{
    const int *const mode = c->run.mode;
    for (int i = 0; i < EX_K; i++) {
        const int rests = ex_rests(record, i);
        if (ex_switches(c, i) && !rests) {
            to[2 * i] = stay[i];
            to[2 * i + 1] = 0.0;
            continue;
        }
        const double moved = shot[(rests ? EX_AT_SLIP : EX_AT_EFFORT) + i];
        const double cap = shot[EX_AT_CAP + i], below = rests ? 0.0 : cap;
        const double slip = ex_hangs(c, i) ? stay[i] : shot[EX_AT_SLIP + i];
        to[2 * i] = mode[i] ? mode[i] * slip : below - moved;
        to[2 * i + 1] = mode[i] ? cap : below + moved;
    }
}

int ex_single(const ex_context *c, const ex_mode *record, int port)
{
    return c->run.mode[port] != 0 || (ex_switches(c, port) && !ex_rests(record, port));
}

/* Weights of the slots that keep what they feed from counting, and the norm of M in all. */
static void balance(ex_entry *e)
{
    double own = 0.0;
    e->norm = 0.0;
    for (int j = 0; j < EX_Z; j++) {
        double sum = 0.0;
        const int rows = j < EX_N ? EX_N : j;
        if (j == EX_N)
            own = e->norm;
        for (int i = 0; i < rows; i++)
            sum += (j < EX_N ? e->mode->weight[i] : e->weight[i]) * fabs(e->M[j][i]);
        e->weight[j] = j < EX_N ? e->mode->weight[j] : sum > 0 ? 4.0 * sum / (own + BG_SLOTS_FLOOR) : 1.0;
        for (int i = rows; i < EX_Z; i++)
            sum += e->weight[j] * fabs(e->M[j][i]);
        e->norm = bg_greater(e->norm, sum / e->weight[j]);
    }
}

/* What moves the triggers, and whether strides can tell of it. */
static void tell_moves(ex_entry *e)
{
    int paced[EX_G] = {0};
    e->timed = 0;
    e->foreseeable = EX_K > 0;
    for (int i = 0; i < EX_T; i++) {
        e->moves[i] = EX_STILL;
        for (int j = EX_Z - 1; j >= 0; j--)
            if (e->trigger[j][i] != 0.0)
                e->moves[i] = j < EX_N ? EX_MOVED : EX_TIMED;
        const int timed = e->moves[i] == EX_TIMED && !e->cap[i];
        e->timed |= timed;
        for (int j = 0; j < EX_G; j++)
            paced[j] |= timed && e->trigger[EX_N + j][i] != 0.0;
        e->foreseeable &= !ex_rests(e->mode, i / 2);
    }
    memset(e->paced, 0, sizeof e->paced);
    for (int i = 0; i < e->chains.count; i++) {
        const int first = e->chains.first[i], last = first + e->chains.depth[i] * e->chains.width[i];
        int any = 0;
        for (int j = first; j < last; j++)
            any |= paced[j];
        for (int j = first; j < last; j++)
            e->paced[j] = any;
    }
}

/* Polynomials of time go on for as long as they are: the size of a term tells nothing of the next. */
static int least_degree(const ex_chains *chains)
{
    int deepest = 1;
    for (int i = 0; i < chains->count; i++)
        deepest = chains->depth[i] > deepest ? chains->depth[i] : deepest;
    const int least = EX_LEAST_DEGREE + (deepest > 1 ? deepest : 0);
    return least < BG_POWERS ? least : BG_POWERS - 1;
}

void ex_assemble(ex_context *c, ex_entry *e)
{
    double slots[EX_G][EX_SHOT], keeping[EX_G][EX_PORTS], stay[EX_PORTS];
    memset(e->M, 0, sizeof e->M);
    memset(slots, 0, sizeof slots);
    memset(keeping, 0, sizeof keeping);
    over_slots(&e->chains, EX_SHOT, e->mode->shot[0], slots[0]);
    if (c->model->switched || c->model->hung)
        over_slots(&e->chains, EX_PORTS, e->mode->stay[0], keeping[0]);
    generate(&e->chains, e->M);
    for (int j = 0; j < EX_Z; j++) {
        const double *shot = j < EX_N ? e->mode->shot[j] : slots[j - EX_N];
        for (int i = 0; i < EX_N; i++)
            e->M[j][i] = shot[EX_AT_RATE + i];
        memcpy(stay, j < EX_N ? e->mode->stay[j] : keeping[j - EX_N], sizeof stay);
        ex_watch_gaps(c, j, stay);
        ex_triggers(c, e->mode, shot, stay, e->trigger[j]);
    }
    e->least = least_degree(&e->chains);
    memset(e->rows, 0, sizeof e->rows);
    for (int j = 0; j < EX_Z; j++) {
        memcpy(e->rows[j], e->M[j], sizeof e->M[j]);
        memcpy(e->rows[j] + EX_Z, e->trigger[j], EX_T * sizeof e->trigger[j][0]);
    }
    memset(e->cap, 0, sizeof e->cap);
    for (int i = 0; i < EX_K; i++)
        e->cap[2 * i + 1] = ex_single(c, e->mode, i);
    balance(e);
    e->h = e->step = 0.0;
    e->walked = 0;
    e->segment = -1;
    tell_moves(e);
}
