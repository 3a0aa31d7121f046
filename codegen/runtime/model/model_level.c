/* What counts as zero of friction levels: rounding of the terms that make them up. A term is the
 * effect of a small relative change of one number that is read, divided by the change. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "port_choose.h"
#include "model_internal.h"

enum {
    READ = offsetof(bg_values, tables) / sizeof(double),
    MORE_TERMS = 4 * K > BG_LARGEST ? 4 * K : BG_LARGEST,
    MOST_TERMS = BG_GUARDS > MORE_TERMS ? BG_GUARDS : MORE_TERMS
};

/* The sum of the magnitudes of the terms of each result; what is read is as large as in `sizes`. */
static void terms_of(bg_model *m, bg_block *block, int count, const double *sizes, double *terms)
{
    double *const read = (double *)&m->now;
    double values[BG_ROOM(MOST_TERMS)] = {0}, moved[BG_ROOM(MOST_TERMS)] = {0};
    block(&m->now, values);
    for (int k = 0; k < count; k++)
        terms[k] = fabs(values[k]);
    for (int j = 0; j < READ; j++) {
        const double kept = read[j];
        if (sizes[j] == 0.0)
            continue;
        read[j] = kept + copysign(BG_TERM * sizes[j], kept);
        block(&m->now, moved);
        read[j] = kept;
        for (int k = 0; k < count; k++) {
            const double term = fabs(moved[k] - values[k]) / BG_TERM;
            terms[k] += isfinite(term) ? term : 0.0;
        }
    }
}

/* Readings are as large as what they show of states and inputs. */
static void show(const bg_model *m, bg_values *sizes)
{
    for (int i = 0; i < ROWS; i++) {
        double sum = 0.0;
        for (int j = 0; j < N; j++)
            sum += fabs(m->numbers.F[i * N + j]) * sizes->x[j];
        for (int j = 0; j < M; j++) {
            sum += fabs(m->numbers.D[i * M + j]) * sizes->u[j];
            sum += fabs(m->numbers.G[i * M + j]) * fabs(m->du[j]);
        }
        sizes->y[i] = sum;
    }
}

/* What laws give is as large as their own terms. */
static void give(bg_model *m, const bg_group *group, bg_values *sizes)
{
    double terms[BG_ROOM(MOST_TERMS)] = {0};
    show(m, sizes);
    terms_of(m, group->values, group->count, (const double *)sizes, terms);
    for (int k = 0; k < group->count; k++)
        sizes->u[group->inputs[k]] = terms[k];
}

/* How large what is read has been. */
static void measure(bg_model *m)
{
    bg_values *const sizes = &m->work.sizes;
    const double *const read = (const double *)&m->now;
    double *const size = (double *)sizes;
    for (int j = 0; j < READ; j++)
        size[j] = fabs(read[j]);
    for (int i = 0; i < N; i++)
        sizes->x[i] = fmax(sizes->x[i], m->seen[i]);
    for (int i = 0; i < BG_LAW_STATES; i++)
        sizes->z[i] = fmax(sizes->z[i], m->seen[N + i]);
}

void bg_without_rounding(bg_model *m, double *values)
{
    bg_values *const sizes = &m->work.sizes;
    double *const size = (double *)sizes, terms[BG_ROOM(MOST_TERMS)] = {0};
    measure(m);
    give(m, &bg_known, sizes);
    for (int g = 0; g < BG_GROUPS; g++)
        give(m, &bg_groups[g], sizes);
    give(m, &bg_coupled, sizes);
    show(m, sizes);
    terms_of(m, bg_friction_values, 4 * K, size, terms);
    for (int i = 0; i < 4 * K; i++)
        if (values[i] < 0.0 && values[i] >= -BG_ROUNDING * terms[i])
            values[i] = 0.0;
}

/* How fast conditions change: by a difference over a moment, of what states and inputs do in it. */
static void find_slopes(bg_model *m, const bg_snapshot *shot, double *slopes)
{
    const bg_values kept = m->now;
    bg_values *const now = &m->now;
    double before[BG_ROOM(BG_GUARDS)] = {0}, after[BG_ROOM(BG_GUARDS)] = {0};
    const double moment = BG_GUARD_MOMENT * fmax(fabs(kept.t), BG_GUARD_FLOOR);
    bg_guards(now, before);
    now->t += moment;
    for (int j = 0; j < BG_EXTERNAL; j++)
        now->w[j] += moment * kept.dw[j];
    for (int i = 0; i < N; i++) {
        now->x[i] += moment * shot->rate[i];
        for (int k = 0; k < ROWS; k++)
            now->y[k] += moment * m->numbers.F[k * N + i] * shot->rate[i];
    }
    for (int i = 0; i < BG_LAW_STATES; i++)
        now->z[i] += moment * shot->rate[N + i];
    for (int j = 0; j < M; j++) {
        now->u[j] += moment * shot->du[j];
        for (int k = 0; k < ROWS; k++)
            now->y[k] += moment * m->numbers.D[k * M + j] * shot->du[j];
    }
    bg_guards(now, after);
    *now = kept;
    for (int g = 0; g < BG_GUARDS; g++)
        slopes[g] = isfinite(after[g] - before[g]) ? fabs(after[g] - before[g]) / moment : 0.0;
}

void bg_guard_terms(bg_model *m, const bg_snapshot *shot, double time, double *terms,
                    double *slopes)
{
    bg_values *const sizes = &m->work.sizes;
    const bg_numbers *const a = &m->numbers;
    double moved[BG_ROOM(N)] = {0};
    measure(m);
    /* At rest a state is rounding itself: of what moves it within a time constant. */
    for (int i = 0; i < N; i++) {
        for (int j = 0; j < N; j++)
            moved[i] += fabs(a->P[i * N + j]) * fabs(m->now.x[j]);
        for (int j = 0; j < M; j++)
            moved[i] += fabs(a->Q[i * M + j]) * fabs(m->now.u[j]);
    }
    for (int i = 0; i < N; i++)
        sizes->x[i] = fmax(sizes->x[i], time * moved[i]);
    show(m, sizes);
    terms_of(m, bg_guards, BG_GUARDS, (const double *)sizes, terms);
    find_slopes(m, shot, slopes);
}

void bg_told_terms(bg_model *m, double *terms)
{
    measure(m);
    show(m, &m->work.sizes);
    terms_of(m, bg_guards, BG_GUARDS, (const double *)&m->work.sizes, terms);
}

void bg_have_seen(bg_model *m, const double *s)
{
    for (int i = 0; i < N + BG_LAW_STATES; i++)
        m->seen[i] = fmax(m->seen[i], fabs(s[i]));
}
