/* One run after another: by DOP853 with steps by its error. */
#include "magic_steps.h"

/* The sum of squares that estimates the error of a step, over what the tolerance allows. */
static double estimate(const magic_step *p, double tolerance)
{
    const magic_vector e5 = magic_sum(p->stage, E5, DOP_STAGES + 1);
    const magic_vector e3 = magic_sum(p->stage, E3, DOP_STAGES + 1);
    const double *const one = magic_read(&p->y), *const other = magic_read(&p->z);
    double fifth = 0, third = 0;
    for (int i = 0; i < N; i++) {
        const double scale = 1 / (tolerance * (0.1 + fmax(fabs(one[i]), fabs(other[i]))));
        const double a = e5[i] * scale, b = e3[i] * scale;
        fifth += a * a;
        third += b * b;
    }
    return fifth > 0 ? p->h * fifth / sqrt(N * (fifth + 0.01 * third)) : 0;
}

/* Samples and guards in a step that ends at `to`: whether the mode ended in it; the run is then
 * there. */
static int look(magic_run *run, magic_step *p, double to)
{
    const double x = run->x, length = to - x;
    double from = 0, g0, r0, g1, r1;
    magic_vector z;
    magic_guard(&run->s, run->mode, run->demand, magic_read(&p->y), &g0, &r0);
    for (double sample = SUB * (floor(x / SUB) + 1); from < 1; sample += SUB) {
        const double share = sample < to ? (sample - x) / length : 1, width = share - from;
        if (share < 1) {
            magic_fill(run, p);
            magic_between(p, share, &z);
        } else {
            z = p->z;
        }
        magic_guard(&run->s, run->mode, run->demand, magic_read(&z), &g1, &r1);
        if (!magic_sure(g0, width * p->h * r0, g1, width * p->h * r1)) {
            const double end = magic_ends(run, p, from, share);
            if (end <= 1) {
                magic_between(p, end, &z);
                magic_turn(run, x + end * length, &z);
                return 1;
            }
        }
        if (sample <= to)
            magic_sample(run, sample, &z);
        from = share;
        g0 = g1;
        r0 = r1;
    }
    return 0;
}

int magic_dop853(const magic_parameters *p, double h, int samples, double tolerance, double *rows,
                 magic_result *result)
{
    magic_run run;
    magic_step step;
    double next = 0.1 * SUB, grow = 10;
    magic_begin(&run, p, h, samples, rows, result);
    while (run.x < run.end && result->events <= MANY) {
        const double stop = magic_stop(&run), to = fmin(run.x + next, stop), length = to - run.x;
        magic_attempt(&run, length * run.h, &step);
        const double error = estimate(&step, tolerance);
        const double factor = error > 0 ? 0.9 * pow(error, -0.125) : 10;
        result->steps++;
        if (error >= 1) {
            next = length * fmax(0.2, factor);
            grow = 1;
            continue;
        }
        next = (to < stop ? length : fmax(next, length)) * fmin(grow, factor);
        grow = 10;
        if (look(&run, &step, to)) {
            next = fmin(next, SUB);
            continue;
        }
        run.x = to;
        run.z = step.z;
        run.f = step.stage[DOP_STAGES];
        if (magic_breaks(&run)) {
            next = fmin(next, SUB);
            magic_renew(&run);
        }
    }
    return result->events > MANY ? -1 : 0;
}

int magic_sweep(const magic_parameters *base, double h, int samples, int count, const double *k,
                const double *tau_h, double tolerance, double *rows, magic_result *results)
{
    int failed = 0;
    for (int n = 0; n < count; n++) {
        magic_parameters one = *base;
        double *const to = rows ? rows + (long)n * samples * MAGIC_ROW : rows;
        one.k = k[n];
        one.tau_h = tau_h[n];
        failed += 0 != (tolerance > 0 ? magic_dop853(&one, h, samples, tolerance, to, results + n)
                                      : magic_exponential(&one, h, samples, to, results + n));
    }
    return failed;
}
