/* Times an evaluation of the rates: generated straight-line code beside the same by hand. Each call
 * depends on the one before, as in an integrator. */
#include <math.h>
#include <stdio.h>
#include <time.h>

#include "fig11_floor.h"
#include "model_runtime.h"

enum { CALLS = 2000000, ROUNDS = 15, STATES = 6 };

static bg_model model;
static fig11_context context;

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

static void by_hand(const double *x, double *dx)
{
    static const double u[2] = {300.0, 900.0};
    fig11_rhs(&context.system, 0.0, x, u, dx);
}

static void generated(const double *x, double *dx)
{
    static const double w[2] = {300.0, 900.0}, signs[1] = {1.0};
    bg_model_rhs(&model, 0.0, x, w, signs, dx);
}

static void evaluated(const double *x, double *dx)
{
    static const double w[2] = {300.0, 900.0};
    static const int mode[1] = {1};
    static bg_snapshot shot;
    bg_model_evaluate(&model, 0.0, x, w, NULL, mode, &shot);
    for (int i = 0; i < STATES; i++)
        dx[i] = shot.rate[i];
}

/* Nanoseconds a call. */
static double timed(void (*rates)(const double *, double *), int calls)
{
    double x[STATES] = {80, 81, 10, -10, 80, 80.5}, dx[STATES];
    const double start = now();
    for (int k = 0; k < calls; k++) {
        rates(x, dx);
        for (int i = 0; i < STATES; i++)
            x[i] += 1e-9 * dx[i];
    }
    return (now() - start) / calls + (x[0] > 1e300);
}

int main(void)
{
    void (*const ways[3])(const double *, double *) = {by_hand, generated, evaluated};
    double best[3] = {INFINITY, INFINITY, INFINITY}, dx[3][STATES], worst = 0.0, most = 0.0;
    const double x[STATES] = {80, 81, 10, -10, 80, 80.5};
    const fig11_parameters p = {2.8, 0.1604, 0.008, 0.008, 0.8, 8600, 2e5, 0.3, 0.04, 80, -2, 350,
                                1000, 0.1, 0.5};
    fig11_prepare(&p, 1e-3, &context);
    if (bg_model_init(&model, NULL) != BG_OK)
        return 1;
    for (int way = 0; way < 3; way++)
        ways[way](x, dx[way]);
    for (int way = 1; way < 3; way++)
        for (int i = 0; i < STATES; i++) {
            worst = fmax(worst, fabs(dx[way][i] - dx[0][i]));
            most = fmax(most, fabs(dx[0][i]));
        }
    for (int round = 0; round < ROUNDS; round++)
        for (int way = 0; way < 3; way++)
            best[way] = fmin(best[way], timed(ways[way], way == 2 ? CALLS / 20 : CALLS));
    printf("%.3f %.3f %.3f %.3g\n", best[0], best[1], best[2], worst / most);
    return 0;
}
