/* Functions of laws without a branch, so that compilers may work out several lanes at once. Each is
 * within two units in the last place of the exact value, or no number where it cannot be: a run
 * whose lane comes upon that is done by itself. Polynomials are interpolants at Chebyshev's points
 * of the interval that is left after reduction; tests/codegen/c/test_lane_functions.py works them
 * out anew. */
#ifndef BG_LANES_FUNCTIONS_H
#define BG_LANES_FUNCTIONS_H

#include <math.h>
#include <stdint.h>
#include <string.h>

/* Added and taken away again this rounds to a whole number, which its last bits hold. */
#define BG_LANE_WHOLE 6755399441055744.0

/* Parts of pi/2 and of ln 2 of which multiples by whole numbers below BG_LANE_MOST are exact, and
 * what is left. */
#define BG_LANE_MOST 1e5
#define BG_LANE_HALF_PI 1.5707963267341256
#define BG_LANE_HALF_PI_NEXT 6.077100506303966e-11
#define BG_LANE_HALF_PI_LEFT 2.0222662487959506e-21
#define BG_LANE_LN_2 0.6931471803691238
#define BG_LANE_LN_2_LEFT 1.9082149292705877e-10

static inline double bg_lane_atan(double x)
{
    /* at tan(pi/8) and tan(3 pi/8) */
    const double a = fabs(x);
    const int far = a > 2.4142135623730950, beside = a > 0.41421356237309505;
    const double top = far ? -1.0 : beside ? a - 1.0 : a, below = far ? a : a + 1.0;
    const double s = beside ? top / below : a, z = s * s;
    const double base = far ? 1.5707963267948966 : beside ? 0.78539816339744831 : 0.0;
    const double left = far ? 6.123233995736766e-17 : beside ? 3.061616997868383e-17 : 0.0;
    const double zz = z * z;
    double even = -0.034570561981427744, odd = 0.016285756855221028;
    even = even * zz - 0.05230454270650244;
    odd = odd * zz + 0.04551593220626549;
    even = even * zz - 0.06666424885738255;
    odd = odd * zz + 0.05878928997834775;
    even = even * zz - 0.09090908753500877;
    odd = odd * zz + 0.07692296375032143;
    even = even * zz - 0.14285714285659828;
    odd = odd * zz + 0.11111111105155447;
    even = even * zz - 0.3333333333333333;
    odd = odd * zz + 0.19999999999999804;
    const double p = even + z * odd;
    return copysign(base + (s + (s * z * p + left)), x);
}

/* What is left of an angle less whole quarters of a turn; which quarter, 0 to 3, in `quarter`. */
static inline double bg_lane_reduced(double x, double *quarter)
{
    const double k = (x * 0.63661977236758134 + BG_LANE_WHOLE) - BG_LANE_WHOLE;
    const double fourth = (k * 0.25 - 0.375 + BG_LANE_WHOLE) - BG_LANE_WHOLE;
    *quarter = k - 4.0 * fourth;
    return ((x - k * BG_LANE_HALF_PI) - k * BG_LANE_HALF_PI_NEXT) - k * BG_LANE_HALF_PI_LEFT;
}

static inline double bg_lane_wave(double x, double shift)
{
    double quarter;
    const double r = bg_lane_reduced(x, &quarter), z = r * r;
    const double zz = z * z;
    double s = -7.586697117706918e-13, t = 1.6058531618986147e-10;
    double c = 2.08761462684032e-09, d = -1.1382632425521717e-11;
    s = s * zz - 2.5052106232447578e-08;
    t = t * zz + 2.7557319219339167e-06;
    c = c * zz + 2.480158729876569e-05;
    d = d * zz - 2.7557317271729793e-07;
    s = s * zz - 0.00019841269841265065;
    t = t * zz + 0.008333333333333331;
    c = c * zz + 0.041666666666666664;
    d = d * zz - 0.0013888888888887398;
    s = s * zz - 0.16666666666666666;
    s = s + z * t;
    c = c + z * d;
    const double sine = r + r * z * s, cosine = 1.0 + z * (-0.5 + z * c);
    const double turned = quarter + shift, q = turned > 3.5 ? turned - 4.0 : turned;
    const double other = (q > 0.5 && q < 1.5) || q > 2.5 ? cosine : sine;
    const double found = q > 1.5 ? -other : other;
    return fabs(x) < BG_LANE_MOST ? found : NAN;
}

static inline double bg_lane_sin(double x)
{
    return bg_lane_wave(x, 0.0);
}

static inline double bg_lane_cos(double x)
{
    return bg_lane_wave(x, 1.0);
}

/* Zero where it is below the smallest normal number. */
static inline double bg_lane_exp(double x)
{
    const double whole = x * 1.4426950408889634 + BG_LANE_WHOLE, k = whole - BG_LANE_WHOLE;
    const double r = (x - k * BG_LANE_LN_2) - k * BG_LANE_LN_2_LEFT;
    const double rr = r * r;
    double even = 2.0914679376583935e-09, odd = 2.510520637395701e-08;
    even = even * rr + 2.7557273661348637e-07;
    odd = odd * rr + 2.7557255425746435e-06;
    even = even * rr + 2.4801587325533363e-05;
    odd = odd * rr + 0.00019841269874800493;
    even = even * rr + 0.0013888888888883752;
    odd = odd * rr + 0.008333333333326141;
    even = even * rr + 0.04166666666666667;
    odd = odd * rr + 0.1666666666666667;
    even = even * rr + 0.5;
    double p = 1.0 + (r + rr * (even + r * odd));
    uint64_t power, bits;
    memcpy(&power, &whole, sizeof power);
    memcpy(&bits, &p, sizeof bits);
    bits += power << 52;
    memcpy(&p, &bits, sizeof p);
    const double held = x < -708.0 ? 0.0 : p;
    return x > 709.0 ? HUGE_VAL : x != x ? x : held;
}

/* No number below zero, at zero and where it is not finite. */
static inline double bg_lane_log(double x)
{
    const double half = 0.70710678118654757, shifted = BG_LANE_WHOLE;
    uint64_t bits, low, whole;
    double k, m;
    memcpy(&bits, &x, sizeof bits);
    memcpy(&low, &half, sizeof low);
    memcpy(&whole, &shifted, sizeof whole);
    const uint64_t power = (bits - low + 0x4000000000000000u) >> 52; /* 1024 more */
    bits -= (power - 1024u) << 52;
    whole += power;
    memcpy(&m, &bits, sizeof m);
    memcpy(&k, &whole, sizeof k);
    k = k - BG_LANE_WHOLE - 1024.0;
    const double s = (m - 1.0) / (m + 1.0), z = s * s;
    const double zz = z * z;
    double even = 0.13268773138656886, odd = 0.13086626147840102;
    even = even * zz + 0.18181795640132906;
    odd = odd * zz + 0.15386239702814658;
    even = even * zz + 0.28571428570803614;
    odd = odd * zz + 0.22222222391713917;
    even = even * zz + 0.6666666666666666;
    odd = odd * zz + 0.4000000000000088;
    const double p = even + z * odd;
    const double found = k * BG_LANE_LN_2 + (k * BG_LANE_LN_2_LEFT + (2.0 * s + s * z * p));
    return x >= 2.2250738585072014e-308 && x <= 1.7976931348623157e308 ? found : NAN;
}

static inline double bg_lane_tanh(double x)
{
    const double a = fabs(x), z = a * a;
    const double zz = z * z;
    double even = -0.00022107222975864633, odd = 5.946956589774769e-05;
    even = even * zz - 0.001454959384380466;
    odd = odd * zz + 0.0005849653729922644;
    even = even * zz - 0.008863229270067843;
    odd = odd * zz + 0.0035920334653723926;
    even = even * zz - 0.05396825396361009;
    odd = odd * zz + 0.021869488297234514;
    even = even * zz - 0.3333333333333333;
    odd = odd * zz + 0.13333333333329825;
    const double p = even + z * odd;
    const double near = a + a * z * p;
    const double far = 1.0 - 2.0 / (bg_lane_exp(2.0 * a) + 1.0);
    return copysign(a < 0.5 ? near : far, x);
}

#endif
