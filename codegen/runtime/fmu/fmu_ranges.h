/* Ranges of what known sources are made of over a stretch of time: a middle, and how far off. */
#ifndef FMU_RANGES_H
#define FMU_RANGES_H

#include <math.h>

#include "tuning.h"

typedef struct {
    double mid, off;
} fmu_range;

static inline fmu_range fmu_level(double value)
{
    return (fmu_range){value, 0.0};
}

static inline fmu_range fmu_sum(fmu_range a, fmu_range b)
{
    return (fmu_range){a.mid + b.mid, a.off + b.off};
}

static inline fmu_range fmu_product(fmu_range a, fmu_range b)
{
    return (fmu_range){a.mid * b.mid, fabs(a.mid) * b.off + fabs(b.mid) * a.off + a.off * b.off};
}

/* A whole power above zero. */
static inline fmu_range fmu_whole_power(fmu_range a, double power)
{
    const double size = fabs(a.mid);
    return (fmu_range){pow(a.mid, power), pow(size + a.off, power) - pow(size, power)};
}

/* Any other power, of what is above zero or below it all along. */
static inline fmu_range fmu_power(fmu_range a, double power)
{
    const double size = fabs(a.mid), value = pow(a.mid, power);
    const double least = size - a.off, most = size + a.off;
    if (!(least > 0.0))
        return (fmu_range){value, INFINITY};
    return (fmu_range){value, fmax(fabs(pow(least, power) - pow(size, power)),
                                   fabs(pow(most, power) - pow(size, power)))};
}

static inline fmu_range fmu_exponential(fmu_range a)
{
    return (fmu_range){exp(a.mid), exp(a.mid + a.off) * -expm1(-a.off)};
}

/* A function of this value in the middle, whose slope is not above `slope`. */
static inline fmu_range fmu_sloped(double value, double slope, fmu_range a)
{
    return (fmu_range){value, slope * a.off};
}

/* A sine, an exponential or the like turns by a tenth at most, a sixtieth of a period; or it is next
 * to nothing all along. */
static inline int fmu_turns_little(fmu_range a)
{
    return a.off <= BG_TURNS;
}

static inline int fmu_grows_little(fmu_range a)
{
    return a.off <= BG_TURNS || a.mid + a.off < -92.0;
}

/* Beyond so much a function that saturates is level. */
static inline int fmu_saturates(fmu_range a, double beyond)
{
    return a.off <= BG_TURNS || fabs(a.mid) - a.off > beyond;
}

/* It stays away from zero, where its powers and its logarithm are singular. */
static inline int fmu_keeps_away(fmu_range a)
{
    return a.off <= BG_TURNS * fabs(a.mid);
}

#endif
