/* The equations: IMECE2008-69248, (13)-(17) and Appendix B, with tires by Pacejka's magic formula.
 *
 * Speeds are told as what they differ from at the start, so that all of a state begins at zero:
 * shafts and wheels of a side begin alike. States and rates are one vector of eight. */
#ifndef MAGIC_MODEL_H
#define MAGIC_MODEL_H

#include <math.h>

#include "lanes_functions.h"
#include "magic_floor.h"

enum { W1, W2, K1, K2, T1, T2, TH, TE, N };

typedef double magic_vector __attribute__((vector_size(64)));

/* What the parameters come to. `apart`: omega_1 less omega_2 at the start. */
typedef struct {
    double inverse_11, inverse_12, inverse_22, stuck_inverse, asymmetry, half_i, k, wheel_inverse;
    double rate, start[2], apart, norm;
    double peak, C, straight, bent, scale[2];
} magic_system;

static inline void magic_reduce(const magic_parameters *p, magic_system *s)
{
    const double a = p->i * p->i * p->I_i / 4;
    const double determinant = p->I_1 * p->I_2 + a * (p->I_1 + p->I_2);
    const double steepest = p->k_t * p->r / (p->omega_0 - (p->dw0 > 0 ? p->dw0 : 0));
    const double lightest = p->I_1 < p->I_2 ? p->I_1 : p->I_2;
    s->inverse_11 = (p->I_2 + a) / determinant;
    s->inverse_12 = -a / determinant;
    s->inverse_22 = (p->I_1 + a) / determinant;
    s->stuck_inverse = 1 / (p->I_1 + p->I_2 + 4 * a);
    s->asymmetry = (p->I_1 - p->I_2) * s->stuck_inverse;
    s->half_i = p->i / 2;
    s->k = p->k;
    s->wheel_inverse = 1 / p->I_w;
    s->rate = 1 / p->lag;
    s->start[0] = p->omega_0;
    s->start[1] = p->omega_0 - p->dw0;
    s->apart = p->dw0;
    s->norm = sqrt(p->k / lightest) + sqrt(p->k / p->I_w) + steepest / p->I_w + s->rate;
    s->peak = p->r * p->D;
    s->C = p->C;
    s->straight = 1 - p->E;
    s->bent = p->E;
    for (int j = 0; j < 2; j++)
        s->scale[j] = p->k_t / (p->C * p->D) / s->start[j];
}

/* sin(x)/x and cos(x) in z = x^2, for |x| <= 3.2: the formula's angle is at most C pi/2. */
static inline double magic_sine(double z)
{
    const double zz = z * z;
    double even = 1.7506707004253515e-20, odd = -8.171272145403755e-18;
    even = even * zz + 2.8107847988826205e-15;
    odd = odd * zz - 7.647106644426964e-13;
    even = even * zz + 1.6059040717989097e-10;
    odd = odd * zz - 2.505210827590458e-08;
    even = even * zz + 2.7557319221586045e-06;
    odd = odd * zz - 0.00019841269841239156;
    even = even * zz + 0.008333333333333132;
    odd = odd * zz - 0.1666666666666666;
    even = even * zz + 1.0;
    return even + z * odd;
}

static inline double magic_cosine(double z)
{
    const double zz = z * z;
    double even = 3.63725465468898e-19, odd = -1.5506368347980974e-16;
    even = even * zz + 4.777941374769689e-14;
    odd = odd * zz - 1.1470615264055109e-11;
    even = even * zz + 2.0876749869500364e-09;
    odd = odd * zz - 2.7557318974030076e-07;
    even = even * zz + 2.4801587296111776e-05;
    odd = odd * zz - 0.0013888888888818882;
    even = even * zz + 0.04166666666666208;
    odd = odd * zz - 0.49999999999999883;
    even = even * zz + 1.0;
    return even + z * odd;
}

/* A tire's torque; x: its slip times the formula's B. */
static inline double magic_torque(const magic_system *s, double x)
{
    const double u = s->straight * x + s->bent * bg_lane_atan(x);
    const double y = s->C * bg_lane_atan(u);
    return s->peak * (y * magic_sine(y * y));
}

/* Its slope in x. */
static inline double magic_slope(const magic_system *s, double x)
{
    const double u = s->straight * x + s->bent * bg_lane_atan(x);
    const double y = s->C * bg_lane_atan(u);
    const double turned = s->straight + s->bent / (1 + x * x);
    return s->peak * s->C * magic_cosine(y * y) * turned / (1 + u * u);
}

/* The torque that holds the clutch; linear in z, so that it serves rates as well. */
static inline double magic_hold(const magic_system *s, const double *z)
{
    return z[K2] - z[K1] - s->asymmetry * (2 * s->half_i * z[TE] - z[K1] - z[K2]);
}

static inline double magic_slip(const magic_system *s, const double *z)
{
    return 0.5 * (z[W1] - z[W2] + s->apart);
}

/* What is positive as long as a mode lasts, and its rate. Mode 0: stuck; -1, 1: the slip's sign. */
static inline void magic_guard(const magic_system *s, int mode, const double *demand,
                               const double *z, double *guard, double *rate)
{
    if (mode) {
        const double drive = s->half_i * z[TE], friction = 0.5 * mode * z[TH];
        const double q1 = drive - friction - z[K1], q2 = drive + friction - z[K2];
        *guard = mode * magic_slip(s, z);
        *rate = 0.5 * mode
                * ((s->inverse_11 - s->inverse_12) * q1 - (s->inverse_22 - s->inverse_12) * q2);
    } else {
        const double hold = magic_hold(s, z), sign = hold < 0 ? -1 : 1;
        double d[N] = {0};
        d[K1] = s->k * (z[W1] - z[T1]);
        d[K2] = s->k * (z[W2] - z[T2]);
        d[TE] = s->rate * (demand[1] - z[TE]);
        *guard = z[TH] - sign * hold;
        *rate = s->rate * (demand[0] - z[TH]) - sign * magic_hold(s, d);
    }
}

/* Whether a guard stays positive, by its values and its rates times the step at both ends. It lies
 * above the least Bernstein coefficient of the cubic through them, but for h^4/384 of its fourth
 * derivative. In a dip of a swing that goes through less than 1.96 rad in the step that is less
 * than a fiftieth of the rates. */
static inline int magic_sure(double g0, double r0, double g1, double r1)
{
    const double inner = fmin(g0 + r0 / 3, g1 - r1 / 3);
    return fmin(fmin(g0, g1), inner) > 0.02 * (fabs(r0) + fabs(r1));
}

/* The linear part, by columns; without tires. */
static inline void magic_matrix(const magic_system *s, int mode, magic_vector *A)
{
    const double drive = s->half_i * (s->inverse_11 + s->inverse_12), friction = 0.5 * mode;
    const double other = s->half_i * (s->inverse_22 + s->inverse_12);
    const magic_vector zero = {0};
    for (int j = 0; j < N; j++)
        A[j] = zero;
    if (mode) {
        A[K1][W1] = -s->inverse_11;
        A[K1][W2] = A[K2][W1] = -s->inverse_12;
        A[K2][W2] = -s->inverse_22;
        A[TH][W1] = friction * (s->inverse_12 - s->inverse_11);
        A[TH][W2] = friction * (s->inverse_22 - s->inverse_12);
        A[TE][W1] = drive;
        A[TE][W2] = other;
    } else {
        A[K1][W1] = A[K1][W2] = A[K2][W1] = A[K2][W2] = -s->stuck_inverse;
        A[TE][W1] = A[TE][W2] = 2 * s->half_i * s->stuck_inverse;
    }
    A[W1][K1] = A[W2][K2] = s->k;
    A[T1][K1] = A[T2][K2] = -s->k;
    A[K1][T1] = A[K2][T2] = s->wheel_inverse;
    A[TH][TH] = A[TE][TE] = -s->rate;
}

#endif
