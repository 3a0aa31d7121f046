/* Implicit steps for stiff models: the Radau IIA method of order 5 with three stages (E. Hairer,
 * G. Wanner, Solving Ordinary Differential Equations II, 2nd edition 1996, section IV.8). */
#include <float.h>
#include <math.h>
#include <string.h>

#include "located_internal.h"

enum { STAGES = 3, NEWTON = 6, SIZE = BG_SIZE, TWICE = 2 * SIZE };

/* Where the stages lie; the estimate of the error; the eigenvalues of the method's inverse matrix
 * and what makes it diagonal; the interpolant. */
static const double RADAU_C[STAGES] = {0.15505102572168219, 0.64494897427831781, 1.0};
static const double RADAU_E[STAGES] = {-10.048809399827416, 1.3821427331607489, -1.0 / 3.0};
static const double GAMMA = 3.637834252744496, ALPHA = 2.6810828736277519;
static const double BETA = 3.0504301992474106;
static const double RADAU_T[STAGES][STAGES] = {
    {0.09443876248897524, -0.14125529502095421, 0.03002919410514742},
    {0.25021312296533332, 0.20412935229379994, -0.38294211275726192},
    {1.0, 1.0, 0.0},
};
static const double INVERSE[STAGES][STAGES] = {
    {4.17871859155190428, 0.32768282076106237, 0.52337644549944951},
    {-4.17871859155190428, -0.32768282076106237, 0.47662355450055044},
    {0.50287263494578682, -2.57192694985560522, 0.59603920482822492},
};
static const double RADAU_P[STAGES][STAGES] = {
    {10.048809399827416, -25.629591447076638, 15.580782047249223},
    {-1.3821427331607489, 10.296258113743305, -8.9141153805825564},
    {1.0 / 3.0, -8.0 / 3.0, 10.0 / 3.0},
};

/* Factors GAMMA/h - J, and (ALPHA - i BETA)/h - J as a real matrix of twice the size. */
static int factor(bg_solver *s, double h)
{
    if (s->factored && s->h_factored == h)
        return 1;
    for (int i = 0; i < SIZE; i++)
        for (int j = 0; j < SIZE; j++) {
            const double slope = s->jacobian[i * SIZE + j], unit = i == j ? 1.0 / h : 0.0;
            double *const block = s->complex + i * TWICE + j;
            s->real[i * SIZE + j] = GAMMA * unit - slope;
            block[0] = block[SIZE * TWICE + SIZE] = ALPHA * unit - slope;
            block[SIZE] = BETA * unit;
            block[SIZE * TWICE] = -BETA * unit;
        }
    s->h_factored = h;
    s->factored = bg_factor(SIZE, s->real, s->real_pivots)
                  && bg_factor(TWICE, s->complex, s->complex_pivots);
    return s->factored;
}

/* What Newton's iteration changes in the transformed stages; 0 where rates have no value. */
static int change(bg_located *c, double h, const double (*Z)[SIZE], const double (*W)[SIZE],
                  double (*dW)[SIZE])
{
    bg_solver *const s = &c->solver;
    double rates[STAGES][SIZE];
    for (int i = 0; i < STAGES; i++) {
        for (int k = 0; k < SIZE; k++)
            s->tried[k] = s->y_old[k] + Z[i][k];
        if (bg_located_rate(c, s->t_old + RADAU_C[i] * h, s->tried, rates[i]) != BG_OK)
            return 0;
    }
    for (int k = 0; k < SIZE; k++) {
        double f[STAGES];
        for (int i = 0; i < STAGES; i++)
            f[i] = INVERSE[i][0] * rates[0][k] + INVERSE[i][1] * rates[1][k]
                   + INVERSE[i][2] * rates[2][k];
        dW[0][k] = f[0] - GAMMA / h * W[0][k];
        dW[1][k] = f[1] - (ALPHA * W[1][k] + BETA * W[2][k]) / h;
        dW[2][k] = f[2] - (ALPHA * W[2][k] - BETA * W[1][k]) / h;
    }
    bg_solve(SIZE, s->real, s->real_pivots, 1, dW[0]);
    bg_solve(TWICE, s->complex, s->complex_pivots, 1, dW[1]);
    return bg_finite(STAGES * SIZE, dW[0]);
}

/* Solves for the stages' distances Z from the start by simplified Newton; its iterations, 0 if it
 * does not converge. */
static int solve_stages(bg_located *c, double h, double (*Z)[SIZE], double *rate)
{
    bg_solver *const s = &c->solver;
    const double rtol = c->asked->rtol;
    const double enough = fmax(10 * DBL_EPSILON / rtol, fmin(BG_NEWTON, sqrt(rtol)));
    double W[STAGES][SIZE], dW[STAGES][SIZE], before = 0.0;
    for (int i = 0; i < STAGES; i++)
        for (int k = 0; k < SIZE; k++)
            W[i][k] = INVERSE[i][0] * Z[0][k] + INVERSE[i][1] * Z[1][k] + INVERSE[i][2] * Z[2][k];
    for (int turn = 0; turn < NEWTON; turn++) {
        if (!change(c, h, (const double(*)[SIZE])Z, (const double(*)[SIZE])W, dW))
            return 0;
        const double size = bg_norm(STAGES * SIZE, dW[0], s->scale);
        *rate = turn ? size / before : 0.0;
        if (turn && (*rate >= 1 || pow(*rate, NEWTON - turn) / (1 - *rate) * size > enough))
            return 0;
        for (int i = 0; i < STAGES; i++)
            for (int k = 0; k < SIZE; k++)
                W[i][k] += dW[i][k];
        for (int i = 0; i < STAGES; i++)
            for (int k = 0; k < SIZE; k++)
                Z[i][k] = RADAU_T[i][0] * W[0][k] + RADAU_T[i][1] * W[1][k]
                          + RADAU_T[i][2] * W[2][k];
        if (size == 0 || (turn && *rate / (1 - *rate) * size < enough))
            return turn + 1;
        before = size;
    }
    return 0;
}

static void tolerances(bg_located *c, const double *other)
{
    for (int k = 0; k < SIZE; k++) {
        const double size = fmax(fabs(c->solver.y_old[k]), fabs(other[k]));
        c->solver.scale[k] = c->asked->atol + c->asked->rtol * size;
    }
}

/* Solves (GAMMA/h - J) error = rate + Z E / h. */
static double implicit_error(bg_solver *s, double h, const double (*Z)[SIZE], const double *rate,
                       double *error)
{
    for (int k = 0; k < SIZE; k++)
        error[k] = rate[k]
                   + (Z[0][k] * RADAU_E[0] + Z[1][k] * RADAU_E[1] + Z[2][k] * RADAU_E[2]) / h;
    bg_solve(SIZE, s->real, s->real_pivots, 1, error);
    return bg_norm(SIZE, error, s->scale);
}

/* The error over what the tolerance allows; a step that follows a rejected one looks twice. */
static double judged(bg_located *c, double h, const double (*Z)[SIZE], int again)
{
    bg_solver *const s = &c->solver;
    double error[SIZE], rate[SIZE], end[SIZE];
    for (int k = 0; k < SIZE; k++)
        end[k] = s->y_old[k] + Z[STAGES - 1][k];
    tolerances(c, end);
    double size = implicit_error(s, h, Z, s->f_old, error);
    if (!again || !(size > 1))
        return size;
    for (int k = 0; k < SIZE; k++)
        s->tried[k] = s->y_old[k] + error[k];
    if (bg_located_rate(c, s->t_old, s->tried, rate) != BG_OK)
        return size;
    return implicit_error(s, h, Z, rate, error);
}

/* By how much the next step may differ, from the errors of this one and the one before. */
static double predicted(const bg_solver *s, double h, double error)
{
    double trend = 1.0;
    if (error == 0)
        return GROW;
    if (s->begun && s->error > 0)
        trend = fmin(1.0, h / s->h * pow(s->error / error, 0.25));
    return trend * pow(error, -0.25);
}

/* Starts the stages where the interpolant of the step before leads beyond its end. */
static void guess(const bg_solver *s, double h, double (*Z)[SIZE])
{
    memset(Z, 0, sizeof(double) * STAGES * SIZE);
    for (int i = 0; i < STAGES && s->begun; i++) {
        const double x = 1.0 + RADAU_C[i] * h / s->h;
        for (int k = 0; k < SIZE; k++) {
            const double *const q = &s->collocation[0][k];
            Z[i][k] = x * (q[0] + x * (q[SIZE] + x * q[2 * SIZE])) - (q[0] + q[SIZE] + q[2 * SIZE]);
        }
    }
}

/* Stages of a step of h, the Jacobian taken anew if it is old and they don't converge otherwise. */
static int converged(bg_located *c, double h, const double (*start)[SIZE], double (*Z)[SIZE],
                     double *rate, int *status)
{
    bg_solver *const s = &c->solver;
    for (;;) {
        memcpy(Z, start, sizeof(double) * STAGES * SIZE);
        const int turns = factor(s, h) ? solve_stages(c, h, Z, rate) : 0;
        if (turns || !s->stale)
            return turns;
        *status = bg_located_jacobian(c, s->t_old, s->y_old, s->jacobian);
        if (*status != BG_OK)
            return 0;
        s->stale = s->factored = 0;
    }
}

/* What follows an accepted step: the state, the Jacobian if it served badly, the next step. */
static int accept(bg_located *c, double end, double h, const double (*Z)[SIZE], double error,
                  double factor, int renew)
{
    bg_solver *const s = &c->solver;
    s->t = end;
    s->h = h;
    s->begun = 1;
    for (int k = 0; k < SIZE; k++) {
        s->y[k] = s->y_old[k] + Z[STAGES - 1][k];
        for (int r = 0; r < STAGES; r++)
            s->collocation[r][k] = Z[0][k] * RADAU_P[0][r] + Z[1][k] * RADAU_P[1][r]
                                   + Z[2][k] * RADAU_P[2][r];
    }
    s->error = error;
    if (!renew && factor < 1.2)
        factor = 1.0;
    s->next = h * factor;
    int status = bg_located_rate(c, end, s->y, s->f);
    s->stale = !renew;
    if (renew && status == BG_OK) {
        status = bg_located_jacobian(c, end, s->y, s->jacobian);
        s->factored = 0;
    }
    return status;
}

int bg_implicit_step(bg_located *c, double stop)
{
    bg_solver *const s = &c->solver;
    const double least = 10.0 * (nextafter(fabs(s->t), INFINITY) - fabs(s->t));
    double h = fmin(fmax(s->next, least), s->longest), rate = 0.0;
    double start[STAGES][SIZE], Z[STAGES][SIZE];
    int again = 0, status = BG_OK;
    if (!s->begun)
        status = bg_located_jacobian(c, s->t, s->y, s->jacobian);
    while (status == BG_OK && h >= least) {
        const double end = fmin(s->t + h, stop);
        h = end - s->t;
        guess(s, h, start);
        s->t_old = s->t;
        memcpy(s->y_old, s->y, sizeof s->y);
        memcpy(s->f_old, s->f, sizeof s->f);
        tolerances(c, s->y_old);
        const int turns = converged(c, h, (const double(*)[SIZE])start, Z, &rate, &status);
        if (!turns) {
            h *= 0.5;
            continue;
        }
        const double error = judged(c, h, (const double(*)[SIZE])Z, again);
        const double safety = 0.9 * (2 * NEWTON + 1) / (2 * NEWTON + turns);
        const double factor = safety * predicted(s, h, error);
        if (error <= 1)
            return accept(c, end, h, (const double(*)[SIZE])Z, error, fmin(factor, GROW),
                          turns > 2 && rate > BG_NEWTON_SLOW);
        h *= isfinite(error) ? fmax(SHRINK, factor) : SHRINK;
        again = 1;
    }
    return status != BG_OK ? status : BG_STEPS;
}

void bg_implicit_at(const bg_solver *s, double t, double *y)
{
    const double x = (t - s->t_old) / s->h;
    for (int k = 0; k < SIZE; k++) {
        const double *const q = &s->collocation[0][k];
        y[k] = s->y_old[k] + x * (q[0] + x * (q[SIZE] + x * q[2 * SIZE]));
    }
}
