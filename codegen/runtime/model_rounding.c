/* What counts as zero: the rounding of terms that cancel, from the largest magnitudes seen; and the
 * shortest time constant. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "model_located_internal.h"

enum { K = BG_FRICTION, N = BG_STATES, M = BG_INPUTS, SQUARINGS = 8 };
static const double SMALL = 1.0 / 1048576.0; /* relative change of a state, a power of 2 */

/* How fast a port's slip changes. */
double bg_slip_rate(const bg_model *m, const bg_snapshot *shot, int port)
{
    const bg_numbers *const a = &m->numbers;
    const int row = bg_friction_readings[port];
    double sum = 0.0;
    for (int i = 0; i < N; i++) {
        const double factor = a->F[row * N + i];
        double rate = 0.0;
        if (factor == 0.0)
            continue;
        for (int j = 0; j < N; j++)
            rate += a->P[i * N + j] * shot->x[j];
        for (int j = 0; j < M; j++)
            rate += a->Q[i * M + j] * shot->u[j] + a->R[i * M + j] * shot->du[j];
        sum += factor * rate;
    }
    for (int j = 0; j < M; j++)
        sum += a->D[row * M + j] * shot->du[j];
    return sum;
}

/* F P (of `columns` states) or F Q, times magnitudes: what moves a slip. */
static double moved_by(const bg_model *m, int port, const double *a, int columns,
                       const double *sizes)
{
    const double *const F = m->numbers.F + bg_friction_readings[port] * N;
    double total = 0.0;
    for (int j = 0; j < columns; j++) {
        double sum = 0.0;
        for (int i = 0; i < N; i++)
            sum += F[i] * a[i * columns + j];
        total += fabs(sum) * sizes[j];
    }
    return total;
}

/* At rest states are rounding themselves: of what moves them within a time constant. */
static void reached(const bg_located *c, const double *x, const double *u, double *most)
{
    const bg_numbers *const a = &c->model->numbers;
    for (int i = 0; i < N; i++) {
        double rate = 0.0;
        for (int j = 0; j < N; j++)
            rate += fabs(a->P[i * N + j]) * x[j];
        for (int j = 0; j < M; j++)
            rate += fabs(a->Q[i * M + j]) * u[j];
        most[i] = fmax(x[i], c->moment * rate);
    }
}

/* Of the instant in c->shot, which is at t. */
void bg_located_rounding(bg_located *c, double t, bg_rounding *size)
{
    const bg_snapshot *const now = &c->shot;
    const bg_numbers *const a = &c->model->numbers;
    const double spacing = nextafter(fabs(t), INFINITY) - fabs(t);
    double x[BG_ROOM(N)], u[BG_ROOM(M)], most[BG_ROOM(N)];
    for (int i = 0; i < N; i++)
        x[i] = fmax(fabs(now->x[i]), c->peak_x[i]);
    for (int j = 0; j < M; j++)
        u[j] = fmax(fabs(now->u[j]), c->peak_u[j]);
    reached(c, x, u, most);
    for (int k = 0; k < K; k++) {
        const int row = bg_friction_readings[k], own = bg_friction_inputs[k];
        double slip = 0.0, inertia = 0.0, moved = moved_by(c->model, k, a->P, N, most);
        moved += moved_by(c->model, k, a->Q, M, u);
        for (int i = 0; i < N; i++) {
            slip += fabs(a->F[row * N + i]) * x[i];
            inertia += a->F[row * N + i] * a->Q[i * M + own];
        }
        for (int j = 0; j < M; j++)
            slip += fabs(a->D[row * M + j]) * u[j];
        inertia = fabs(inertia) + fabs(a->D[row * M + own]);
        const double late = 16.0 * spacing * fabs(bg_slip_rate(c->model, now, k));
        const double effort = fabs(now->u[own]) + now->caps[k];
        size->slip[k] = BG_ROUNDING * (slip + moved * c->moment) + late + DBL_MIN;
        size->effort[k] = BG_ROUNDING * (effort + (inertia > 0 ? moved / inertia : 0.0)) + DBL_MIN;
        size->push[k] = BG_ROUNDING * 10.0 * moved + DBL_MIN;
    }
}

/* Takes the present instant into the peaks, friction slipping: states, and for every input the sum
 * of the magnitudes of its terms in states. A term is the effect of a small relative change. */
int bg_located_see(bg_located *c, const signed char *slipping)
{
    double u[BG_ROOM(M)], terms[BG_ROOM(M)], moved[BG_SIZE];
    int status = bg_located_look(c, c->t, c->s, slipping);
    for (int i = 0; i < N; i++)
        c->peak_x[i] = fmax(c->peak_x[i], fabs(c->shot.x[i]));
    for (int i = 0; i < M; i++) {
        u[i] = c->shot.u[i];
        terms[i] = fabs(u[i]);
    }
    memcpy(moved, c->s, sizeof moved);
    for (int j = 0; j < BG_SIZE && status == BG_OK; j++) {
        if (c->s[j] == 0.0)
            continue;
        moved[j] = c->s[j] * (1.0 + SMALL);
        const int known = bg_located_look(c, c->t, moved, slipping) == BG_OK;
        moved[j] = c->s[j];
        for (int i = 0; i < M && known; i++)
            terms[i] += fabs(c->shot.u[i] - u[i]) / SMALL;
    }
    for (int i = 0; i < M; i++)
        c->peak_u[i] = fmax(c->peak_u[i], terms[i]);
    return status;
}

/* How rates change with the states, by rows, from differences that stay where laws have values;
 * downwards where `side` is -1. */
static int slopes(bg_located *c, double t, const double *s, double side, double *jacobian)
{
    const double past = bg_longest_step(t - c->began);
    double base[BG_SIZE], rate[BG_SIZE], moved[BG_SIZE];
    int status = bg_located_rate(c, t, s, base);
    memcpy(moved, s, sizeof moved);
    for (int j = 0; j < BG_SIZE && status == BG_OK; j++) {
        double step = side * (1e-6 * fabs(s[j]) + 1e-9 * fabs(base[j]) * past + 1e-9);
        for (int tries = 0; tries < 12; tries++, step *= 1e-2) {
            moved[j] = s[j] + step;
            status = bg_located_rate(c, t, moved, rate);
            if (status == BG_OK)
                break;
        }
        for (int i = 0; i < BG_SIZE; i++)
            jacobian[i * BG_SIZE + j] = (rate[i] - base[i]) / (moved[j] - s[j]);
        moved[j] = s[j];
    }
    return status;
}

int bg_located_jacobian(bg_located *c, double t, const double *s, double *jacobian)
{
    return slopes(c, t, s, 1.0, jacobian);
}

static double largest(const double *a)
{
    double most = 0.0;
    for (int i = 0; i < BG_SIZE * BG_SIZE; i++)
        most = fmax(most, fabs(a[i]));
    return most;
}

static void square(const double *a, double *product)
{
    memset(product, 0, sizeof(double) * BG_SIZE * BG_SIZE);
    for (int i = 0; i < BG_SIZE; i++)
        for (int l = 0; l < BG_SIZE; l++) {
            const double factor = a[i * BG_SIZE + l];
            for (int j = 0; j < BG_SIZE && factor != 0.0; j++)
                product[i * BG_SIZE + j] += factor * a[l * BG_SIZE + j];
        }
}

/* The largest rate [1/s] of the model linearised in squares[0] and of the inputs: of the model from
 * a high power of the matrix, scaled as it grows. */
static int largest_rate(bg_located *c, double *fastest)
{
    double *power = c->squares[0], *next = c->squares[1], logarithm = 0.0, share = 1.0;
    double size = largest(power);
    *fastest = c->signals->fastest[c->segment];
    if (!isfinite(size))
        return BG_NOT_FINITE;
    for (int k = 0; k < SQUARINGS && size > 0.0; k++) {
        double *const done = power;
        logarithm += share * log(size);
        share /= 2;
        for (int i = 0; i < BG_SIZE * BG_SIZE; i++)
            power[i] /= size;
        square(power, next);
        power = next;
        next = done;
        size = largest(power);
    }
    if (size > 0.0)
        *fastest = fmax(*fastest, exp(logarithm + share * log(size)));
    return BG_OK;
}

int bg_located_fastest(bg_located *c, double t, const double *s, double *fastest)
{
    const int status = bg_located_jacobian(c, t, s, c->squares[0]);
    *fastest = 0.0;
    return status == BG_OK ? largest_rate(c, fastest) : status;
}

/* At the present instant, a jump beside it left aside: from the smaller slope of both sides. */
int bg_located_calm(bg_located *c, double *fastest)
{
    double *const ahead = c->squares[0], *const behind = c->squares[1];
    int status = slopes(c, c->t, c->s, 1.0, ahead);
    if (status == BG_OK)
        status = slopes(c, c->t, c->s, -1.0, behind);
    for (int i = 0; i < BG_SIZE * BG_SIZE; i++)
        ahead[i] = fabs(ahead[i]) < fabs(behind[i]) ? ahead[i] : behind[i];
    return status == BG_OK ? largest_rate(c, fastest) : status;
}
