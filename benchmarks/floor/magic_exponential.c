/* One run by exponential steps. */
#include "magic_exponential.h"

#include <string.h>

#include "magic_table.h"

/* Squared so often as brings the rest of the polynomial below rounding: 0.75^17/17! = 2e-17. */
static const double RADIUS = 0.75, LONGEST = 1.5;

/* 1 / l! for l = 0..16 */
static const double INVERSE_FACTORIAL[17] = {
    1.0, 1.0, 1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 720, 1.0 / 5040, 1.0 / 40320,
    1.0 / 362880, 1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800.0,
    1.0 / 87178291200.0, 1.0 / 1307674368000.0, 1.0 / 20922789888000.0,
};

static inline magic_vector times(const magic_vector *A, const magic_vector *at)
{
    const double *const z = magic_read(at);
    const magic_vector one = A[0] * z[0] + A[1] * z[1] + A[2] * z[2] + A[3] * z[3];
    const magic_vector two = A[4] * z[4] + A[5] * z[5] + A[6] * z[6] + A[7] * z[7];
    return one + two;
}

static void product(const magic_vector *left, const magic_vector *right, magic_vector *to)
{
    for (int j = 0; j < N; j++)
        to[j] = times(left, right + j);
}

/* total = c[0] I + c[1] B + c[2] B^2 + c[3] B^3 + total, where powers[i] is B^(i+1). */
static void add_powers(const double *c, magic_vector (*powers)[N], magic_vector *total)
{
    for (int j = 0; j < N; j++) {
        total[j] += c[1] * powers[0][j] + c[2] * powers[1][j] + c[3] * powers[2][j];
        total[j][j] += c[0];
    }
}

/* exp(M) by its Taylor polynomial of degree 16 (Paterson, Stockmeyer), scaled and squared. */
static void exponential(const magic_vector *M, double norm, magic_vector *E)
{
    magic_vector powers[4][N], total[N];
    double scale = 1;
    int squarings = 0;
    for (; norm * scale > RADIUS; scale /= 2)
        squarings++;
    for (int j = 0; j < N; j++)
        powers[0][j] = scale * M[j];
    product(powers[0], powers[0], powers[1]);
    product(powers[1], powers[0], powers[2]);
    product(powers[1], powers[1], powers[3]);
    for (int j = 0; j < N; j++)
        E[j] = INVERSE_FACTORIAL[16] * powers[3][j];
    add_powers(INVERSE_FACTORIAL + 12, powers, E);
    for (int first = 8; first >= 0; first -= 4) {
        product(powers[3], E, total);
        add_powers(INVERSE_FACTORIAL + first, powers, total);
        memcpy(E, total, sizeof total);
    }
    for (; squarings > 0; squarings--) {
        product(E, E, total);
        memcpy(E, total, sizeof total);
    }
}

/* h times the sums of M^l b by the table's rows, of which there are so many. */
static void integrals(const magic_vector *M, magic_vector b, double h, int rows, magic_vector *to,
                      int apart)
{
    const double(*table)[MAGIC_TERMS] = MAGIC_ADAMS;
    magic_vector sum[HISTORY] = {{0}}, term = h * b;
    for (int l = 0; l < MAGIC_TERMS; l++) {
        for (int j = 0; j < rows; j++)
            sum[j] += table[j][l] * term;
        term = times(M, &term);
    }
    for (int j = 0; j < rows; j++)
        to[j * apart] = sum[j];
}

/* The integral of exp((1 - x) M) b, h times. */
static magic_vector integral(const magic_vector *M, magic_vector b, double h)
{
    magic_vector sum = {0}, term = h * b;
    for (int l = 1; l <= MAGIC_TERMS; l++) {
        term *= 1.0 / l;
        sum += term;
        term = times(M, &term);
    }
    return sum;
}

int magic_weigh(magic_run *run, magic_weights *w)
{
    const double norm = run->h * run->s.norm;
    magic_vector M[N];
    if (norm > LONGEST)
        return -1;
    magic_slopes(&run->s, run->wheel[0], w->slope);
    magic_matrix(&run->s, run->mode, M);
    for (int j = 0; j < 2; j++)
        M[T1 + j][T1 + j] = -w->slope[j];
    for (int j = 0; j < N; j++)
        M[j] *= run->h;
    exponential(M, norm, w->E);
    for (int j = 0; j < 2; j++) {
        magic_vector unit = {0};
        unit[T1 + j] = 1;
        integrals(M, unit, run->h, HISTORY, &w->weight[0][j], 2);
    }
    const magic_vector forcing = {0, 0, 0, 0, 0, 0, run->s.rate * run->demand[0],
                                  run->s.rate * run->demand[1]};
    w->constant = integral(M, forcing, run->h);
    w->mode = run->mode;
    memcpy(w->demand, run->demand, sizeof run->demand);
    run->result->renewals++;
    return 0;
}

/* What weights leave of the tires' torques, over inertia, at so many of the latest instants. */
static void remainders(const magic_system *s, const magic_weights *w, int count,
                       const double (*wheel)[2], double (*rest)[2])
{
    for (int n = 0; n < count; n++)
        for (int j = 0; j < 2; j++) {
            const double torque = magic_torque(s, s->scale[j] * wheel[n][j]);
            rest[n][j] = w->slope[j] * wheel[n][j] - s->wheel_inverse * torque;
        }
}

static inline void weighed(const magic_weights *w, const double (*rest)[2], const magic_vector *at,
                           magic_vector *to)
{
    magic_vector one = w->constant, two = times(w->E, at);
    for (int j = 0; j < HISTORY; j++) {
        one += rest[j][0] * w->weight[j][0];
        two += rest[j][1] * w->weight[j][1];
    }
    *to = one + two;
}

/* Samples as long as nothing is to be decided; 0 where something may happen before the next one, 1
 * at a demand's step or the end, 2 where slopes have changed. */
static int advance(magic_run *run, const magic_weights *w)
{
    const double stop = magic_stop(run);
    double wheel[HISTORY + SUB][2], rest[HISTORY + SUB][2], slope[2], g0, r0, g1, r1;
    int result = run->x < stop ? -1 : 1;
    memcpy(wheel + SUB, run->wheel, sizeof run->wheel);
    remainders(&run->s, w, HISTORY, (const double(*)[2])run->wheel, rest + SUB);
    magic_guard(&run->s, run->mode, run->demand, magic_read(&run->z), &g0, &r0);
    while (result < 0) {
        const double h = SUB * run->h;
        magic_vector z = run->z;
        for (int n = SUB - 1; n >= 0; n--) {
            weighed(w, (const double(*)[2])rest + n + 1, &z, &z);
            wheel[n][0] = z[T1];
            wheel[n][1] = z[T2];
            remainders(&run->s, w, 1, (const double(*)[2])wheel + n, rest + n);
        }
        magic_guard(&run->s, run->mode, run->demand, magic_read(&z), &g1, &r1);
        if (!magic_sure(g0, h * r0, g1, h * r1)) {
            result = 0;
            break;
        }
        run->z = z;
        run->x += SUB;
        memmove(wheel + SUB, wheel, sizeof run->wheel);
        memmove(rest + SUB, rest, sizeof run->wheel);
        g0 = g1;
        r0 = r1;
        magic_sample(run, run->x, &z);
        run->result->steps += SUB;
        magic_slopes(&run->s, wheel[0], slope);
        const double change = fmax(fabs(slope[0] - w->slope[0]), fabs(slope[1] - w->slope[1]));
        result = run->x >= stop ? 1 : run->h * change > MAGIC_CHANGE ? 2 : -1;
    }
    memcpy(run->wheel, wheel + SUB, sizeof run->wheel);
    return result;
}

int magic_exponential(const magic_parameters *p, double h, int samples, double *rows,
                      magic_result *result)
{
    magic_run run;
    magic_weights w;
    magic_begin(&run, p, h, samples, rows, result);
    int failed = magic_settle(&run, 0) || magic_weigh(&run, &w);
    while (!failed && run.x < run.end) {
        const int why = advance(&run, &w);
        if (why == 1 && magic_breaks(&run))
            run.known = 0;
        if (why != 2)
            failed = magic_settle(&run, why ? run.x : run.x + SUB);
        if (why == 2 || magic_stale(&run, &w))
            failed |= magic_weigh(&run, &w);
    }
    return failed ? -1 : 0;
}
