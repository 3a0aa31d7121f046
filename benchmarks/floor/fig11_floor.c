/* Fig. 11 by hand: the active limited slip differential with compliant halfshafts, linear tires
 * and one Coulomb clutch, stepped exactly. What generated code for the same run is measured
 * against. Equations: IMECE2008-69248, (13)-(19) and Appendix B.
 *
 * A sample is a row of eight: omega_1, omega_2, tau_k1, tau_k2, omega_t1, omega_t2, tau_f, slip.
 * It is at the same time all of the state but the engine torque, so a step is one product of a
 * matrix of eight columns with the previous row, written straight to its place.
 *
 * No event is missed: with a guard g (which is positive as long as its mode lasts) and its slope
 * at both ends of a step h, g differs from the cubic through them by at most h^4/384 max |g''''|,
 * and the cubic stays above the least of its four Bernstein coefficients. The fourth derivative is
 * bounded by the energy of the rates z', which only the inputs can raise. A step that fails this
 * test is repeated by Taylor series whose first root is isolated with bounds on g''. */
#include "fig11_floor.h"

#include <math.h>
#include <pthread.h>
#include <string.h>

enum { W1, W2, K1, K2, T1, T2, TF, SLIP, N };
/* Inside a step of Taylor series the last two hold the lagged torques instead. */
enum { TH = TF, TE = SLIP };
enum { STRIDE = FIG11_STRIDE, RENEWAL = 64, BLOCK = 256, DEGREE = 20, EVENTS_IN_A_STEP = 64 };
static const double RADIUS = 0.75; /* of the Taylor polynomials: 0.75^17/17! = 2e-17 */

typedef double vector[N];
typedef double matrix[N][N]; /* by columns */

/* Unlike fmin and fmax instructions, not calls. */
static inline double lesser(double a, double b)
{
    return a < b ? a : b;
}

static inline double greater(double a, double b)
{
    return a > b ? a : b;
}

/* ---- the model ------------------------------------------------------------------------ */

static void reduce(const fig11_parameters *p, fig11_system *s)
{
    const double a = p->i * p->i * p->I_i / 4;
    const double determinant = p->I_1 * p->I_2 + a * (p->I_1 + p->I_2);
    s->inverse_11 = (p->I_2 + a) / determinant;
    s->inverse_12 = -a / determinant;
    s->inverse_22 = (p->I_1 + a) / determinant;
    s->stuck_mass = p->I_1 + p->I_2 + 4 * a;
    s->stuck_inverse = 1 / s->stuck_mass;
    s->a = a;
    s->I_1 = p->I_1;
    s->I_2 = p->I_2;
    s->I_w = p->I_w;
    s->wheel_inverse = 1 / p->I_w;
    s->k = p->k;
    s->half_i = p->i / 2;
    s->start_1 = p->omega_0;
    s->start_2 = p->omega_0 - p->dw0;
    s->slope_1 = p->k_t * p->r / s->start_1;
    s->slope_2 = p->k_t * p->r / s->start_2;
    s->lag = p->lag;
    s->rate = 1 / p->lag;
    s->asymmetry = (p->I_1 - p->I_2) * s->stuck_inverse;
}

/* The torque that holds the clutch; linear in y, so it also serves rates and coefficients. */
static inline double hold(const fig11_system *s, const double *y, double tau_e)
{
    return y[K2] - y[K1] - s->asymmetry * (2 * s->half_i * tau_e - y[K1] - y[K2]);
}

/* dy = M y, linear part only; tires about their start (`unit` is 1) or about zero (0). */
static inline void apply(const fig11_system *s, int mode, const double *y, double unit,
                         double *dy)
{
    const double drive = s->half_i * y[TE];
    if (mode == 0) {
        dy[W1] = s->stuck_inverse * (2 * drive - y[K1] - y[K2]);
        dy[W2] = dy[W1];
    } else {
        const double friction = 0.5 * mode * y[TH];
        const double q1 = drive - friction - y[K1];
        const double q2 = drive + friction - y[K2];
        dy[W1] = s->inverse_11 * q1 + s->inverse_12 * q2;
        dy[W2] = s->inverse_12 * q1 + s->inverse_22 * q2;
    }
    dy[K1] = s->k * (y[W1] - y[T1]);
    dy[K2] = s->k * (y[mode ? W2 : W1] - y[T2]);
    dy[T1] = s->wheel_inverse * (y[K1] - s->slope_1 * (y[T1] - unit * s->start_1));
    dy[T2] = s->wheel_inverse * (y[K2] - s->slope_2 * (y[T2] - unit * s->start_2));
    dy[TH] = -s->rate * y[TH];
    dy[TE] = -s->rate * y[TE];
}

/* dy/dt with the demands on the two lags. */
static inline void rates(const fig11_system *s, int mode, const double *y, const double *demand,
                         double *dy)
{
    apply(s, mode, y, 1.0, dy);
    dy[TH] += s->rate * demand[0];
    dy[TE] += s->rate * demand[1];
}

void fig11_rhs(const fig11_system *s, double t, const double *x, const double *u, double *dx)
{
    const double drive = s->half_i * u[0];
    const double friction = 0.5 * u[1];
    const double q1 = drive - friction - x[K1];
    const double q2 = drive + friction - x[K2];
    (void)t;
    dx[W1] = s->inverse_11 * q1 + s->inverse_12 * q2;
    dx[W2] = s->inverse_12 * q1 + s->inverse_22 * q2;
    dx[K1] = s->k * (x[W1] - x[T1]);
    dx[K2] = s->k * (x[W2] - x[T2]);
    dx[T1] = s->wheel_inverse * (x[K1] - s->slope_1 * (x[T1] - s->start_1));
    dx[T2] = s->wheel_inverse * (x[K2] - s->slope_2 * (x[T2] - s->start_2));
}

/* ---- exponentials --------------------------------------------------------------------- */

static inline void multiply(matrix left, matrix right, matrix product)
{
    for (int j = 0; j < N; j++) {
        vector sum = {0};
        for (int l = 0; l < N; l++)
#pragma GCC unroll 1 /* so that gcc vectorises the loop instead of unrolling it */
            for (int i = 0; i < N; i++)
                sum[i] += left[l][i] * right[j][l];
        memcpy(product[j], sum, sizeof sum);
    }
}

/* total = c[0] I + c[1] B + c[2] B^2 + c[3] B^3 + total, where powers[i] is B^(i+1). */
static inline void add_terms(const double *c, matrix *powers, matrix total)
{
    for (int j = 0; j < N; j++) {
        for (int i = 0; i < N; i++)
            total[j][i] += c[1] * powers[0][j][i] + c[2] * powers[1][j][i]
                           + c[3] * powers[2][j][i];
        total[j][j] += c[0];
    }
}

/* 1 / l! for l = 0..16 */
static const double INVERSE_FACTORIAL[17] = {
    1.0, 1.0, 1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 720, 1.0 / 5040, 1.0 / 40320,
    1.0 / 362880, 1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800.0,
    1.0 / 87178291200.0, 1.0 / 1307674368000.0, 1.0 / 20922789888000.0,
};

/* exp(B) by its Taylor polynomial of degree 16 (Paterson, Stockmeyer), scaled and squared. */
static void exponential(matrix b, double norm, matrix result)
{
    matrix powers[4], total;
    int squarings = 0;
    double scale = 1.0;
    for (; norm * scale > RADIUS; scale /= 2)
        squarings++;
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++)
            powers[0][j][i] = scale * b[j][i];
    multiply(powers[0], powers[0], powers[1]);
    multiply(powers[1], powers[0], powers[2]);
    multiply(powers[1], powers[1], powers[3]);
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++)
            result[j][i] = INVERSE_FACTORIAL[16] * powers[3][j][i];
    add_terms(INVERSE_FACTORIAL + 12, powers, result);
    for (int first = 8; first >= 0; first -= 4) {
        multiply(powers[3], result, total);
        add_terms(INVERSE_FACTORIAL + first, powers, total);
        memcpy(result, total, sizeof total);
    }
    for (; squarings > 0; squarings--) {
        multiply(result, result, total);
        memcpy(result, total, sizeof total);
    }
}

/* A bound on |M| in the norm of the energy: undamped shafts, then tires, then lags. */
static double growth(const fig11_system *s)
{
    const double lightest = lesser(s->I_1, s->I_2);
    const double springs = sqrt(s->k / lightest) + sqrt(s->k * s->wheel_inverse);
    return springs + greater(s->slope_1, s->slope_2) * s->wheel_inverse + s->rate;
}

/* The norm of a row that acts on rates, dual to their energy. */
static double dual_norm(const fig11_system *s, int mode, const double *row)
{
    double sum = s->k * (row[K1] * row[K1] + row[K2] * row[K2])
                 + s->wheel_inverse * (row[T1] * row[T1] + row[T2] * row[T2]);
    if (mode)
        sum += s->inverse_11 * row[W1] * row[W1] + s->inverse_22 * row[W2] * row[W2]
               + 2 * s->inverse_12 * row[W1] * row[W2];
    else
        sum += s->stuck_inverse * row[W1] * row[W1];
    return sqrt(sum);
}

/* The row that gives the guard: half the speed difference, or the holding torque. */
static inline double guarded(const fig11_system *s, int mode, const double *y)
{
    return mode ? 0.5 * (y[W1] - y[W2]) : hold(s, y, y[TE]);
}

/* From (states, tau_h, tau_e) to a row: what the last two of it follow from. */
static void finish_rows(const fig11_system *s, int mode, matrix step)
{
    for (int j = 0; j < N; j++) {
        double *column = step[j];
        if (mode == 0) {
            column[W2] = column[W1];
            column[TF] = hold(s, column, column[TE]);
        }
        column[SLIP] = mode ? 0.5 * (column[W1] - column[W2]) : 0.0;
    }
}

static void prepare_mode(const fig11_system *s, int mode, double h, fig11_mode *m)
{
    matrix *const powers = m->step;
    matrix generator, scaled;
    vector third;
    for (int j = 0; j < N; j++) {
        vector unit = {0}, first, second;
        unit[j] = 1.0;
        apply(s, mode, unit, 0.0, generator[j]);
        for (int i = 0; i < N; i++)
            scaled[j][i] = h * generator[j][i];
        apply(s, mode, generator[j], 0.0, first);
        apply(s, mode, first, 0.0, second);
        third[j] = guarded(s, mode, second);
        m->slope[j] = h / 3 * guarded(s, mode, generator[j]);
    }
    exponential(scaled, h * growth(s), powers[0]);
    for (int r = 1; r < STRIDE; r++)
        multiply(powers[0], powers[r - 1], powers[r]);
    for (int r = 0; r < STRIDE; r++)
        finish_rows(s, mode, powers[r]);
    m->fourth = dual_norm(s, mode, third);
    m->fourth_h = fabs(third[TH]);
    m->fourth_e = fabs(third[TE]);
}

void fig11_prepare(const fig11_parameters *p, double h, fig11_context *c)
{
    reduce(p, &c->system);
    c->h = h;
    c->norm = h * growth(&c->system);
    c->demand_e = p->tau_e;
    c->demand_h = p->tau_h;
    c->index_e = (long)floor(p->time_e / h + 0.5);
    c->index_h = (long)floor(p->time_h / h + 0.5);
    const double own = c->system.inverse_11 + c->system.inverse_22;
    c->torque_e = c->system.half_i * sqrt(own + 2 * c->system.inverse_12);
    c->torque_h = 0.5 * sqrt(own - 2 * c->system.inverse_12);
    c->decay = exp(-h / p->lag);
    prepare_mode(&c->system, 1, h, &c->slip);
    prepare_mode(&c->system, 0, h, &c->stuck);
}

/* ---- regular steps -------------------------------------------------------------------- */

/* Where a run is: the mode, the lagged torques and the demands on them. */
typedef struct {
    int mode;
    double tau_h, tau_e;
    double demand[2]; /* hydraulic, engine */
    fig11_event *events;
    int count, capacity;
} progress;

/* From a row to the state of the Taylor steps, and back. */
static inline void unpack(const progress *g, const double *row, double *y)
{
    memcpy(y, row, 6 * sizeof *y);
    y[TH] = g->tau_h;
    y[TE] = g->tau_e;
}

static inline void pack(const fig11_system *s, progress *g, const double *y, double *row)
{
    memcpy(row, y, 6 * sizeof *y);
    g->tau_h = y[TH];
    g->tau_e = y[TE];
    row[TF] = g->mode ? g->mode * y[TH] : hold(s, y, y[TE]);
    row[SLIP] = g->mode ? 0.5 * (y[W1] - y[W2]) : 0.0;
}

/* The rest that the mode tends to under constant demands. */
static void rest(const fig11_system *s, const progress *g, double *z)
{
    const double drive = s->half_i * g->demand[1], brake = 0.5 * g->mode * g->demand[0];
    z[K1] = drive - brake;
    z[K2] = drive + brake;
    if (g->mode == 0) {
        const double speed = (2 * drive + s->slope_1 * s->start_1 + s->slope_2 * s->start_2)
                             / (s->slope_1 + s->slope_2);
        z[K1] = s->slope_1 * (speed - s->start_1);
        z[K2] = s->slope_2 * (speed - s->start_2);
    }
    z[T1] = z[W1] = s->start_1 + z[K1] / s->slope_1;
    z[T2] = z[W2] = s->start_2 + z[K2] / s->slope_2;
    z[TF] = g->mode ? g->mode * g->demand[0] : hold(s, z, g->demand[1]);
    z[SLIP] = g->mode ? 0.5 * (z[W1] - z[W2]) : 0.0;
}

/* constant[r] = z - P^(r+1) z at rest, so that a row leaps to P^(r+1) row + constant[r]. */
static void constants(const fig11_context *c, const fig11_mode *m, const progress *g,
                      double (*constant)[N])
{
    const double e = g->demand[1];
    vector z;
    rest(&c->system, g, z);
    for (int r = 0; r < STRIDE; r++) {
        const double(*p)[N] = (const double(*)[N])m->step[r];
#pragma GCC unroll 1
        for (int i = 0; i < N; i++)
            constant[r][i] = (z[i] - p[TE][i] * e - p[W1][i] * z[W1] - p[K1][i] * z[K1]
                              - p[T1][i] * z[T1])
                             - (p[W2][i] * z[W2] + p[K2][i] * z[K2] + p[T2][i] * z[T2]
                                + p[TF][i] * z[TF]);
    }
}

/* h^4/384 times a bound on the guard's fourth derivative, for as long as the demands stay. */
static double uncertainty(const fig11_context *c, const fig11_mode *m, const progress *g,
                          const double *row)
{
    const fig11_system *s = &c->system;
    const double h2 = c->h * c->h;
    vector y, d;
    unpack(g, row, y);
    rates(s, g->mode, y, g->demand, d);
    const double drop_h = fabs(d[TH]), drop_e = fabs(d[TE]), sum = d[W1] + d[W2];
    const double energy = s->I_1 * d[W1] * d[W1] + s->I_2 * d[W2] * d[W2] + s->a * sum * sum
                          + (d[K1] * d[K1] + d[K2] * d[K2]) / s->k
                          + s->I_w * (d[T1] * d[T1] + d[T2] * d[T2]);
    const double raised = s->lag * (c->torque_e * drop_e + (g->mode ? c->torque_h * drop_h : 0));
    double fourth = m->fourth * (sqrt(energy) + raised) + m->fourth_e * drop_e;
    fourth += g->mode ? m->fourth_h * drop_h : drop_h * s->rate * s->rate * s->rate;
    return h2 * h2 / 384 * fourth;
}

/* The next `ahead` rows, all from the same one: they don't wait for each other. */
static inline void leap(const fig11_mode *m, double (*constant)[N], const double *z, double e,
                        int ahead, double (*next)[N])
{
    const double w1 = z[W1], w2 = z[W2], k1 = z[K1], k2 = z[K2], t1 = z[T1], t2 = z[T2];
    const double f = z[TF];
    for (int r = 0; r < ahead; r++) {
        const double(*p)[N] = (const double(*)[N])m->step[r];
        double *to = next[r];
#pragma GCC unroll 1
        for (int i = 0; i < N; i++)
            to[i] = (constant[r][i] + p[TE][i] * e + p[W1][i] * w1 + p[K1][i] * k1
                     + p[T1][i] * t1)
                    + (p[W2][i] * w2 + p[K2][i] * k2 + p[T2][i] * t2 + p[TF][i] * f);
    }
}

/* Slipping steps from rows[0]; returns how many are certain to be without an event. */
static int slip_steps(const fig11_context *c, progress *g, int count, double (*rows)[N])
{
    const fig11_mode *m = &c->slip;
    const double decay = c->decay, gain = (1 - decay) * g->demand[1], sign = g->mode;
    double slack = 0.0;
    const double by_k1 = sign * m->slope[K1], by_k2 = sign * m->slope[K2];
    const double by_f = sign * m->slope[TF], by_e = sign * m->slope[TE];
    double e = g->tau_e, guard = sign * rows[0][SLIP];
    double slope = by_k1 * rows[0][K1] + by_k2 * rows[0][K2] + by_f * rows[0][TF] + by_e * e;
    double constant[STRIDE][N];
    int n = 0, sure = 1;
    constants(c, m, g, constant);
    while (sure && n < count) {
        if (n % RENEWAL == 0) {
            g->tau_e = e;
            g->tau_h = sign * rows[n][TF];
            slack = uncertainty(c, m, g, rows[n]);
        }
        const int ahead = count - n < STRIDE ? count - n : STRIDE;
        double(*next)[N] = rows + n + 1;
        leap(m, constant, rows[n], e, ahead, next);
        for (int r = 0; r < ahead; r++) {
            const double *z = next[r];
            const double e_next = decay * e + gain, next_guard = sign * z[SLIP];
            const double next_slope = by_k1 * z[K1] + by_k2 * z[K2] + by_f * z[TF] + by_e * e_next;
            const double inner = lesser(guard + slope, next_guard - next_slope);
            sure = lesser(lesser(guard, next_guard), inner) > slack;
            if (!sure)
                break;
            e = e_next;
            guard = next_guard;
            slope = next_slope;
            n++;
        }
    }
    g->tau_e = e;
    g->tau_h = sign * rows[n][TF];
    return n;
}

/* A third of a step's change of the holding torque at its present slope. */
static inline double hold_slope(const fig11_mode *m, const double *z, double missing_e)
{
    return m->slope[W1] * z[W1] + m->slope[K1] * z[K1] + m->slope[K2] * z[K2]
           + m->slope[T1] * z[T1] + m->slope[T2] * z[T2] - m->slope[TE] * missing_e;
}

/* Stuck steps, likewise. The level less the size of the holding torque is the guard. */
static int stuck_steps(const fig11_context *c, progress *g, int count, double (*rows)[N])
{
    const fig11_mode *m = &c->stuck;
    const double decay = c->decay, third = c->h / 3 * c->system.rate;
    const double level = g->demand[0], engine = g->demand[1];
    double slack = 0.0;
    double e = g->tau_e, h = g->tau_h, f = rows[0][TF];
    double slope = hold_slope(m, rows[0], engine - e), constant[STRIDE][N];
    int n = 0, sure = 1;
    constants(c, m, g, constant);
    while (sure && n < count) {
        if (n % RENEWAL == 0) {
            g->tau_e = e;
            g->tau_h = h;
            slack = uncertainty(c, m, g, rows[n]);
        }
        const int ahead = count - n < STRIDE ? count - n : STRIDE;
        double(*next)[N] = rows + n + 1;
        leap(m, constant, rows[n], e, ahead, next);
        for (int r = 0; r < ahead; r++) {
            const double e_next = engine + decay * (e - engine);
            const double h_next = level + decay * (h - level), f_next = next[r][TF];
            const double next_slope = hold_slope(m, next[r], engine - e_next);
            const double ends = lesser(h - fabs(f), h_next - fabs(f_next));
            const double inner = lesser(h + third * (level - h) - fabs(f + slope),
                                        h_next - third * (level - h_next)
                                            - fabs(f_next - next_slope));
            sure = lesser(ends, inner) > slack;
            if (!sure)
                break;
            e = e_next;
            h = h_next;
            f = f_next;
            slope = next_slope;
            n++;
        }
    }
    g->tau_e = e;
    g->tau_h = h;
    return n;
}

/* ---- steps with events ---------------------------------------------------------------- */

typedef struct {
    double c[DEGREE + 1];
    int degree;
} series;

static inline double value(const series *p, double t)
{
    double sum = p->c[p->degree];
    for (int l = p->degree - 1; l >= 0; l--)
        sum = sum * t + p->c[l];
    return sum;
}

static inline double slope(const series *p, double t)
{
    double sum = p->degree * p->c[p->degree];
    for (int l = p->degree - 1; l > 0; l--)
        sum = sum * t + l * p->c[l];
    return sum;
}

/* A bound on |p''| over 0..t. */
static double curvature(const series *p, double t)
{
    double sum = 0.0;
    for (int l = p->degree; l > 1; l--)
        sum = sum * t + (double)(l * (l - 1)) * fabs(p->c[l]);
    return sum;
}

/* The root of a monotone p between low (p > 0) and high (p <= 0): Newton, kept inside. */
static double polish(const series *p, double low, double high)
{
    double t = 0.5 * (low + high);
    for (int tries = 0; tries < 60 && high - low > 1e-17; tries++) {
        const double at = value(p, t);
        *(at > 0 ? &low : &high) = t;
        double next = t - at / slope(p, t);
        if (!(next >= low && next <= high))
            next = 0.5 * (low + high);
        if (fabs(next - t) <= 1e-17)
            return next;
        t = next;
    }
    return t;
}

/* The first t in (0, end] from which p is not positive; negative if there is none. Intervals are
 * taken from the left, cleared by bounds or halved, so that no pair of roots hides in one. */
static double first_root(const series *p, double end)
{
    const double bound = curvature(p, end), finest = 1e-15;
    double low = 0.0, width = end;
    if (p->c[0] <= 0)
        return 0.0;
    while (low < end) {
        const double high = lesser(low + width, end), half = 0.5 * (high - low);
        const double at = value(p, low + half), steep = slope(p, low + half);
        if (at > half * fabs(steep) + 0.5 * half * half * bound) {
            low = high;
            width *= 2;
        } else if (fabs(steep) > half * bound || half < finest) {
            if (value(p, high) <= 0)
                return polish(p, low, high);
            low = high;
        } else {
            width = half;
        }
    }
    return -1.0;
}

/* Coefficients of the state's Taylor series, scaled so that row l is that of t^l. */
static int expand(const fig11_system *s, const progress *g, const double *y, double reach,
                  double (*terms)[N])
{
    int degree = 1;
    double size = reach;
    memcpy(terms[0], y, sizeof(vector));
    rates(s, g->mode, y, g->demand, terms[1]);
    for (; degree < DEGREE && size > 1e-18; degree++) {
        const double factor = 1.0 / (degree + 1);
        apply(s, g->mode, terms[degree], 0.0, terms[degree + 1]);
        for (int i = 0; i < N; i++)
            terms[degree + 1][i] *= factor;
        size *= reach * factor;
    }
    return degree;
}

/* The mode after the guard of `g` has vanished at y; what vanishes with it is set to zero. */
static int decide(const fig11_system *s, const progress *g, double *y)
{
    const double torque = hold(s, y, y[TE]);
    y[W1] = y[W2] = 0.5 * (y[W1] + y[W2]);
    if (g->mode && fabs(torque) <= y[TH])
        return 0;
    if (torque != 0)
        return torque > 0 ? 1 : -1;
    vector d;
    rates(s, 0, y, g->demand, d);
    return hold(s, d, d[TE]) > 0 ? 1 : -1;
}

/* When the mode ends within `span`; negative if it lasts. The slip starts as t^order: such roots
 * at the start are divided out. */
static double ending(const fig11_system *s, const progress *g, double (*terms)[N], int degree,
                     double span, int order)
{
    series p = {{0}, 0};
    if (g->mode) {
        p.degree = degree - order;
        for (int l = 0; l <= p.degree; l++)
            p.c[l] = g->mode * guarded(s, 1, terms[l + order]);
        return first_root(&p, span);
    }
    double earliest = -1.0;
    for (int side = -1; side <= 1; side += 2) {
        p.degree = degree;
        for (int l = 0; l <= degree; l++)
            p.c[l] = terms[l][TH] + side * guarded(s, 0, terms[l]);
        const double t = first_root(&p, earliest < 0 ? span : earliest);
        earliest = t < 0 ? earliest : t;
    }
    return earliest;
}

/* One sample step by Taylor series, through whatever events it holds. Returns 0 if they have no
 * end. */
static int event_step(const fig11_context *c, progress *g, double start, const double *row,
                      double *next)
{
    const fig11_system *s = &c->system;
    const double part = c->h / ceil(c->norm);
    double done = 0.0, terms[DEGREE + 1][N];
    vector y;
    int order = 0, events = 0;
    unpack(g, row, y);
    while (done < c->h) {
        const double left = c->h - done, span = left < 1.0001 * part ? left : part;
        const int degree = expand(s, g, y, c->norm / c->h * span, terms);
        const double end = ending(s, g, terms, degree, span, order);
        const double t = end < 0 ? span : end;
        for (int i = 0; i < N; i++)
            y[i] = terms[degree][i];
        for (int l = degree - 1; l >= 0; l--)
            for (int i = 0; i < N; i++)
                y[i] = y[i] * t + terms[l][i];
        done = end < 0 && span == left ? c->h : done + t;
        order = 0;
        if (end < 0)
            continue;
        const int mode = decide(s, g, y);
        order = mode == 0 ? 0 : g->mode == 0 ? 2 : 1;
        g->mode = mode;
        if (g->count < g->capacity)
            g->events[g->count] = (fig11_event){start + done, mode, order};
        g->count++;
        if (++events > EVENTS_IN_A_STEP)
            return 0;
    }
    pack(s, g, y, next);
    return 1;
}

/* ---- runs ----------------------------------------------------------------------------- */

static void begin(const fig11_context *c, progress *g, double *row)
{
    const fig11_system *s = &c->system;
    memset(row, 0, sizeof(vector));
    row[W1] = row[T1] = s->start_1;
    row[W2] = row[T2] = s->start_2;
    row[SLIP] = 0.5 * (s->start_1 - s->start_2);
    g->mode = (row[SLIP] > 0) - (row[SLIP] < 0);
}

/* Steps on from rows[0], sample `at` of the run, under constant demands; how many rows it made, -1
 * on failure. */
static int go_on(const fig11_context *c, progress *g, long at, int count, double (*rows)[N])
{
    const int made = g->mode ? slip_steps(c, g, count, rows) : stuck_steps(c, g, count, rows);
    if (made == count)
        return made;
    const double start = (double)(at + made) * c->h;
    return event_step(c, g, start, rows[made], rows[made + 1]) ? made + 1 : -1;
}

/* The same as the demands step. */
static int advance(const fig11_context *c, progress *g, long at, int count, double (*rows)[N])
{
    if (at < c->index_e)
        count = at + count < c->index_e ? count : (int)(c->index_e - at);
    if (at < c->index_h)
        count = at + count < c->index_h ? count : (int)(c->index_h - at);
    g->demand[0] = at >= c->index_h ? c->demand_h : 0.0;
    g->demand[1] = at >= c->index_e ? c->demand_e : 0.0;
    return go_on(c, g, at, count, rows);
}

int fig11_run(const fig11_context *c, int samples, double *out, fig11_event *events, int capacity)
{
    progress g = {.events = events, .capacity = capacity};
    double(*rows)[N] = (double(*)[N])out;
    begin(c, &g, rows[0]);
    for (int n = 0; n < samples - 1;) {
        const int made = advance(c, &g, n, samples - 1 - n, rows + n);
        if (made < 0)
            return -1;
        n += made;
    }
    return g.count;
}

int fig11_run_closed(const fig11_parameters *p, const fig11_controller *pi, double h, int samples,
                     double *out, fig11_event *events, int capacity)
{
    progress g = {.events = events, .capacity = capacity};
    double(*rows)[N] = (double(*)[N])out, sum = pi->start;
    fig11_context context, *const c = &context;
    fig11_prepare(p, h, c);
    begin(c, &g, rows[0]);
    g.tau_h = pi->start;
    rows[0][TF] = g.mode * pi->start;
    for (int n = 0; n < samples - 1;) {
        if (n % pi->every == 0) {
            const double wrong = rows[n][W2] - rows[n][W1] - pi->wanted;
            g.demand[0] = pi->gain * wrong + sum;
            sum += pi->every * h * pi->reset * wrong;
        }
        int count = pi->every - n % pi->every;
        if (n < c->index_e && n + count > c->index_e)
            count = (int)(c->index_e - n);
        g.demand[1] = n >= c->index_e ? c->demand_e : 0.0;
        const int left = samples - 1 - n;
        const int made = go_on(c, &g, n, count < left ? count : left, rows + n);
        if (made < 0)
            return -1;
        n += made;
    }
    return g.count;
}

int fig11_run_anew(const fig11_parameters *p, double h, int samples, double *out,
                   fig11_event *events, int capacity)
{
    fig11_context context;
    fig11_prepare(p, h, &context);
    return fig11_run(&context, samples, out, events, capacity);
}

/* ---- sweeps --------------------------------------------------------------------------- */

/* Peak |halfshaft torque| over the samples and the first instant of lock, without the rows. */
static int measure(const fig11_context *c, int samples, double *peak, double *lock)
{
    fig11_event event[1];
    progress g = {.events = event, .capacity = 1};
    double rows[BLOCK + 1][N], high = 0.0;
    begin(c, &g, rows[0]);
    *lock = NAN;
    for (int n = 0; n < samples - 1;) {
        const int left = samples - 1 - n;
        const int made = advance(c, &g, n, left < BLOCK ? left : BLOCK, rows);
        if (made < 0)
            return 0;
        for (int l = 1; l <= made; l++)
            high = greater(high, greater(fabs(rows[l][K1]), fabs(rows[l][K2])));
        if (isnan(*lock) && g.count > 0 && event[0].mode == 0)
            *lock = event[0].time;
        if (isnan(*lock))
            g.count = 0;
        memcpy(rows[0], rows[made], sizeof(vector));
        n += made;
    }
    *peak = high;
    return 1;
}

int fig11_sweep(const fig11_parameters *base, double h, int samples, int count, const double *k,
                const double *tau_h, double *peak, double *lock)
{
    int failed = 0;
    for (int n = 0; n < count; n++) {
        fig11_parameters p = *base;
        fig11_context context;
        p.k = k[n];
        p.tau_h = tau_h[n];
        fig11_prepare(&p, h, &context);
        if (!measure(&context, samples, peak + n, lock + n)) {
            peak[n] = lock[n] = NAN;
            failed++;
        }
    }
    return failed;
}

typedef struct {
    const fig11_parameters *base;
    double h;
    int samples, count, failed;
    const double *k, *tau_h;
    double *peak, *lock;
} share;

static void *work(void *argument)
{
    share *w = argument;
    w->failed = fig11_sweep(w->base, w->h, w->samples, w->count, w->k, w->tau_h, w->peak,
                            w->lock);
    return NULL;
}

int fig11_sweep_threads(const fig11_parameters *base, double h, int samples, int count,
                        const double *k, const double *tau_h, double *peak, double *lock,
                        int threads)
{
    pthread_t started[FIG11_MAX_THREADS];
    int running[FIG11_MAX_THREADS];
    share shares[FIG11_MAX_THREADS];
    int failed = 0, first = 0;
    threads = threads < 1 ? 1 : threads > FIG11_MAX_THREADS ? FIG11_MAX_THREADS : threads;
    for (int t = 0; t < threads; t++) {
        const int last = (int)((long)count * (t + 1) / threads);
        shares[t] = (share){base, h, samples, last - first, 0, k + first, tau_h + first,
                            peak + first, lock + first};
        running[t] = t + 1 < threads && pthread_create(started + t, NULL, work, shares + t) == 0;
        first = last;
    }
    for (int t = threads - 1; t >= 0; t--) { /* what has no thread of its own is done here */
        if (running[t])
            pthread_join(started[t], NULL);
        else
            work(shares + t);
        failed += shares[t].failed;
    }
    return failed;
}

/* ---- drivers of measurements ---------------------------------------------------------- */

double fig11_drive_rhs(const fig11_parameters *p, long calls, double dt)
{
    /* volatile: every call is a call, as a solver of another file makes it */
    void (*volatile rhs)(const fig11_system *, double, const double *, const double *, double *)
        = fig11_rhs;
    fig11_system s;
    double x[6] = {0}, dx[6], u[2] = {p->tau_e, p->tau_h};
    reduce(p, &s);
    x[W1] = x[T1] = s.start_1;
    x[W2] = x[T2] = s.start_2;
    for (long n = 0; n < calls; n++) {
        rhs(&s, (double)n * dt, x, u, dx);
        for (int i = 0; i < 6; i++)
            x[i] += dt * dx[i];
    }
    return x[W1];
}
