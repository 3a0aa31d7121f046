/* Products of the rates' slopes J with a direction, by differences inside the mode of a step. */
#include <math.h>
#include <string.h>

#include "model_internal.h"

/* Weights near those of energy, by which states of any unit compare. A law's state is weighed by
 * the most that energy can drive it, at the limit's rate. */
void bg_weigh(bg_model *m, double h)
{
    const bg_numbers *const a = &m->numbers;
    bg_work *const work = &m->work;
    double *const moved = work->moved;
    for (int i = 0; i < N; i++)
        work->weight[i] = 1 / a->scale[i];
    for (int i = 0; i < OWN; i++) {
        const double *const row = a->F + bg_law_rates[i] * N;
        double driven = 0.0;
        memcpy(moved, row, sizeof(double) * N);
        bg_solve_storages(a, 1, moved);
        for (int j = 0; j < N; j++)
            driven += row[j] * moved[j];
        work->weight[N + i] = driven > 0 ? BG_REAL_LIMIT / (h * sqrt(driven)) : 1.0;
    }
}

/* a^T A b, A of the storages, of changes times their weights: in this product what conserves energy
 * turns vectors and does not stretch them. Where a storage is negative A is no measure. */
double bg_energy(const bg_model *m, const double *a, const double *b)
{
    const bg_pattern *const stored = &bg_layout[BG_A];
    const double *const scale = m->numbers.scale, *const entries = m->work.entries;
    double sum = 0.0;
    int positive = 1;
    for (int k = 0; k < stored->count; k++) {
        const int i = stored->rows[k], j = stored->columns[k];
        positive &= i != j || entries[k] > 0;
        sum += entries[k] * scale[i] * scale[j] * a[i] * b[j];
    }
    if (!positive)
        sum = 0.0;
    for (int i = positive ? N : 0; i < ALL; i++)
        sum += a[i] * b[i];
    return sum;
}

/* The magnitudes that differences are small against: of the states, and of what moves them. */
void bg_reach(bg_model *m, double h, const double *s)
{
    bg_work *const work = &m->work;
    double total = 0.0;
    for (int i = 0; i < ALL; i++) {
        work->reach[i] = fabs(s[i]) + h * fabs(work->stage[0][i]);
        total += work->reach[i] * work->weight[i] * work->reach[i] * work->weight[i];
    }
    for (int i = 0; i < ALL; i++)
        work->reach[i] += (BG_REACH_PART * sqrt(total) + BG_REACH_FLOOR) / work->weight[i];
}

/* image = J from, by a difference; backwards where the rates have no value ahead. */
int bg_slope(bg_model *m, double t, const double *s, const double *w, double amount,
             const double *from, double *image)
{
    bg_work *const work = &m->work;
    double most = 0.0;
    int status = BG_NOT_FINITE;
    for (int i = 0; i < ALL; i++)
        most = fmax(most, fabs(from[i]) / (work->weight[i] * work->reach[i]));
    for (int tries = 0; tries < 2 && status != BG_OK; tries++, amount = -amount) {
        const double d = most > 0 ? amount / most : 0.0;
        for (int i = 0; i < ALL; i++)
            work->point[i] = s[i] + d * from[i] / work->weight[i];
        status = bg_evaluate(m, t, work->point, w, work->rates[0], m->mode, 0, &m->shot);
        for (int i = 0; i < ALL && status == BG_OK; i++)
            image[i] = d != 0 ? (m->shot.rate[i] - work->stage[0][i]) / d * work->weight[i] : 0.0;
        if (status == BG_OK && !bg_finite(ALL, image))
            status = BG_NOT_FINITE;
    }
    return status;
}
