/* An instance: its parameters, its vector, its affine maps, and what a status means. */
#include <math.h>
#include <string.h>

#include "model_internal.h"

void bg_model_parameters(double *parameters)
{
    memcpy(parameters, bg_defaults, sizeof(double) * BG_PARAMETERS);
}

int bg_model_init(bg_model *m, const double *parameters)
{
    return bg_model_init_with(m, parameters, NULL);
}

int bg_model_init_with(bg_model *m, const double *parameters, const bg_own_tables *own)
{
    int status;
    memset(m, 0, offsetof(bg_model, memory));
    memset(&m->memory.is, 0, sizeof m->memory.is);
    m->where = -1;
    m->ticked = -INFINITY;
    m->now.tables = own ? own->tables : bg_tables;
    memcpy(m->now.p, parameters ? parameters : bg_defaults, sizeof(double) * BG_PARAMETERS);
    if (!bg_finite(BG_PARAMETERS, m->now.p))
        return BG_PARAMETER;
    for (int i = 0; i < K; i++) {
        m->band[i] = BG_BAND;
        m->mode[i] = bg_first_modes[i];
    }
    status = BG_DELAYS ? bg_set_lags(m) : BG_OK;
    if (BG_VARYING || status != BG_OK)
        return status;
    status = bg_assemble(m);
    if (status == BG_OK && BG_STRAIGHT)
        bg_prepare_rhs(m);
    return status;
}

int bg_model_vector(bg_model *m, double t, const double *states, const double *w, double *s)
{
    int mode[BG_ROOM(K)], status;
    double driven[BG_ROOM(N)] = {0};
    s[0] = 0.0;
    memcpy(s, states, sizeof(double) * (N + OWN));
    if (!BG_DRIVEN || BG_VARYING)
        return BG_OK;
    for (int i = 0; i < BG_ROOM(K); i++)
        mode[i] = 1;
    if (BG_DELAYS) {
        memcpy(m->work.recalled, w, sizeof(double) * BG_EXTERNAL);
        bg_model_recall(m, t, m->work.recalled, NULL);
        w = m->work.recalled;
    }
    status = bg_model_evaluate(m, t, s, w, NULL, mode, &m->shot);
    if (status != BG_OK)
        return status;
    bg_multiply_add(N, M, m->numbers.R, m->shot.u, driven);
    for (int i = 0; i < N; i++)
        s[i] -= driven[i];
    return BG_OK;
}

int bg_model_complete(bg_model *m, double t, const double *w, const int *named, double *s)
{
    return bg_complete(m, t, w, named, m->mode, s);
}

int bg_model_switched(int port, int mode)
{
    const bg_switch *const s = bg_switches + port;
    return s->kind == BG_RUBS || s->slides || s->machine ? -1 : s->on == (mode == 0);
}

void bg_model_outputs(const bg_snapshot *shot, double *outputs)
{
    for (int i = 0; i < BG_OUTPUTS; i++)
        outputs[i] = shot->y[bg_output_readings[i]];
}

/* Probes the model where one component of [s, w, dw] is BG_FAR and all others are 0. */
static int probe(bg_model *m, const int *mode, int at, double *column)
{
    int status;
    memset(m->work.point, 0, sizeof m->work.point);
    memset(m->work.external, 0, sizeof m->work.external);
    if (at >= BG_SIZE + BG_EXTERNAL)
        m->work.external[1][at - BG_SIZE - BG_EXTERNAL] = BG_FAR;
    else if (at >= BG_SIZE)
        m->work.external[0][at - BG_SIZE] = BG_FAR;
    else if (at >= 0)
        m->work.point[at] = BG_FAR;
    status = bg_evaluate(m, 0.0, m->work.point, m->work.external[0], m->work.external[1], mode, 0,
                         &m->shot);
#define PUT(part, count) column = bg_put(column, count, m->shot.part);
    BG_PARTS(PUT)
#undef PUT
    return status;
}

/* Slips that stick must not drift by the rounding of the matrix either. */
static void correct_map(const bg_hold *held, bg_work *work, double *matrix)
{
    for (int j = 0; j < BG_MAP_COLUMNS; j++) {
        for (int i = 0; i < BG_SIZE; i++)
            work->point[i] = matrix[(BG_AT_rate + i) * BG_MAP_COLUMNS + j];
        for (int i = 0; i < M; i++)
            work->u[i] = matrix[(BG_AT_du + i) * BG_MAP_COLUMNS + j];
        bg_correct(held, work->point, work->u, work->y);
        for (int i = 0; i < BG_SIZE; i++)
            matrix[(BG_AT_rate + i) * BG_MAP_COLUMNS + j] = work->point[i];
    }
}

int bg_model_affine_map(bg_model *m, const int *mode, double *matrix)
{
    double column[BG_MAP_ROWS];
    bg_hold *held = NULL;
    int status = BG_AFFINE ? BG_OK : BG_NOT_AFFINE, sticking = 0;
    for (int i = 0; i < K; i++)
        sticking |= mode[i] == 0;
    if (status == BG_OK && sticking)
        status = bg_hold_of(m, mode, &held);
    if (status == BG_OK && held && bg_shares(held))
        status = BG_NOT_AFFINE;
    if (status == BG_OK)
        status = probe(m, mode, -1, m->work.origin);
    for (int j = 0; j < BG_MAP_COLUMNS && status == BG_OK; j++) {
        const int last = j == BG_MAP_COLUMNS - 1;
        if (!last)
            status = probe(m, mode, j, column);
        for (int i = 0; i < BG_MAP_ROWS; i++)
            matrix[i * BG_MAP_COLUMNS + j] =
                last ? m->work.origin[i] : (column[i] - m->work.origin[i]) / BG_FAR;
    }
    if (status == BG_OK && held)
        correct_map(held, &m->work, matrix);
    return status;
}

const char *bg_model_message(int status)
{
    static const char *const messages[] = {
        "no failure",
        "a parameter is not a finite number",
        "a coefficient is not finite at these parameters, states or inputs",
        "the matrix A is singular: a storage is zero, or storages cancel each other",
        "a law or a rate has no finite value",
        "laws that depend on one another have no solution; check them, or put a storage between",
        "a friction level or curve is negative, or a breakaway is below the friction at standstill",
        "sticking ports have no unique holding efforts: the storages or laws behind cancel",
        "how redundant ports that stick share a load was not found: exchanges of ports have no end",
        "these parameters change which friction ports are redundant; generate the model at them",
        "holding a port would need the slope in time of what a law gives of more than "
        "states and inputs",
        "this model, or this mode of it, is not one affine map",
        "a friction mode must be -1, 0 or 1",
        "no way of sticking and slipping is consistent",
        "events follow one another and time makes no progress",
        "the integrator no longer advances: the rates jump there",
        "more events than there is room for",
        "the step is too long: beyond the stability of its method at the model's fastest rates",
        "a step must be a positive finite number",
        "a stop begins beyond its bound; start its displacement within",
        "stops were struck too often in one instant, and what meets them still closes",
        "two ports reset one state to two values at once; let one of them do it",
        "a reset contradicts what a switch holds; reset all that it binds alike, or as it lets go",
        "resets set off one another without end; let what is set be away from where it is set off",
        "a value of a table, or what comes of it, is not a finite number",
        "which ports hold was not decided in a step's bounded number of pivots; the best way was "
        "taken",
        "the error of a step is beyond 1 % of a state's range; the step was taken: shorten it",
        "no impulse is found that keeps what nonlinear storages hold: their laws may have no value "
        "in common",
        "a step crosses more instants of tasks or breaks that come late than it may be cut at; "
        "shorten it",
        "a delay is no positive number of seconds, or what it gives first is not finite",
        "a delay reaches farther back than its memory does: steps leave no gap, and BG_MEMORY of "
        "config.h is how many parts it has",
    };
    const int count = (int)(sizeof messages / sizeof *messages);
    return status >= 0 && status < count ? messages[status] : "unknown status";
}

size_t bg_model_size(void)
{
    return sizeof(bg_model);
}
