/* A drive cycle by hand: one car, its motor's map by bisection, DOP853 from each second to the next,
 * where the cycle bends. What a step does about corners of the map is to be shorter. The method's
 * coefficients are those of the runtime's own table. */
#include <math.h>
#include <string.h>

#include "located_explicit_table.h"

enum { SPEEDS = 17, DEMANDS = 12 };

typedef struct {
    double speeds[SPEEDS], demands[DEMANDS], torque[SPEEDS][DEMANDS];
    double n, k, m, c_0, c_1;
} cycle_car;

static int cell(const double *x, int count, double at)
{
    int low = 0, high = count - 1;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (at < x[middle])
            high = middle;
        else
            low = middle;
    }
    return low;
}

static double torque(const cycle_car *car, double speed, double demand)
{
    const double *const x = car->speeds, *const y = car->demands;
    const double a = fmin(fmax(speed, x[0]), x[SPEEDS - 1]);
    const double b = fmin(fmax(demand, y[0]), y[DEMANDS - 1]);
    const int i = cell(x, SPEEDS, a), j = cell(y, DEMANDS, b);
    const double p = (a - x[i]) / (x[i + 1] - x[i]), q = (b - y[j]) / (y[j + 1] - y[j]);
    const double low = car->torque[i][j] + q * (car->torque[i][j + 1] - car->torque[i][j]);
    const double high = car->torque[i + 1][j] + q * (car->torque[i + 1][j + 1] - car->torque[i + 1][j]);
    return low + p * (high - low);
}

static double rate(const cycle_car *car, double wanted, double v)
{
    const double push = car->n * torque(car, car->n * v, car->k * (wanted - v));
    return (push - (car->c_0 + car->c_1 * v) * v) / car->m;
}

/* From one second to the next; the length of the last step that the error chose, in `next`. */
static double second(const cycle_car *car, double from, double to, double v, double tolerance,
                     double *next)
{
    double t = 0.0, h = fmin(*next, 1.0), stage[DOP_ALL];
    stage[0] = rate(car, from, v);
    while (t < 1.0) {
        double fifth = 0.0, third = 0.0, tried = v, error;
        const double end = t + h < 1.0 ? t + h : 1.0, step = end - t;
        for (int i = 1; i <= DOP_STAGES; i++) {
            double sum = 0.0;
            for (int j = 0; j < i; j++)
                sum += DOP_A[i][j] * stage[j];
            tried = v + step * sum;
            stage[i] = rate(car, from + (t + DOP_C[i] * step) * (to - from), tried);
        }
        const double scale = tolerance * (0.1 + fmax(fabs(v), fabs(tried)));
        for (int i = 0; i <= DOP_STAGES; i++) {
            fifth += E5[i] * stage[i] / scale;
            third += E3[i] * stage[i] / scale;
        }
        fifth *= fifth;
        third *= third;
        error = fifth > 0.0 ? step * fifth / sqrt(fifth + 0.01 * third) : 0.0;
        const double factor = error > 0.0 ? 0.9 * pow(error, -0.125) : 10.0;
        if (error < 1.0) {
            t = end;
            v = tried;
            stage[0] = stage[DOP_STAGES];
            *next = h = (t < 1.0 ? step : h) * fmin(10.0, factor);
        } else {
            h = step * fmax(0.2, factor);
        }
    }
    return v;
}

/* Speeds at so many whole seconds; `wanted`: those of the cycle. */
void cycle_by_hand(const cycle_car *car, int count, const double *wanted, double tolerance,
                   double *speeds)
{
    double next = 0.1;
    speeds[0] = 0.0;
    for (int k = 0; k + 1 < count; k++)
        speeds[k + 1] = second(car, wanted[k], wanted[k + 1], speeds[k], tolerance, &next);
}
