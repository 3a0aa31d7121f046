/* A communication step. */
#include <math.h>
#include <string.h>

#include "fmu_common.h"

fmu_error fmu_advance(fmu_instance *f, double t, double h)
{
    const double end = t + h;
    fmu_error failed = fmu_apply(f);
    if (!isfinite(end))
        return "a step must begin and end at finite times";
    if (failed || !(h > 0))
        return failed ? failed : h == 0 ? NULL : "a step must not go backwards";
    fmu_set_time(f, t);
    const fmu_memory before = f->at;
    f->model.memory.is.back = t;
    failed = f->at.step > 0 ? fmu_fixed(f, t, end) : fmu_locate(f, t, end);
    if (failed) {
        /* Nothing has happened: the states are those of the instance's time. */
        fmu_restore(f, &before);
        if (BG_DELAYS)
            bg_memory_back(&f->model.memory, t);
        return failed;
    }
    memcpy(f->at.seen, f->model.seen, sizeof f->at.seen);
    for (int i = 0; i < W; i++) {
        f->at.given[i] += h * f->at.slopes[i];
        if (!BG_RATED)
            f->at.slopes[i] = 0.0;
    }
    f->at.time = end;
    fmu_pass(f, end);
    f->stale = 1;
    return NULL;
}
