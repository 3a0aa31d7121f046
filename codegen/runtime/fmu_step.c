/* Co-simulation in steps of fixed length that end at breakpoints and communication points. */
#include <math.h>
#include <string.h>

#include "fmu_common.h"

enum { W = BG_EXTERNAL };

/* Equal steps from t to stop, none longer than the internal step. */
static int walk(fmu_instance *f, double t, double stop)
{
    const double count = fmax(1.0, ceil((stop - t) / f->at.step * (1 - 1e-9)));
    const double h = (stop - t) / count;
    int status = BG_OK;
    for (double k = 0; k < count && status == BG_OK; k++) {
        double rates[BG_ROOM(W)];
        for (int i = 0; i < 3; i++)
            fmu_externals(f, t + (k + 0.5 * i) * h, f->steps + i * W, rates);
        status = bg_model_step(&f->model, t + k * h, h, f->at.s, f->steps);
    }
    return status;
}

/* Sticking as it is at the end of a step, so that outputs show it. */
static int settle(fmu_instance *f, double t, double h)
{
    for (int i = 0; i < 3; i++)
        fmu_externals(f, t + 0.5 * i * h, f->steps + i * W, f->dw);
    return bg_model_settle(&f->model, t, h, f->at.s, f->steps);
}

fmu_error fmu_advance(fmu_instance *f, double t, double h)
{
    double now = t, stop;
    int status = BG_OK;
    fmu_error failed = fmu_apply(f);
    if (failed || !(h > 0))
        return failed ? failed : h == 0 ? NULL : "a step must not go backwards";
    fmu_set_time(f, t);
    while (status == BG_OK && now < t + h) {
        fmu_pass(f, now);
        stop = t + h;
        if (fmu_next_break(f, &stop) && !(stop < t + h))
            stop = t + h;
        status = walk(f, now, stop);
        now = stop;
    }
    if (status != BG_OK)
        return bg_model_message(status);
    for (int i = 0; i < W; i++) {
        f->at.given[i] += h * f->at.slopes[i];
        if (!BG_RATED)
            f->at.slopes[i] = 0.0;
    }
    f->at.time = now;
    fmu_pass(f, now);
    status = settle(f, now, f->at.step);
    memcpy(f->at.mode, f->model.mode, sizeof f->at.mode);
    f->at.stepped = f->model.started;
    f->stale = 1;
    return status == BG_OK ? NULL : bg_model_message(status);
}
