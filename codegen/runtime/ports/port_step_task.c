/* Sampled tasks in fixed steps: what is due at the start of a step, and where a step is cut; by
 * delays, too. An instant that is a rounding off the start or the end of a step is there. */
#include <math.h>
#include <string.h>

#include "port_step.h"

static double rounding_of(double t, double h)
{
    return BG_TOGETHER * fmax(fabs(t), h);
}

double bg_cut_step(const bg_model *m, double t, double end)
{
    const double h = end - t, from = t + rounding_of(t, h), to = end - rounding_of(end, h);
    double first = INFINITY;
    for (int k = 0; k < BG_CLOCKS && !m->unclocked; k++)
        first = fmin(first, bg_clock_after(bg_clocks + k, from));
    /* What delays give is known no farther than what they have read. */
    if (BG_DELAYS)
        first = fmin(first, fmin(m->memory.is.following, t + bg_memory_shortest(&m->memory)));
    return first < to ? first : end;
}

int bg_due_in_step(const bg_model *m, double t, double h, int *due, double *instant)
{
    const double near = rounding_of(t, h);
    *instant = -INFINITY;
    for (int k = 0; k < BG_CLOCKS && !m->unclocked; k++) {
        const double latest = bg_clock_latest(bg_clocks + k, t + near);
        const int again = latest <= m->ticked && m->ticked <= t + near;
        due[k] = latest >= t - near && !again;
        *instant = due[k] ? fmax(*instant, latest) : *instant;
    }
    return *instant > -INFINITY;
}

int bg_set_by_tasks_in_step(bg_model *m, const bg_start *at, const int *due, double *s)
{
    double values[BG_MOST_RESETS] = {0};
    int fired[BG_MOST_RESETS] = {0};
    const int status = bg_become_in_step(m, at, values);
    for (int r = 0; r < BG_RESETS; r++)
        fired[r] = bg_resets[r].port < 0 && due[-1 - bg_resets[r].port];
    return status ? status : bg_set_states(bg_resets, BG_RESETS, fired, values, s);
}

double bg_task_after(int task, double t)
{
    return bg_clock_after(bg_clocks + task, t);
}

void bg_model_clock(bg_model *m, int on)
{
    m->unclocked = !on;
}

int bg_model_tasks(bg_model *m, double t, double *s, const double *w, const int *due)
{
    const bg_start at = {t, 0.0, s, w, NULL, m->mode, m->started};
    return bg_set_by_tasks_in_step(m, &at, due, s);
}
