/* From a model's affine maps to the engine's records. */
#include "batch_internal.h"

#include <string.h>

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
    made->fastest = batch_fastest(own, made->weight);
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
        const int column = batch_column_of(j);
        if (column < 0)
            continue;
        fill_column(map, a, column, made->shot[j]);
        for (int k = 0; k < made->held; k++)
            made->left[j][k] = product(map, 0, N, held->slip_x + k * N, column)
                               + product(map, BG_AT_u, M, held->slip_u + k * M, column);
    }
}

static void fill_readers(const batch_job *job, const double *map, double (*readers)[EX_L])
{
    for (int s = 0; s < job->signals + job->factors; s++)
        for (int j = 0; j < EX_L; j++) {
            const int row = job->signal[s], column = batch_column_of(j);
            if (row < 0)
                readers[s][j] = j == EX_N - 1 - row;
            else
                readers[s][j] = column < 0 ? 0.0 : map[row * BG_MAP_COLUMNS + column];
        }
}

/* The next place, or that of the mode that was asked for longest ago. */
static int place_for(batch_room *room)
{
    int oldest = 0;
    if (room->record.count < EX_MODES)
        return room->record.count++;
    for (int k = 1; k < EX_MODES; k++)
        if (room->used[k] < room->used[oldest])
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
    if (found == BATCH_MODE_WHOLE && (BG_SWITCHES || BG_HUNG || BG_RESETS))
        batch_fill_switches(made, own->map, &own->m, mode);
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
