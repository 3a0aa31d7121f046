/* The instants of tasks, each one division; as codegen/standalone/switchings.py. */
#include <math.h>

#include "config.h"
#include "port_switch.h"

static double instant(const bg_clock *clock, double k)
{
    return (k * clock->every + clock->offset) / clock->unit;
}

/* Its number is known to one but for a rounding. */
enum { TRIED = 4 };

double bg_clock_after(const bg_clock *clock, double t)
{
    double k = fmax(floor((t * clock->unit - clock->offset) / clock->every) - 1.0, 0.0);
    for (int tried = 0; tried < TRIED && instant(clock, k) <= t; tried++)
        k += 1.0;
    return instant(clock, k) > t ? instant(clock, k) : INFINITY;
}

double bg_clock_latest(const bg_clock *clock, double t)
{
    double k = floor((t * clock->unit - clock->offset) / clock->every) + 1.0;
    for (int tried = 0; tried < TRIED && k >= 0.0 && instant(clock, k) > t; tried++)
        k -= 1.0;
    return k >= 0.0 && instant(clock, k) <= t ? instant(clock, k) : -INFINITY;
}

int bg_clock_strikes(const bg_clock *clock, double t)
{
    const double k = floor((t * clock->unit - clock->offset) / clock->every + 0.5);
    return k >= 0.0 && instant(clock, k) == t;
}
