/* Fixed steps of an exported model, and how many basic blocks each of them runs through: what a step
 * costs, the same on every machine. The model's files are compiled with -fsanitize-coverage=trace-pc,
 * so that each block calls `__sanitizer_cov_trace_pc`. */
#include <math.h>
#include <string.h>

#include "model_runtime.h"
#include "port_box.h"

enum { GIVEN = BG_ROOM(BG_EXTERNAL) };

static unsigned long long blocks;

#ifdef __GNUC__
#define UNCOUNTED __attribute__((no_sanitize_coverage))
#endif

UNCOUNTED void __sanitizer_cov_trace_pc(void);

UNCOUNTED void __sanitizer_cov_trace_pc(void)
{
    blocks++;
}

/* `w`: the external inputs at 0, h/2, h and so on; a row of states at the end of each step, the mode
 * then, its blocks and its status. How many steps were taken. */
int realtime_march(bg_model *m, double h, int count, double *s, const double *w, double *rows,
                   int *modes, double *costs, int *told)
{
    for (int k = 0; k < count; k++) {
        const unsigned long long before = blocks;
        told[k] = bg_model_step(m, k * h, h, s, w + 2 * k * BG_EXTERNAL);
        costs[k] = (double)(blocks - before);
        if (!bg_is_taken(told[k]))
            return k;
        memcpy(rows + k * BG_SIZE, s, sizeof(double) * BG_SIZE);
        memcpy(modes + k * BG_ROOM(BG_FRICTION), m->mode, sizeof m->mode);
    }
    return count;
}

/* The same without a record, one input swinging by so much at 7 rad/s: how often modes change after
 * the first step, and how far the states ever are from those after it. */
int realtime_rest(bg_model *m, double h, int count, double *s, const double *w, int input,
                  double swing, double *far)
{
    double now[3 * BG_ROOM(BG_EXTERNAL)], first[BG_SIZE] = {0};
    int mode[BG_ROOM(BG_FRICTION)] = {0}, changes = 0;
    *far = 0.0;
    for (int k = 0; k < count; k++) {
        for (int i = 0; i < 3 * BG_EXTERNAL; i++)
            now[i] = w[i % GIVEN]
                + (i % GIVEN == input ? swing * sin(7.0 * h * (k + 0.5 * (i / GIVEN))) : 0.0);
        if (bg_model_step(m, k * h, h, s, now) != BG_OK)
            return -1 - k;
        for (int i = 0; i < BG_FRICTION && k > 0; i++)
            changes += mode[i] != m->mode[i];
        memcpy(mode, m->mode, sizeof m->mode);
        if (k == 0)
            memcpy(first, s, sizeof first);
        for (int i = 0; i < BG_SIZE; i++)
            *far = fmax(*far, fabs(s[i] - first[i]));
    }
    return changes;
}
