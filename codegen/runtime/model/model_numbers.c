/* From parameters to matrices solved for the rates. */
#include <math.h>
#include <string.h>

#include "model_internal.h"

/* The entries of one matrix, put where they stand. */
static const double *scatter(const double *entries, int which, int columns, double *matrix)
{
    const bg_pattern *pattern = &bg_layout[which];
    for (int k = 0; k < pattern->count; k++)
        matrix[pattern->rows[k] * columns + pattern->columns[k]] = entries[k];
    return entries + pattern->count;
}

/* A factored, rows and columns scaled first: storages may differ by many powers of ten. */
static int factor_storages(bg_numbers *a)
{
    for (int i = 0; i < BG_STATES; i++) {
        a->scale[i] = 1 / sqrt(fabs(a->A[i * BG_STATES + i]));
        if (!isfinite(a->scale[i]))
            a->scale[i] = 1.0;
    }
    for (int i = 0; i < BG_STATES; i++)
        for (int j = 0; j < BG_STATES; j++)
            a->A[i * BG_STATES + j] *= a->scale[i] * a->scale[j];
    return bg_factor(BG_STATES, a->A, a->pivots);
}

/* right, a row for each state, becomes A^-1 right. */
void bg_solve_storages(const bg_numbers *a, int columns, double *right)
{
    for (int i = 0; i < BG_STATES; i++)
        for (int j = 0; j < columns; j++)
            right[i * columns + j] *= a->scale[i];
    bg_solve(BG_STATES, a->A, a->pivots, columns, right);
    for (int i = 0; i < BG_STATES; i++)
        for (int j = 0; j < columns; j++)
            right[i * columns + j] *= a->scale[i];
}

/* Entries of A^-1, those of one column next to one another. */
void bg_inverse_entries(bg_model *m, int count, const int *rows, const int *columns, double *out)
{
    double *const column = m->work.moved;
    for (int k = 0; k < count; k++) {
        if (k == 0 || columns[k] != columns[k - 1]) {
            memset(column, 0, sizeof(double) * BG_STATES);
            column[columns[k]] = 1.0;
            bg_solve_storages(&m->numbers, 1, column);
        }
        out[k] = column[rows[k]];
    }
}

/* F, D, G get what readings show of the rates: H times P, Q, R. */
static void show_rates(bg_numbers *a, const double *entries)
{
    const bg_pattern *shown = &bg_layout[BG_H];
    for (int k = 0; k < shown->count; k++) {
        const int i = shown->rows[k], l = shown->columns[k];
        for (int j = 0; j < BG_STATES; j++)
            a->F[i * BG_STATES + j] += entries[k] * a->P[l * BG_STATES + j];
        for (int j = 0; j < BG_INPUTS; j++) {
            a->D[i * BG_INPUTS + j] += entries[k] * a->Q[l * BG_INPUTS + j];
            a->G[i * BG_INPUTS + j] += entries[k] * a->R[l * BG_INPUTS + j];
        }
    }
}

static void note_slips(bg_numbers *a)
{
    for (int i = 0; i < BG_FRICTION; i++) {
        const int row = bg_received_readings[i];
        for (int j = 0; j < BG_STATES; j++)
            a->slip_F[i * BG_STATES + j] = a->F[row * BG_STATES + j];
        double *const slip = a->slip_D + i * (BG_FRICTION + BG_COUPLED);
        for (int j = 0; j < BG_FRICTION; j++)
            slip[j] = a->D[row * BG_INPUTS + bg_friction_inputs[j]];
        for (int j = 0; j < BG_COUPLED; j++)
            slip[BG_FRICTION + j] = a->D[row * BG_INPUTS + bg_coupled.inputs[j]];
    }
}

/* Of matrices that stay as they are; those that change would be listed at every instant. */
static void list_matrices(bg_numbers *a)
{
    BG_LIST_ENTRIES(BG_STATES, BG_STATES, a, P);
    BG_LIST_ENTRIES(BG_STATES, BG_INPUTS, a, Q);
    BG_LIST_ENTRIES(BG_READINGS, BG_STATES, a, F);
    BG_LIST_ENTRIES(BG_READINGS, BG_INPUTS, a, D);
    BG_LIST_ENTRIES(BG_READINGS, BG_INPUTS, a, G);
}

/* All matrices at `m->now`. */
int bg_assemble(bg_model *m)
{
    bg_numbers *const a = &m->numbers;
    const double *at = m->work.entries, *shown;
    bg_coefficients(&m->now, m->work.entries);
    if (!bg_finite(BG_ENTRIES, m->work.entries))
        return BG_COEFFICIENT;
    memset(a, 0, sizeof *a);
    at = scatter(at, BG_A, BG_STATES, a->A);
    at = scatter(at, BG_J, BG_STATES, a->P);
    at = scatter(at, BG_B, BG_INPUTS, a->Q);
    at = scatter(at, BG_E, BG_INPUTS, a->R);
    at = scatter(at, BG_F, BG_STATES, a->F);
    at = scatter(at, BG_D, BG_INPUTS, a->D);
    shown = at;
    scatter(at + bg_layout[BG_H].count, BG_K, BG_INPUTS, a->G);
    note_slips(a);
    if (!factor_storages(a))
        return BG_SINGULAR;
    bg_solve_storages(a, BG_STATES, a->P);
    bg_solve_storages(a, BG_INPUTS, a->Q);
    if (bg_layout[BG_E].count > 0)
        bg_solve_storages(a, BG_INPUTS, a->R);
    show_rates(a, shown);
    if (!BG_VARYING)
        list_matrices(a);
    return BG_OK;
}
