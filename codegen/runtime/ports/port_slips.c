/* Slips of friction ports and how fast they change, with the magnitude of what makes them up. */
#include <math.h>

#include "model_internal.h"

double bg_slip(const bg_model *m, const bg_snapshot *now, int port, double *terms)
{
    const int row = bg_friction_readings[port];
    *terms = 0.0;
    for (int i = 0; i < N; i++)
        *terms += fabs(m->numbers.F[row * N + i]) * fabs(now->x[i]);
    for (int j = 0; j < M; j++)
        *terms += fabs(m->numbers.D[row * M + j]) * fabs(now->u[j]);
    return now->y[row];
}

double bg_slip_rate(const bg_model *m, const bg_snapshot *now, int port, double *terms)
{
    const bg_numbers *const a = &m->numbers;
    const int row = bg_friction_readings[port];
    double sum = 0.0;
    *terms = 0.0;
    for (int i = 0; i < N; i++) {
        const double factor = a->F[row * N + i];
        double rate = 0.0, size = 0.0;
        for (int j = 0; j < N && factor != 0.0; j++) {
            rate += a->P[i * N + j] * now->x[j];
            size += fabs(a->P[i * N + j]) * fabs(now->x[j]);
        }
        for (int j = 0; j < M && factor != 0.0; j++) {
            rate += a->Q[i * M + j] * now->u[j] + a->R[i * M + j] * now->du[j];
            size += fabs(a->Q[i * M + j]) * fabs(now->u[j]);
        }
        sum += factor * rate;
        *terms += fabs(factor) * size;
    }
    for (int j = 0; j < M; j++)
        sum += a->D[row * M + j] * now->du[j];
    return bg_moving[port] < 0 ? sum : sum + now->y[bg_moving[port]];
}

void bg_round_struck(const bg_model *m, const bg_snapshot *now, const double *given, double part,
                     double *near)
{
    const bg_numbers *const a = &m->numbers;
    for (int i = 0; i < K; i++) {
        const double *const F = a->F + bg_friction_readings[i] * N;
        double terms, gained = 0.0;
        bg_slip(m, now, i, &terms);
        /* What is at rest has the rounding of what it was. */
        for (int l = 0; l < N; l++)
            gained += fabs(F[l]) * m->seen[l];
        for (int l = 0; l < N; l++)
            for (int k = 0; k < K; k++)
                gained += fabs(F[l] * a->Q[l * M + bg_friction_inputs[k]] * given[k]);
        near[i] = part * (terms + gained);
    }
}
