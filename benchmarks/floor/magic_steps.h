/* A run, and steps of DOP853: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential
 * Equations I, section II.5. Time is counted in sub-steps, of which a sample has three. */
#ifndef MAGIC_STEPS_H
#define MAGIC_STEPS_H

#include "located_explicit_table.h"
#include "magic_model.h"

enum { SUB = 3, HISTORY = 8, DENSE = 7, MANY = 1000 };

/* Where a run is. `at`: when demands of clutch and engine step; `known`: how many instants in a row
 * up to now have the wheels' speeds in `wheel`, the newest first. */
typedef struct {
    magic_vector A[N], forcing, z, f;
    magic_system s;
    double h, x, end, at[2], asked[2], demand[2], wheel[HISTORY][2], *rows;
    int mode, known;
    magic_result *result;
} magic_run;

/* A step from y to z with its stages; `dense` once all there is between its ends is worked out. */
typedef struct {
    magic_vector stage[DOP_ALL], y, z, between[DENSE];
    double h;
    int dense;
} magic_step;

static inline double *magic_states(magic_vector *z)
{
    return (double *)z;
}

static inline const double *magic_read(const magic_vector *z)
{
    return (const double *)z;
}

static inline void magic_rates(const magic_run *run, const magic_vector *at, magic_vector *f)
{
    const magic_system *const s = &run->s;
    const double *const z = magic_read(at);
    double tau[2];
    for (int j = 0; j < 2; j++)
        tau[j] = s->wheel_inverse * magic_torque(s, s->scale[j] * z[T1 + j]);
    const magic_vector tires = {0, 0, 0, 0, tau[0], tau[1], 0, 0};
    const magic_vector one = run->forcing + run->A[0] * z[0] + run->A[1] * z[1];
    const magic_vector two = run->A[2] * z[2] + run->A[3] * z[3] + run->A[4] * z[4];
    const magic_vector three = run->A[5] * z[5] + run->A[6] * z[6] + run->A[7] * z[7];
    *f = one + two + (three - tires);
}

/* Sums of stages by a row of the table, unrolled, so that what is zero is left out. */
static inline __attribute__((always_inline)) magic_vector
magic_sum(const magic_vector *stage, const double *weight, int count)
{
    magic_vector sum[2] = {{0}, {0}};
#pragma GCC unroll 16
    for (int j = 0; j < count; j++)
        if (weight[j] != 0.0)
            sum[j % 2] += weight[j] * stage[j];
    return sum[0] + sum[1];
}

static inline __attribute__((always_inline)) void magic_stage(const magic_run *run, magic_step *p,
                                                              int i)
{
    p->z = p->y + p->h * magic_sum(p->stage, DOP_A[i], i);
    magic_rates(run, &p->z, &p->stage[i]);
}

/* magic_steps.c: a step of h seconds from where the run is; what is between its ends; the states
 * there, at a share of it. */
void magic_attempt(const magic_run *run, double h, magic_step *p);
void magic_fill(const magic_run *run, magic_step *p);
void magic_between(const magic_step *p, double share, magic_vector *z);

/* From which share of a step from `low` to `high` on the mode is over; 2 where it lasts. */
double magic_ends(const magic_run *run, magic_step *p, double low, double high);

/* Begins a run; keeps a sample; sets the mode's matrix, demands and rates anew; goes on in the mode
 * that follows an event at x; tells whether a demand steps at x, and steps it. */
void magic_begin(magic_run *run, const magic_parameters *p, double h, int samples, double *rows,
                 magic_result *result);
void magic_sample(magic_run *run, double x, const magic_vector *z);
void magic_renew(magic_run *run);
void magic_turn(magic_run *run, double x, const magic_vector *z);
int magic_breaks(magic_run *run);

/* The next instant at which a demand steps, or the end. */
static inline double magic_stop(const magic_run *run)
{
    double stop = run->end;
    for (int j = 0; j < 2; j++)
        if (run->at[j] > run->x && run->at[j] < stop)
            stop = run->at[j];
    return stop;
}

/* magic_settle.c: by Runge-Kutta as far as a sample not before `least` at which eight instants are
 * known, or to the end. */
int magic_settle(magic_run *run, double least);

#endif
