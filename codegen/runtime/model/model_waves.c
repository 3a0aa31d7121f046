/* Signals that repeat: their instants are quotients, as codegen/inputs/waves.py works them out. */
#include <math.h>

#include "model_signals.h"

static double wave_instant(const bg_wave *wave, double period, double offset)
{
    return (period + offset) / wave->frequency;
}

/* The period that holds at t and just after. */
static double wave_period(const bg_wave *wave, double t)
{
    const double k = floor(t * wave->frequency - wave->phase);
    if (wave_instant(wave, k + 1.0, wave->phase) <= t)
        return k + 1.0;
    return wave_instant(wave, k, wave->phase) > t ? k - 1.0 : k;
}

/* Where a part after the first begins, in periods; infinite where it does not. */
static double wave_offset(const bg_signals *signals, const bg_wave *wave, int part, double start)
{
    if (wave->duty < 0)
        return wave->phase + signals->parts[wave->first + part].fraction;
    const double share = bg_signals_one(signals->duties, wave->duty, start);
    return share < 1.0 ? wave->phase + fmax(share, 0.0) : INFINITY;
}

int bg_wave_part(const bg_signals *signals, const bg_wave *wave, double t, double *begin)
{
    const double k = wave_period(wave, t), start = wave_instant(wave, k, wave->phase);
    int found = 0;
    *begin = start;
    for (int j = 1; j < wave->parts; j++) {
        const double at = wave_instant(wave, k, wave_offset(signals, wave, j, start));
        if (at <= t) {
            found = j;
            *begin = at;
        }
    }
    return found;
}

double bg_wave_following(const bg_signals *signals, const bg_wave *wave, double t)
{
    const double k = wave_period(wave, t), start = wave_instant(wave, k, wave->phase);
    double after = wave_instant(wave, k + 1.0, wave->phase);
    for (int j = 1; j < wave->parts; j++) {
        const double at = wave_instant(wave, k, wave_offset(signals, wave, j, start));
        if (at > t && at < after)
            after = at;
    }
    return after > t ? after : INFINITY;
}
