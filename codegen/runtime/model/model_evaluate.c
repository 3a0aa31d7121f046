/* Every variable at one time, state and friction mode, law by law. */
#include <math.h>
#include <string.h>

#include "model_internal.h"

/* Adds a x to y, nothing where an entry is zero: infinite efforts have finite effects where laws
 * bound these, as the affinity of what is used up. */
static void multiply_unbounded(int rows, int columns, const double *a, const double *x, double *y)
{
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < columns; j++)
            if (a[i * columns + j] != 0.0)
                y[i] += a[i * columns + j] * x[j];
}

/* Adds to inputs, and to the readings that show them at once. */
void bg_give(bg_model *m, int count, const int *columns, const double *values)
{
    for (int k = 0; k < count; k++)
        m->now.u[columns[k]] += values[k];
    if (!bg_finite(count, values)) {
        double more[BG_ROOM(M)] = {0};
        for (int k = 0; k < count; k++)
            more[columns[k]] += values[k];
        multiply_unbounded(ROWS, M, m->numbers.D, more, m->now.y);
        return;
    }
    /* by the list only where it is shorter than the columns */
    if (BG_LISTED(ROWS, M) && m->numbers.D_list[0] && count * ROWS > m->numbers.D_list[ROWS]) {
        memset(m->work.more, 0, sizeof m->work.more);
        for (int k = 0; k < count; k++)
            m->work.more[columns[k]] += values[k];
        bg_multiply_listed(ROWS, M, m->numbers.D, m->numbers.D_list, m->work.more, m->now.y);
        return;
    }
    for (int i = 0; i < ROWS; i++) {
        double sum = 0.0;
        for (int k = 0; k < count; k++)
            sum += m->numbers.D[i * M + columns[k]] * values[k];
        m->now.y[i] += sum;
    }
}

/* What friction values are where they are checked, as laws are: beyond a corner those of its other
 * side may be below zero. */
static int checked_values(bg_model *m, double *values)
{
    const double sided = m->now.sided;
    int below = 0;
    m->now.sided = 0.0;
    bg_friction_values(&m->now, values);
    for (int i = 0; i < 4 * K; i++)
        below |= values[i] < 0.0;
    if (below)
        bg_without_rounding(m, values);
    m->now.sided = sided;
    for (int i = 0; i < K; i++) {
        const double *const of = values + 4 * i;
        if (of[0] < 0 || of[2] < 0 || of[1] < of[0] * of[3] * (1 - BG_BREAKAWAY)) {
            m->where = i;
            return BG_BAD_FRICTION;
        }
    }
    return BG_OK;
}

/* Slipping ports' efforts, zero at sticking ones; notes every port's breakaway effort. */
static int efforts_against(bg_model *m, const int *mode, int checked, double *efforts)
{
    double values[4 * BG_ROOM(K)] = {0};
    const int status = checked ? checked_values(m, values) : BG_OK;
    if (!checked || m->now.sided > 0.0)
        bg_friction_values(&m->now, values);
    for (int i = 0; i < K; i++) {
        m->caps[i] = values[4 * i + 1];
        efforts[i] = values[4 * i] * values[4 * i + 2] * mode[i];
    }
    return status;
}

static int friction_residual(bg_model *m, const bg_loop *loop, double *left)
{
    const bg_hold *const held = loop->held;
    double against[BG_ROOM(K)] = {0}, rule[BG_ROOM(K)] = {0};
    const int status = efforts_against(m, loop->mode, loop->checked, against);
    int ruled;
    for (int i = 0; i < K; i++)
        left[i] = m->now.u[bg_friction_inputs[i]] - against[i];
    if (held) {
        ruled = held->count - held->share_count;
        bg_multiply_listed(ruled, N, held->X, held->X_list, m->now.x, rule);
        bg_multiply_listed(ruled, M, held->U, held->U_list, m->now.u, rule);
        bg_multiply_listed(ruled, M, held->V, held->V_list, m->du, rule);
        for (int r = 0; r < held->share_count; r++)
            for (int c = 0; c < held->count; c++)
                rule[ruled + r] += held->share[r * held->count + c]
                    * m->now.u[bg_friction_inputs[held->ports[c]]];
        for (int r = 0; r < held->count; r++)
            left[held->ports[r]] = rule[r];
    }
    bg_coupled.values(&m->now, m->work.law);
    for (int i = 0; i < bg_coupled.count; i++)
        left[K + i] = m->now.u[bg_coupled.inputs[i]] - m->work.law[i];
    return status;
}

int bg_residual(bg_model *m, const bg_loop *loop, double *left)
{
    if (!loop->group)
        return friction_residual(m, loop, left);
    loop->group->values(&m->now, m->work.law);
    for (int i = 0; i < loop->count; i++)
        left[i] = m->now.u[loop->columns[i]] - m->work.law[i];
    return BG_OK;
}

/* Evaluates one group of laws, or solves it if it is a loop. */
static int evaluate_group(bg_model *m, const bg_group *group)
{
    if (!group->loop) {
        group->values(&m->now, m->work.law);
        bg_give(m, group->count, group->inputs, m->work.law);
        return BG_OK;
    }
    bg_loop loop = {group, NULL, NULL, group->count, 0, {0}, {0}};
    memcpy(loop.columns, group->inputs, sizeof(int) * (size_t)group->count);
    memcpy(loop.rows, group->readings, sizeof(int) * (size_t)group->count);
    return bg_solve_loop(m, &loop);
}

/* Friction efforts that act back on slips or laws at once: all solved together. */
static int rub_jointly(bg_model *m, const int *mode, bg_hold *held, int checked)
{
    bg_loop loop = {NULL, mode, held, K + BG_COUPLED, checked, {0}, {0}};
    double efforts[BG_ROOM(K)] = {0}, caps[BG_ROOM(K)] = {0};
    int status, columns[BG_ROOM(K)] = {0};
    for (int i = 0; i < K; i++) {
        loop.columns[i] = bg_friction_inputs[i];
        loop.rows[i] = bg_friction_readings[i];
    }
    for (int i = 0; i < BG_COUPLED; i++) {
        loop.columns[K + i] = bg_coupled.inputs[i];
        loop.rows[K + i] = bg_coupled.readings[i];
    }
    status = bg_solve_loop(m, &loop);
    if (status != BG_OK || !held || held->share_count == 0)
        return status;
    for (int r = 0; r < held->count; r++) {
        columns[r] = bg_friction_inputs[held->ports[r]];
        efforts[r] = m->now.u[columns[r]];
        caps[r] = m->caps[held->ports[r]];
    }
    status = bg_fair_share(held, caps, efforts);
    if (status != BG_OK)
        return status;
    for (int r = 0; r < held->count; r++)
        efforts[r] -= m->now.u[columns[r]];
    bg_give(m, held->count, columns, efforts);
    return BG_OK;
}

/* The friction efforts of a mode: against the slip, or whatever holds. */
static int rub(bg_model *m, const int *mode, bg_hold *held, int checked)
{
    double efforts[BG_ROOM(K)] = {0}, holding[BG_ROOM(K)] = {0};
    int status;
    if (BG_JOINT)
        return rub_jointly(m, mode, held, checked);
    status = efforts_against(m, mode, checked, efforts);
    if (status != BG_OK)
        return status;
    for (int i = 0; i < K; i++)
        m->now.u[bg_friction_inputs[i]] = efforts[i];
    if (held) {
        status = bg_holding_efforts(m, held, holding);
        if (status != BG_OK)
            return status;
        for (int r = 0; r < held->count; r++)
            efforts[held->ports[r]] = holding[r];
    }
    for (int i = 0; i < K; i++)
        m->now.u[bg_friction_inputs[i]] = 0.0;
    bg_give(m, K, bg_friction_inputs, efforts);
    return BG_OK;
}

/* Time, states, external inputs and known laws; x and readings as far as these determine them. */
static int begin(bg_model *m, double t, const double *s, const double *w, const double *dw)
{
    bg_values *const now = &m->now;
    int status = BG_OK;
    now->t = t;
    memcpy(now->x, s, sizeof(double) * N);
    memcpy(now->z, s + N, sizeof(double) * OWN);
    memset(now->u, 0, sizeof now->u);
    memset(now->y, 0, sizeof now->y);
    memset(m->du, 0, sizeof m->du);
    for (int i = 0; i < BG_EXTERNAL; i++) {
        now->w[i] = w[i];
        now->dw[i] = dw ? dw[i] : 0.0;
    }
    for (int i = 0; i < BG_OUTSIDE; i++) {
        now->u[bg_outside_inputs[i]] = now->w[i];
        m->du[bg_outside_inputs[i]] = now->dw[i];
    }
    bg_known.values(now, m->work.law);
    for (int i = 0; i < bg_known.count; i++)
        now->u[bg_known.inputs[i]] = m->work.law[i];
    if (BG_RATED) {
        bg_known_rates(now, m->work.law);
        for (int i = 0; i < bg_known.count; i++)
            m->du[bg_known.inputs[i]] = m->work.law[i];
    }
    if (BG_VARYING) {
        for (int i = 0; i < BG_HOLDS; i++)
            m->holds[i].ready = 0;
        status = bg_assemble(m);
    } else if (BG_DRIVEN) {
        bg_multiply_add(N, M, m->numbers.R, now->u, now->x);
    }
    bg_multiply_listed(ROWS, N, m->numbers.F, m->numbers.F_list, now->x, now->y);
    bg_multiply_listed(ROWS, M, m->numbers.D, m->numbers.D_list, now->u, now->y);
    if (BG_RATED)
        bg_multiply_listed(ROWS, M, m->numbers.G, m->numbers.G_list, m->du, now->y);
    return status;
}

/* The groups of laws from one up to another. */
static int evaluate_groups(bg_model *m, int from, int to)
{
    int status = BG_OK;
    for (int g = from; g < to && status == BG_OK; g++) {
        status = evaluate_group(m, &bg_groups[g]);
        if (status != BG_OK)
            m->where = g;
    }
    return status;
}

/* The rate of s, and all else as a snapshot. */
static int finish(bg_model *m, const bg_hold *held, bg_snapshot *shot)
{
    const bg_values *const now = &m->now;
    memset(shot->rate, 0, sizeof shot->rate);
    bg_multiply_listed(N, N, m->numbers.P, m->numbers.P_list, now->x, shot->rate);
    const int bounded = bg_finite(M, now->u);
    if (bounded)
        bg_multiply_listed(N, M, m->numbers.Q, m->numbers.Q_list, now->u, shot->rate);
    else
        multiply_unbounded(N, M, m->numbers.Q, now->u, shot->rate);
    if (BG_VARYING)
        bg_multiply_add(N, M, m->numbers.R, m->du, shot->rate);
    for (int i = 0; i < OWN; i++)
        shot->rate[N + i] = now->y[bg_law_rates[i]];
    if (held)
        bg_correct(held, shot->rate, m->du, now->y);
    memcpy(shot->x, now->x, sizeof shot->x);
    memcpy(shot->z, now->z, sizeof shot->z);
    memcpy(shot->u, now->u, sizeof shot->u);
    memcpy(shot->du, m->du, sizeof shot->du);
    memcpy(shot->y, now->y, sizeof shot->y);
    memcpy(shot->caps, m->caps, sizeof shot->caps);
    /* Efforts may be infinite, but are numbers; what holds and what rubs is told by finite ones. */
    for (int i = 0; i < M && !bounded; i++)
        if (shot->u[i] != shot->u[i])
            return BG_NOT_FINITE;
    if (K > 0 && !(bounded && bg_finite(ROWS, shot->y)))
        return BG_NOT_FINITE;
    if (!bg_finite(BG_SIZE, shot->rate))
        return BG_NOT_FINITE;
    return BG_OK;
}

static int evaluate(bg_model *m, double t, const double *s, const double *w, const double *dw,
                    const int *mode, int checked, bg_snapshot *shot)
{
    bg_hold *held = NULL;
    int status = begin(m, t, s, w, dw), sticking = 0;
    m->where = -1;
    if (status == BG_OK)
        status = evaluate_groups(m, 0, BG_EARLY);
    for (int i = 0; i < K; i++)
        sticking |= mode[i] == 0;
    if (status == BG_OK && sticking)
        status = bg_hold_of(m, mode, &held);
    if (status == BG_OK && K > 0)
        status = rub(m, mode, held, checked);
    /* Laws that only read what friction gives. */
    if (status == BG_OK)
        status = evaluate_groups(m, BG_EARLY, BG_GROUPS);
    return status == BG_OK ? finish(m, held, shot) : status;
}

/* Where a law has no value beyond a corner, as sqrt(|p|) beyond zero, it is the law as it is. */
int bg_evaluate(bg_model *m, double t, const double *s, const double *w, const double *dw,
                const int *mode, int checked, bg_snapshot *shot)
{
    const double sided = m->now.sided;
    int status = evaluate(m, t, s, w, dw, mode, checked, shot);
    if (status == BG_OK || !(sided > 0.0))
        return status;
    m->now.sided = 0.0;
    status = evaluate(m, t, s, w, dw, mode, checked, shot);
    m->now.sided = sided;
    return status;
}

int bg_model_evaluate(bg_model *m, double t, const double *s, const double *w, const double *dw,
                      const int *mode, bg_snapshot *shot)
{
    for (int i = 0; i < K; i++)
        if (mode[i] < -1 || mode[i] > 1)
            return BG_BAD_MODE;
    return bg_evaluate(m, t, s, w, dw, mode, 1, shot);
}
