/* From a model's affine maps to the engine's records. */
#include "batch_internal.h"

#include <math.h>
#include <string.h>

enum { SQUARES = 3 };

/* What an affine map over fewer inputs has in a column of the engine's maps; -1 for none. */
static int column_of(int j)
{
    if (j < EX_N)
        return j;
    if (j == EX_L - 1)
        return BG_MAP_COLUMNS - 1;
    const int rate = j >= EX_N + EX_W, input = (j - EX_N) % EX_W;
    return input < BG_EXTERNAL ? EX_N + rate * BG_EXTERNAL + input : -1;
}

/* The largest magnitude. */
static double largest_rate_of(double (*matrix)[EX_N])
{
    double most[EX_N] = {0}, size = 0.0;
    for (int i = 0; i < EX_N; i++)
#pragma GCC unroll 1
        for (int j = 0; j < EX_N; j++)
            most[j] = bg_greater(fabs(matrix[i][j]), most[j]);
    for (int j = 0; j < EX_N; j++)
        size = bg_greater(most[j], size);
    return size;
}

static void squared(double (*restrict matrix)[EX_N], double factor, double (*restrict to)[EX_N])
{
    for (int i = 0; i < EX_N; i++)
#pragma GCC unroll 1
        for (int j = 0; j < EX_N; j++) {
            double sum = 0.0;
#pragma GCC unroll 32
            for (int l = 0; l < EX_N; l++)
                sum += matrix[i][l] * matrix[l][j];
            to[i][j] = factor * sum;
        }
}

/* The largest magnitude of an eigenvalue, nearly: from a high power of a balanced matrix. It is
 * scaled at every second square only. */
static double spectral_radius(double (*matrix)[EX_N])
{
    double power[EX_N][EX_N], other[EX_N][EX_N];
    double size = largest_rate_of(matrix), logarithm = 0.0, share = 1.0;
    memcpy(power, matrix, sizeof power);
    for (int k = 0; k < SQUARES && size > 0.0; k++) {
        const double shrink = 1.0 / size;
        logarithm += share * log(size);
        share /= 4;
        squared(power, shrink * shrink, other);
        squared(other, 1.0, power);
        size = largest_rate_of(power);
    }
    return size > 0.0 ? exp(logarithm + share * log(size)) : 0.0;
}

/* One over the scales, powers of 2, that make rows and columns alike. */
static void balance_rates(double (*matrix)[EX_N], double *weight)
{
    double scale[EX_N];
    for (int i = 0; i < EX_N; i++)
        weight[i] = scale[i] = 1.0;
    for (int changed = 1, turn = 0; changed && turn < 50; turn++) {
        changed = 0;
        for (int i = 0; i < EX_N; i++) {
            double row = 0.0, column = 0.0, factor = 1.0;
            for (int j = 0; j < EX_N; j++) {
                row += j == i ? 0.0 : fabs(matrix[i][j]) * scale[j];
                column += j == i ? 0.0 : fabs(matrix[j][i]) * weight[j];
            }
            row *= weight[i];
            column *= scale[i];
            if (!(row > 0.0 && column > 0.0) || !isfinite(row + column))
                continue;
            const double before = row + column;
            for (; column < row / 2; column *= 2, row /= 2)
                factor *= 2;
            for (; column >= row * 2; column /= 2, row *= 2)
                factor /= 2;
            if (row + column < 0.95 * before) {
                weight[i] /= factor;
                scale[i] *= factor;
                changed = 1;
            }
        }
    }
}

/* sum of factors times entries of one column of a map, from a row on */
static double product(const double *map, int first, int count, const double *factors, int column)
{
    double sum = 0.0;
    for (int i = 0; i < count; i++)
        sum += factors[i] * map[(first + i) * BG_MAP_COLUMNS + column];
    return sum;
}

/* How fast the slip of a port changes: F x' + D u', where x' has that of driven storages, too. */
static double push_of(const double *map, const bg_numbers *a, int reading, int column)
{
    double sum = 0.0;
    for (int j = 0; j < M; j++)
        if (a->D[reading * M + j] != 0.0)
            sum += a->D[reading * M + j] * map[(BG_AT_du + j) * BG_MAP_COLUMNS + column];
    for (int l = 0; l < N; l++) {
        const double factor = a->F[reading * N + l];
        if (factor != 0.0 && !BG_DRIVEN)
            sum += factor * map[(BG_AT_rate + l) * BG_MAP_COLUMNS + column];
        else if (factor != 0.0)
            sum += factor * (product(map, 0, N, a->P + l * N, column)
                             + product(map, BG_AT_u, M, a->Q + l * M, column)
                             + product(map, BG_AT_du, M, a->R + l * M, column));
    }
    return sum;
}

static void fill_column(const double *map, const bg_numbers *a, int column, double *shot)
{
    for (int i = 0; i < N; i++)
        shot[EX_AT_X + i] = map[i * BG_MAP_COLUMNS + column];
    for (int i = 0; i < M; i++)
        shot[EX_AT_U + i] = map[(BG_AT_u + i) * BG_MAP_COLUMNS + column];
    for (int k = 0; k < EX_K; k++) {
        const int reading = bg_friction_readings[k], input = bg_friction_inputs[k];
        shot[EX_AT_SLIP + k] = map[(BG_AT_y + reading) * BG_MAP_COLUMNS + column];
        shot[EX_AT_EFFORT + k] = map[(BG_AT_u + input) * BG_MAP_COLUMNS + column];
        shot[EX_AT_CAP + k] = map[(BG_AT_caps + k) * BG_MAP_COLUMNS + column];
        shot[EX_AT_PUSH + k] = push_of(map, a, reading, column);
    }
    for (int i = 0; i < EX_N; i++)
        shot[EX_AT_RATE + i] = map[(BG_AT_rate + i) * BG_MAP_COLUMNS + column];
}

/* How fast the states are by themselves, and what balances them: as of a mode that has the same
 * rates, such as one that slips the other way, or from the rates. */
static void find_fastest(batch_room *room, int at)
{
    ex_mode *const made = room->mode + at;
    double own[EX_N][EX_N];
    for (int k = 0; k < room->record.count; k++) {
        int same = k != at;
        for (int j = 0; j < EX_N && same; j++)
            same = memcmp(made->shot[j] + EX_AT_RATE, room->mode[k].shot[j] + EX_AT_RATE,
                          sizeof own[j]) == 0;
        if (same) {
            made->fastest = room->mode[k].fastest;
            memcpy(made->weight, room->mode[k].weight, sizeof made->weight);
            return;
        }
    }
    for (int i = 0; i < EX_N; i++)
        for (int j = 0; j < EX_N; j++)
            own[i][j] = made->shot[j][EX_AT_RATE + i];
    balance_rates(own, made->weight);
    for (int i = 0; i < EX_N; i++)
        for (int j = 0; j < EX_N; j++)
            own[i][j] *= made->weight[i] / made->weight[j];
    made->fastest = spectral_radius(own);
}

/* Ports with part in what none of them rules alone. */
static void join(ex_mode *made, const bg_hold *held)
{
    for (int r = 0; r < held->share_count; r++)
        for (int c = 0; c < held->count; c++) {
            int *const joined = made->joined + held->ports[c];
            if (held->share[r * held->count + c] == 0.0)
                continue;
            const int before = *joined;
            *joined = r + 1;
            for (int i = 0; before && i < EX_K; i++)
                if (made->joined[i] == before)
                    made->joined[i] = r + 1;
        }
}

/* The slips that sticking takes from the states, and what only inputs rule of the others. */
static void fill_held(ex_mode *made, const bg_hold *held)
{
    join(made, held);
    for (int k = 0; k < held->kept; k++)
        for (int i = 0; i < N; i++)
            made->take_away[k][i] = held->take_away[i * held->kept + k];
    for (int k = 0; k < held->kept; k++)
        for (int c = 0; c < held->count; c++)
            made->mix[k][held->ports[c]] = held->mix[k * held->count + c];
    made->held = held->kept;
    made->ruled = held->ruled;
    for (int r = 0; r < held->ruled; r++)
        for (int c = 0; c < held->count; c++)
            made->ruling[r][held->ports[c]] = held->share[r * held->count + c];
}

static void fill(ex_mode *made, const double *map, const bg_numbers *a, const bg_hold *held)
{
    if (held)
        fill_held(made, held);
    for (int j = 0; j < EX_L; j++) {
        const int column = column_of(j);
        if (column < 0)
            continue;
        fill_column(map, a, column, made->shot[j]);
        for (int k = 0; k < made->held; k++)
            made->left[j][k] = product(map, 0, N, held->slip_x + k * N, column)
                               + product(map, BG_AT_u, M, held->slip_u + k * M, column);
    }
}

/* Conditions of switches in a column of the map, less their constants but in the last. */
static void guards_in(const double *map, bg_model *m, int column, const double *constant,
                      double *guards)
{
    bg_values *const now = &m->now;
    for (int i = 0; i < N; i++)
        now->x[i] = map[i * BG_MAP_COLUMNS + column];
    for (int i = 0; i < OWN; i++)
        now->z[i] = map[(BG_AT_z + i) * BG_MAP_COLUMNS + column];
    for (int i = 0; i < M; i++)
        now->u[i] = map[(BG_AT_u + i) * BG_MAP_COLUMNS + column];
    for (int i = 0; i < ROWS; i++)
        now->y[i] = map[(BG_AT_y + i) * BG_MAP_COLUMNS + column];
    for (int i = 0; i < BG_EXTERNAL; i++)
        now->w[i] = column == BG_SIZE + i;
    now->t = 0.0;
    bg_guards(now, guards);
    for (int g = 0; g < BG_GUARDS && column < BG_MAP_COLUMNS - 1; g++)
        guards[g] -= constant[g];
}

static void forget_instant(bg_model *m)
{
    double p[BG_ROOM(BG_PARAMETERS)];
    memcpy(p, m->now.p, sizeof p);
    memset(&m->now, 0, sizeof m->now);
    memcpy(m->now.p, p, sizeof p);
}

/* What keeps switches, and where friction slips forwards what they do as they come to hold. */
static void fill_switches(ex_mode *made, const double *map, bg_model *m, const int *mode)
{
    double constant[BG_ROOM(BG_GUARDS)] = {0}, guards[BG_ROOM(BG_GUARDS)] = {0};
    double impulses[PORTS * PORTS], received[BG_ROOM(ROWS)];
    bg_hold *held = NULL;
    int forwards = 1;
    forget_instant(m);
    bg_guards(&m->now, constant);
    for (int j = 0; j < EX_L; j++) {
        const int column = column_of(j);
        if (column < 0)
            continue;
        guards_in(map, m, column, constant, guards);
        for (int k = 0; k < EX_K; k++)
            if (bg_switches[k].kind != BG_RUBS)
                made->stay[j][k] = bg_stay(bg_switches + k, mode[k], made->shot[j][EX_AT_SLIP + k],
                                           made->shot[j][EX_AT_EFFORT + k], guards);
    }
    for (int k = 0; k < EX_K; k++)
        forwards &= bg_switches[k].kind != BG_RUBS || mode[k] == 1;
    forget_instant(m);
    if (!forwards || bg_impulses(m, mode, &held, impulses) != BG_OK || !held)
        return;
    for (int k = 0; k < held->kept; k++) {
        bg_pass_on(m, impulses + k * K, made->jump[k], received);
        bg_shocks(m, mode, impulses + k * K, received, made->shock[k]);
    }
}

static void fill_readers(const batch_job *job, const double *map, double (*readers)[EX_L])
{
    for (int s = 0; s < job->signals + job->factors; s++)
        for (int j = 0; j < EX_L; j++) {
            const int row = job->signal[s], column = column_of(j);
            if (row < 0)
                readers[s][j] = j == EX_N - 1 - row;
            else
                readers[s][j] = column < 0 ? 0.0 : map[row * BG_MAP_COLUMNS + column];
        }
}

/* The next place, or that of the mode that was asked for longest ago. */
static int place_for(batch_room *room)
{
    const unsigned looks = room->context->looks;
    int oldest = 0;
    if (room->record.count < EX_MODES)
        return room->record.count++;
    for (int k = 1; k < EX_MODES; k++)
        if (looks - room->used[k] > looks - room->used[oldest])
            oldest = k;
    return oldest;
}

int batch_supply(void *self, const int *mode)
{
    batch_room *const room = self;
    batch_instance *const own = room->model;
    bg_hold *held = NULL;
    const enum batch_found found = batch_model_mode(own, mode, &held);
    if (found == BATCH_MODE_REFUSED)
        return BG_NOT_AFFINE;
    const int at = place_for(room);
    ex_mode *const made = room->mode + at;
    memset(made, 0, sizeof *made);
    if (found != BATCH_MODE_NONE)
        fill(made, own->map, &own->m.numbers, held);
    if (found == BATCH_MODE_WHOLE && BG_SWITCHES)
        fill_switches(made, own->map, &own->m, mode);
    made->none = found == BATCH_MODE_NONE;
    made->supported = found == BATCH_MODE_WHOLE;
    find_fastest(room, at);
    if (found == BATCH_MODE_WHOLE)
        fill_readers(room->job, own->map, batch_readers(room, made));
    room->known[at] = made;
    room->keys[at] = room->context->where;
    room->used[at] = room->context->looks;
    return BG_OK;
}
