/* Steps, and the events in them. */
#include "magic_steps.h"

#include <string.h>

void magic_attempt(const magic_run *run, double h, magic_step *p)
{
    p->y = run->z;
    p->stage[0] = run->f;
    p->h = h;
    p->dense = 0;
    magic_stage(run, p, 1);
    magic_stage(run, p, 2);
    magic_stage(run, p, 3);
    magic_stage(run, p, 4);
    magic_stage(run, p, 5);
    magic_stage(run, p, 6);
    magic_stage(run, p, 7);
    magic_stage(run, p, 8);
    magic_stage(run, p, 9);
    magic_stage(run, p, 10);
    magic_stage(run, p, 11);
    magic_stage(run, p, 12);
}

void magic_fill(const magic_run *run, magic_step *p)
{
    const magic_vector end = p->z, change = end - p->y;
    if (p->dense)
        return;
    magic_stage(run, p, 13);
    magic_stage(run, p, 14);
    magic_stage(run, p, 15);
    p->z = end;
    p->dense = 1;
    p->between[0] = change;
    p->between[1] = p->h * p->stage[0] - change;
    p->between[2] = 2.0 * change - p->h * (p->stage[DOP_STAGES] + p->stage[0]);
    p->between[3] = p->h * magic_sum(p->stage, D[0], DOP_ALL);
    p->between[4] = p->h * magic_sum(p->stage, D[1], DOP_ALL);
    p->between[5] = p->h * magic_sum(p->stage, D[2], DOP_ALL);
    p->between[6] = p->h * magic_sum(p->stage, D[3], DOP_ALL);
}

void magic_between(const magic_step *p, double share, magic_vector *z)
{
    magic_vector sum = {0};
    for (int i = DENSE - 1; i >= 0; i--)
        sum = (sum + p->between[i]) * (i % 2 ? 1 - share : share);
    *z = p->y + sum;
}

/* A guard with a little room, as out of rest it begins with rounding. */
static double watched(const magic_run *run, const magic_step *p, double share, double *rate)
{
    double guard;
    magic_vector z;
    magic_between(p, share, &z);
    magic_guard(&run->s, run->mode, run->demand, magic_read(&z), &guard, rate);
    *rate *= p->h;
    return guard + (run->mode ? 1e-10 : 1e-9);
}

/* By false position, halving the weight of an end that stays (Illinois). */
static double root(const magic_run *run, const magic_step *p, double low, double high)
{
    double rate, g0 = watched(run, p, low, &rate), g1 = watched(run, p, high, &rate);
    for (int k = 0; k < 60 && high - low > 1e-15; k++) {
        const double middle = low + (high - low) * g0 / (g0 - g1);
        const double g = watched(run, p, middle, &rate);
        if (g < 0) {
            if (high - middle < 1e-15 || g == g1)
                return middle;
            high = middle;
            g1 = g;
            g0 *= 0.5;
        } else {
            if (g == 0 || middle - low < 1e-15)
                return high < middle + 1e-12 ? high : middle;
            low = middle;
            g0 = g;
            g1 *= 0.5;
        }
    }
    return high;
}

double magic_ends(const magic_run *run, magic_step *p, double low, double high)
{
    enum { DEEP = 10 };
    double stack[DEEP + 1], r0, r1;
    int left = 0, depth[DEEP + 1];
    double g0, from = low;
    magic_fill(run, p);
    g0 = watched(run, p, from, &r0);
    stack[0] = high;
    depth[0] = 0;
    while (left >= 0) {
        const double to = stack[left], width = to - from, g1 = watched(run, p, to, &r1);
        if (magic_sure(g0, width * r0, g1, width * r1) || (depth[left] == DEEP && g1 >= 0)) {
            from = to;
            g0 = g1;
            r0 = r1;
            left--;
        } else if (depth[left] == DEEP) {
            return g0 < 0 ? from : root(run, p, from, to);
        } else {
            stack[left + 1] = 0.5 * (from + to);
            depth[left + 1] = ++depth[left];
            left++;
        }
    }
    return 2.0;
}

void magic_renew(magic_run *run)
{
    const magic_vector forcing = {0, 0, 0, 0, 0, 0, run->s.rate * run->demand[0],
                                  run->s.rate * run->demand[1]};
    magic_matrix(&run->s, run->mode, run->A);
    run->forcing = forcing;
    magic_rates(run, &run->z, &run->f);
}

void magic_begin(magic_run *run, const magic_parameters *p, double h, int samples, double *rows,
                 magic_result *result)
{
    const magic_result none = {0, NAN, NAN, 0, 0, 0};
    const magic_vector zero = {0};
    magic_reduce(p, &run->s);
    *result = none;
    run->result = result;
    run->rows = rows;
    run->h = h / SUB;
    run->x = 0;
    run->end = (double)(samples - 1) * SUB;
    run->at[0] = floor(p->time_h / h + 0.5) * SUB;
    run->at[1] = floor(p->time_e / h + 0.5) * SUB;
    run->asked[0] = p->tau_h;
    run->asked[1] = p->tau_e;
    run->demand[0] = run->demand[1] = 0;
    run->mode = p->dw0 < 0 ? -1 : 1;
    run->known = 0;
    run->z = zero;
    magic_sample(run, 0, &run->z);
    magic_breaks(run);
    magic_renew(run);
}

void magic_sample(magic_run *run, double x, const magic_vector *at)
{
    const double *const z = magic_read(at), *const start = run->s.start;
    run->result->peak = fmax(run->result->peak, fabs(z[K1]));
    if (run->rows) {
        double *const row = run->rows + MAGIC_ROW * (long)(x / SUB);
        const double row_now[MAGIC_ROW] = {
            z[W1] + start[0], z[W2] + start[1], z[K1], z[K2], z[T1] + start[0], z[T2] + start[1],
            run->mode ? run->mode * z[TH] : magic_hold(&run->s, z), magic_slip(&run->s, z),
        };
        memcpy(row, row_now, sizeof row_now);
    }
}

void magic_turn(magic_run *run, double x, const magic_vector *at)
{
    double *const z = magic_states(&run->z);
    run->z = *at;
    run->x = x;
    run->known = 0;
    run->result->events++;
    run->result->last = x * run->h;
    if (fmod(x, SUB) == 0.0)
        magic_sample(run, x, at);
    const double hold = magic_hold(&run->s, z);
    if (run->mode && fabs(hold) <= z[TH]) {
        const double gap = 0.5 * (z[W1] - z[W2] + run->s.apart);
        run->mode = 0;
        z[W1] -= gap;
        z[W2] += gap;
        if (isnan(run->result->lock))
            run->result->lock = run->result->last;
    } else {
        run->mode = hold < 0 ? -1 : 1;
    }
    magic_renew(run);
}

int magic_breaks(magic_run *run)
{
    int any = 0;
    for (int j = 0; j < 2; j++)
        if (run->at[j] == run->x) {
            run->demand[j] = run->asked[j];
            any = 1;
        }
    return any;
}
