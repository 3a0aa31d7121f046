/* What a step looks at: everything in a mode, or in one in which there are values. */
#include <string.h>

#include "model_internal.h"
#include "port_choose.h"

int bg_look(bg_model *m, const bg_start *at, const int *mode)
{
    return bg_evaluate(m, at->t, at->s, at->w, at->dw, mode, 1, &m->shot);
}

/* By a mode in which there are values: laws may have no solution one way. */
int bg_look_any(bg_model *m, const bg_start *at, const int *mode, int *tried)
{
    int status = BG_NO_SOLUTION, first = BG_OK;
    for (int k = 0; k < BG_TRIES && status != BG_OK && bg_try(K, k, mode, tried); k++) {
        status = bg_look(m, at, tried);
        first = k ? first : status;
    }
    return status == BG_OK ? BG_OK : first;
}

int bg_look_slipping(bg_model *m, const bg_start *at, const int *mode)
{
    int tried[BG_MOST_PORTS] = {0};
    return bg_look_any(m, at, mode, tried);
}
