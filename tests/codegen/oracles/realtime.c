/* Fixed steps of an exported model, and how many basic blocks each of them runs through: what a step
 * costs, the same on every machine. The model's files are compiled with -fsanitize-coverage=trace-pc,
 * so that each block calls `__sanitizer_cov_trace_pc`. */
#include <string.h>

#include "model_runtime.h"

static unsigned long long blocks;

__attribute__((no_sanitize_coverage)) void __sanitizer_cov_trace_pc(void);

__attribute__((no_sanitize_coverage)) void __sanitizer_cov_trace_pc(void)
{
    blocks++;
}

/* `w`: the external inputs at 0, h/2, h and so on; a row of states at the end of each step, the mode
 * then, and its blocks. `told`: the worst status of steps that were taken. */
int realtime_march(bg_model *m, double h, int count, double *s, const double *w, double *rows,
                   int *modes, double *costs, int *told)
{
    int status = BG_OK;
    for (int k = 0; k < count; k++) {
        const unsigned long long before = blocks;
        status = bg_model_step(m, k * h, h, s, w + 2 * k * BG_EXTERNAL);
        costs[k] = (double)(blocks - before);
        if (status != BG_OK) {
            *told = k;
            return status;
        }
        memcpy(rows + k * BG_SIZE, s, sizeof(double) * BG_SIZE);
        memcpy(modes + k * BG_ROOM(BG_FRICTION), m->mode, sizeof m->mode);
    }
    return status;
}
