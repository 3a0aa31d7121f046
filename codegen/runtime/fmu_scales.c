/* The rounding of slips, efforts and accelerations, from the magnitude of the terms that make them up. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "fmu_common.h"

enum { N = BG_STATES, M = BG_INPUTS, K = BG_FRICTION };
static const double TOLERANCE = 1e-10;

double fmu_slip_rate(const fmu_instance *f, const bg_snapshot *now, int port)
{
    const bg_numbers *const a = &f->model.numbers;
    const int row = bg_friction_readings[port];
    double sum = 0.0;
    for (int i = 0; i < N; i++) {
        double rate = 0.0;
        for (int j = 0; j < N; j++)
            rate += a->P[i * N + j] * now->x[j];
        for (int j = 0; j < M; j++)
            rate += a->Q[i * M + j] * now->u[j] + a->R[i * M + j] * now->du[j];
        sum += a->F[row * N + i] * rate;
    }
    for (int j = 0; j < M; j++)
        sum += a->D[row * M + j] * now->du[j];
    return sum;
}

void fmu_note_peaks(fmu_instance *f, const bg_snapshot *now)
{
    for (int i = 0; i < N; i++)
        f->at.peak_x[i] = fmax(f->at.peak_x[i], fabs(now->x[i]));
    for (int j = 0; j < M; j++)
        f->at.peak_u[j] = fmax(f->at.peak_u[j], fabs(now->u[j]));
}

/* Magnitudes of the terms of the rates. */
static void flows(fmu_instance *f)
{
    const bg_numbers *const a = &f->model.numbers;
    for (int i = 0; i < N; i++) {
        f->flow[i] = 0.0;
        for (int j = 0; j < N; j++)
            f->flow[i] += fabs(a->P[i * N + j]) * f->magnitude_x[j];
        for (int j = 0; j < M; j++)
            f->flow[i] += fabs(a->Q[i * M + j]) * f->magnitude_u[j];
    }
}

static double inertia(const bg_numbers *a, int port)
{
    const int row = bg_friction_readings[port], column = bg_friction_inputs[port];
    double sum = 0.0;
    for (int i = 0; i < N; i++)
        sum += a->F[row * N + i] * a->Q[i * M + column];
    return fabs(sum) + fabs(a->D[row * M + column]);
}

void fmu_scale(fmu_instance *f, const bg_snapshot *now, fmu_scales *size)
{
    const bg_numbers *const a = &f->model.numbers;
    const double late = 16 * DBL_EPSILON * fabs(f->at.time);
    for (int i = 0; i < N; i++)
        f->magnitude_x[i] = fmax(fabs(now->x[i]), f->at.peak_x[i]);
    for (int j = 0; j < M; j++)
        f->magnitude_u[j] = fmax(fabs(now->u[j]), f->at.peak_u[j]);
    for (int k = 0; k < K; k++) {
        const int row = bg_friction_readings[k];
        size->slip[k] = 0.0;
        for (int i = 0; i < N; i++)
            size->slip[k] += fabs(a->F[row * N + i]) * f->magnitude_x[i];
        for (int j = 0; j < M; j++)
            size->slip[k] += fabs(a->D[row * M + j]) * f->magnitude_u[j];
    }
    flows(f);
    for (int i = 0; i < N; i++)
        f->magnitude_x[i] = fmax(f->magnitude_x[i], FMU_SHORTEST * f->flow[i]);
    flows(f);
    for (int k = 0; k < K; k++) {
        const double *const row = a->F + bg_friction_readings[k] * N;
        const double held = inertia(a, k);
        double moved = 0.0;
        for (int i = 0; i < N; i++)
            moved += fabs(row[i]) * f->flow[i];
        size->slip[k] = TOLERANCE * (size->slip[k] + moved * FMU_SHORTEST)
            + late * fabs(fmu_slip_rate(f, now, k)) + DBL_MIN;
        size->effort[k] = TOLERANCE * (fabs(now->u[bg_friction_inputs[k]]) + now->caps[k]
            + (held > 0 ? moved / held : 0.0)) + DBL_MIN;
        size->acceleration[k] = TOLERANCE * 10 * moved + DBL_MIN;
    }
}
