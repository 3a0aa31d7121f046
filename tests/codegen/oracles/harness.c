/* What tests call: a model's functions with snapshots as one flat array. */
#include <string.h>

#include "model_runtime.h"

static double *put(double *to, int count, const double *from)
{
    memcpy(to, from, sizeof(double) * (size_t)count);
    return to + count;
}

int harness_evaluate(bg_model *m, double t, const double *s, const double *w, const double *dw,
                     const int *mode, double *flat)
{
    static bg_snapshot shot;
    const int status = bg_model_evaluate(m, t, s, w, dw, mode, &shot);
    flat = put(flat, BG_STATES, shot.x);
    flat = put(flat, BG_LAW_STATES, shot.z);
    flat = put(flat, BG_INPUTS, shot.u);
    flat = put(flat, BG_INPUTS, shot.du);
    flat = put(flat, BG_READINGS, shot.y);
    flat = put(flat, BG_SIZE, shot.rate);
    flat = put(flat, BG_FRICTION, shot.caps);
    bg_model_outputs(&shot, flat);
    return status;
}

void harness_band(bg_model *m, double band)
{
    for (int i = 0; i < BG_FRICTION; i++)
        m->band[i] = band;
}

void harness_mode(const bg_model *m, int *mode)
{
    for (int i = 0; i < BG_FRICTION; i++)
        mode[i] = m->mode[i];
}
