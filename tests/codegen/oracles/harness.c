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

double harness_longest(const bg_model *m)
{
    return m->fastest.step;
}

void harness_mode(const bg_model *m, int *mode)
{
    for (int i = 0; i < BG_FRICTION; i++)
        mode[i] = m->mode[i];
}

/* States, inputs and readings at an instant, one after the other; rates of inputs as steps take them. */
static int sample(bg_model *m, double t, double h, const double *s, const double *w, double *row)
{
    static bg_snapshot shot;
    double dw[BG_ROOM(BG_EXTERNAL)];
    int status;
    for (int i = 0; i < BG_EXTERNAL; i++)
        dw[i] = (4 * w[BG_EXTERNAL + i] - 3 * w[i] - w[2 * BG_EXTERNAL + i]) / h;
    status = bg_model_evaluate(m, t, s, w, dw, m->mode, &shot);
    row = put(row, BG_STATES, shot.x);
    row = put(row, BG_LAW_STATES, shot.z);
    row = put(row, BG_INPUTS, shot.u);
    put(row, BG_READINGS, shot.y);
    return status;
}

/* So many steps of h from time 0; the mode at the start of each, and a row at every so many. `w`: the
 * external inputs at 0, h/2, h, and so on. */
int harness_march(bg_model *m, double h, int count, int every, double *s, const double *w,
                  double *rows, int *modes)
{
    const int width = BG_STATES + BG_LAW_STATES + BG_INPUTS + BG_READINGS;
    int status = BG_OK;
    for (int k = 0; k <= count && status == BG_OK; k++) {
        status = bg_model_settle(m, k * h, h, s, w);
        harness_mode(m, modes);
        if (status == BG_OK && k % every == 0) {
            status = sample(m, k * h, h, s, w, rows);
            rows += width;
        }
        if (status == BG_OK && k < count)
            status = bg_model_advance(m, k * h, h, s, w);
        modes += BG_FRICTION;
        w += 2 * BG_EXTERNAL;
    }
    return status;
}

/* The same where the caller runs all tasks, at every `every`th step from the first on. */
int harness_timed(bg_model *m, double h, int count, int every, double *s, const double *w,
                  double *rows)
{
    const int width = BG_STATES + BG_LAW_STATES + BG_INPUTS + BG_READINGS;
    int status = BG_OK, due[BG_ROOM(BG_CLOCKS)];
    for (int i = 0; i < BG_CLOCKS; i++)
        due[i] = 1;
    bg_model_clock(m, 0);
    for (int k = 0; k <= count && status == BG_OK; k++) {
        status = k % every == 0 ? bg_model_tasks(m, k * h, s, w, due) : BG_OK;
        if (status == BG_OK)
            status = sample(m, k * h, h, s, w, rows);
        if (status == BG_OK && k < count)
            status = bg_model_step(m, k * h, h, s, w);
        rows += width;
        w += 2 * BG_EXTERNAL;
    }
    return status;
}
