/* The generated model as the batch of runs uses it. Friction that acts back on nothing at once, and
 * that no law reads, moves inputs, readings and rates alone: then every mode's map follows from that
 * of slipping forwards. */
#include "batch_model.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "batch_doubt.h"

int batch_model_begin(batch_instance *own, const double *parameters)
{
    bg_model *const m = &own->m;
    int status = BG_OK;
    memset(m, 0, sizeof *m); /* as bg_model_init does, which also prepares what is not used here */
    own->based = 0;
    m->where = -1;
    memcpy(m->now.p, parameters, sizeof(double) * BG_PARAMETERS);
    status = bg_finite(BG_PARAMETERS, m->now.p) ? bg_assemble(m) : BG_PARAMETER;
    return status == BG_OK && batch_doubtful(m) ? BG_SINGULAR : status;
}

/* to += factor row */
static void add(double factor, const double *row, double *to)
{
    for (int j = 0; j < BG_MAP_COLUMNS && factor != 0.0; j++)
        to[j] += factor * row[j];
}

/* to += a rows, where a has `count` columns */
static void add_rows(int rows, int count, const double *a, batch_row *from, batch_row *to)
{
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < count; j++)
            add(a[i * count + j], from[j], to[i]);
}

/* The effort at a port moves inputs, readings and rates. */
static void push_port(const bg_numbers *a, int port, double factor, const double *effort, batch_map *map)
{
    const int column = bg_friction_inputs[port];
    add(factor, effort, map->u[column]);
    for (int i = 0; i < ROWS; i++)
        add(factor * a->D[i * M + column], effort, map->y[i]);
    for (int i = 0; i < N; i++)
        add(factor * a->Q[i * M + column], effort, map->rate[i]);
}

static void put_column(int count, const double *values, int column, batch_row *to)
{
    for (int i = 0; i < count; i++)
        to[i][column] = values[i];
}

/* Evaluates the model where component `at` of [s, w, dw] is BG_FAR and all others are 0. */
static int probe_column(bg_model *m, const int *mode, int at, batch_map *map)
{
    double point[BG_MAP_COLUMNS] = {0};
    const bg_snapshot *const shot = &m->shot;
    point[at] = at < BG_MAP_COLUMNS - 1 ? BG_FAR : 0.0;
    const int status = bg_evaluate(m, 0.0, point, point + BG_SIZE, point + BG_SIZE + BG_EXTERNAL,
                                   mode, 0, &m->shot);
#define PUT(part, count) put_column(count, shot->part, at, map->part);
    BG_PARTS(PUT)
#undef PUT
    return status;
}

/* Where no law has a rate and inputs drive no storage, rates of inputs show in nothing else. */
static void pass_rates(batch_map *map)
{
    for (int i = 0; i < BG_OUTSIDE; i++)
        map->du[bg_outside_inputs[i]][BG_SIZE + BG_EXTERNAL + i] = 1.0;
}

/* Readings and rates from states and inputs: not by taking friction away, which would leave
 * rounding where there is nothing. */
static void show_all(const bg_numbers *a, batch_map *map)
{
    memset(map->y, 0, sizeof map->y);
    memset(map->rate, 0, sizeof map->rate);
    add_rows(ROWS, N, a->F, map->x, map->y);
    add_rows(ROWS, M, a->D, map->u, map->y);
    add_rows(ROWS, M, a->G, map->du, map->y);
    add_rows(N, N, a->P, map->x, map->rate);
    add_rows(N, M, a->Q, map->u, map->rate);
}

/* A mode's map from the model at as many points. */
static int probe_mode(bg_model *m, const int *mode, batch_map *map)
{
    const int last = BG_MAP_COLUMNS - 1, rates = BG_RATED || BG_DRIVEN;
    batch_row *const rows = map->x;
    int status;
    memset(map, 0, sizeof *map);
    status = probe_column(m, mode, last, map);
    for (int j = 0; j < (rates ? last : BG_SIZE + BG_EXTERNAL) && status == BG_OK; j++) {
        status = probe_column(m, mode, j, map);
        for (size_t i = 0; i < sizeof *map / sizeof *rows; i++)
            rows[i][j] = (rows[i][j] - rows[i][last]) / BG_FAR;
    }
    if (!rates)
        pass_rates(map);
    return status;
}

static int find_base(batch_instance *own)
{
    int forward[BG_ROOM(K)];
    for (int i = 0; i < BG_ROOM(K); i++)
        forward[i] = 1;
    const int status = probe_mode(&own->m, forward, &own->base);
    for (int k = 0; k < K; k++) {
        memcpy(own->forward[k], own->base.u[bg_friction_inputs[k]], sizeof(batch_row));
        memset(own->base.u[bg_friction_inputs[k]], 0, sizeof(batch_row));
    }
    show_all(&own->m.numbers, &own->base);
    own->based = status == BG_OK;
    return status;
}

/* Takes away what rounding would make of slips that stick, or they drifted. */
static void correct(const bg_hold *held, batch_map *map)
{
    batch_row drift[BG_ROOM(K)];
    memset(drift, 0, sizeof drift);
    add_rows(held->kept, N, held->slip_x, map->rate, drift);
    add_rows(held->kept, M, held->fixed, map->du, drift);
    add_rows(N, held->kept, held->take_away, drift, map->rate);
}

static void hold_ports(const bg_numbers *a, const bg_hold *held, batch_map *map)
{
    batch_row right[BG_ROOM(K)], efforts[BG_ROOM(K)];
    memset(right, 0, sizeof right);
    memset(efforts, 0, sizeof efforts);
    add_rows(held->count, N, held->X, map->x, right);
    add_rows(held->count, M, held->U, map->u, right);
    add_rows(held->count, M, held->V, map->du, right);
    add_rows(held->count, held->count, held->inverse, right, efforts);
    for (int r = 0; r < held->count; r++)
        push_port(a, held->ports[r], -1.0, efforts[r], map);
    for (int turn = 0; turn < 2; turn++) /* the second, of what rounding the first has left */
        correct(held, map);
}

static void show_law_rates(batch_map *map)
{
    for (int i = 0; i < OWN; i++)
        memcpy(map->rate[N + i], map->y[bg_law_rates[i]], sizeof(batch_row));
}

/* A mode's map from the model itself, for laws that read what friction gives. */
static int read_late(batch_instance *own, const int *mode, const bg_hold *held, batch_map *map)
{
    const int status = probe_mode(&own->m, mode, map);
    show_all(&own->m.numbers, map);
    for (int turn = 0; turn < 2 && held; turn++)
        correct(held, map);
    show_law_rates(map);
    return status;
}

/* A mode's map from the base; by rows. */
static void combine(const batch_instance *own, const int *mode, const bg_hold *held, batch_map *map)
{
    const bg_numbers *const a = &own->m.numbers;
    memcpy(map, &own->base, sizeof *map);
    for (int k = 0; k < K; k++)
        push_port(a, k, mode[k], own->forward[k], map);
    if (held)
        hold_ports(a, held, map);
    show_law_rates(map);
}

static double *copy(double *to, int count, batch_row *rows)
{
    memcpy(to, rows, sizeof(batch_row) * (size_t)count);
    return to + count * BG_MAP_COLUMNS;
}

/* The parts one after the other, without the room of those that are empty. */
static void flatten(batch_map *map, double *matrix)
{
#define COPY(part, count) matrix = copy(matrix, count, map->part);
    BG_PARTS(COPY)
#undef COPY
}

/* Redundant ports share a load, and that is not affine; but what rules their slips does not depend
 * on what they give. */
static enum batch_found slips_alone(batch_instance *own, const int *mode)
{
    int slipping[BG_ROOM(K)] = {0};
    for (int i = 0; i < K; i++)
        slipping[i] = mode[i] ? mode[i] : 1;
    combine(own, slipping, NULL, &own->parts);
    flatten(&own->parts, own->map);
    return BATCH_MODE_SLIPS;
}

enum batch_found batch_model_mode(batch_instance *own, const int *mode, bg_hold **held)
{
    int sticking = 0, status = BG_AFFINE ? BG_OK : BG_NOT_AFFINE;
    for (int i = 0; i < K; i++)
        sticking |= mode[i] == 0;
    *held = NULL;
    if (status == BG_OK && sticking)
        status = bg_hold_of(&own->m, mode, held);
    if (status == BG_NO_HOLD)
        return BATCH_MODE_NONE;
    const int shares = status == BG_OK && *held && bg_shares(*held);
    const int late = BG_EARLY < BG_GROUPS && !shares;
    if (status == BG_OK && late)
        status = read_late(own, mode, *held, &own->parts);
    else if (status == BG_OK && !own->based)
        status = find_base(own);
    if (status != BG_OK || (shares && (*held)->ruled == 0))
        return BATCH_MODE_REFUSED;
    if (shares)
        return slips_alone(own, mode);
    if (!late)
        combine(own, mode, *held, &own->parts);
    flatten(&own->parts, own->map);
    return BATCH_MODE_WHOLE;
}
