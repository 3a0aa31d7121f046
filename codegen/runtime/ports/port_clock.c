/* The instants of tasks, each one division; as codegen/standalone/switchings.py. */
#include <math.h>

#include "port_switch.h"

static double instant(const bg_clock *clock, double k)
{
    return (k * clock->every + clock->offset) / clock->unit;
}

double bg_clock_after(const bg_clock *clock, double t)
{
    double k = fmax(floor((t * clock->unit - clock->offset) / clock->every) - 1.0, 0.0);
    while (instant(clock, k) <= t)
        k += 1.0;
    return instant(clock, k);
}

int bg_clock_strikes(const bg_clock *clock, double t)
{
    const double k = floor((t * clock->unit - clock->offset) / clock->every + 0.5);
    return k >= 0.0 && instant(clock, k) == t;
}
