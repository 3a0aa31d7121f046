/* The same by exported C: a run with events located, of the model that was written beside this file. */
#include "model_located.h"

static void keep(void *to, int sample, const double *w, const int *mode, const bg_snapshot *shot)
{
    (void)w, (void)mode;
    ((double *)to)[sample] = shot->x[0];
}

int cycle_run(const double *times, int count, double tolerance, double *speeds, int *corners)
{
    static bg_model model;
    static bg_located run;
    static bg_event events[8192];
    const double start[BG_SIZE] = {0.0};
    static const double nothing[1][2] = {{0.0, 0.0}};
    static const int begins[] = {0, 0};
    static const bg_term terms[1];
    const bg_signals none = {.segments = 1, .breaks = *nothing, .begins = begins, .terms = terms,
                             .coefficients = nothing, .fastest = *nothing};
    const bg_request blank = {0};
    bg_request asked = blank;
    asked.times = times;
    asked.states = start;
    asked.samples = count;
    asked.method = BG_DOP853;
    asked.rtol = tolerance;
    asked.atol = 0.1 * tolerance;
    asked.to = speeds;
    asked.record = keep;
    asked.corners = 1;
    asked.events = events;
    asked.capacity = 8192;
    int status = bg_model_init(&model, NULL);
    if (status == BG_OK)
        status = bg_model_run(&run, &model, &none, &asked);
    *corners = asked.count;
    return status;
}
