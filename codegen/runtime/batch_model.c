/* The generated model as the batch of runs uses it. */
#include "batch_model.h"

#include <math.h>
#include <stddef.h>

#include "model_internal.h"

/* Pivots of A, whose diagonal is scaled to 1, below which it may well be singular. */
static const double DOUBTFUL = 1e-9;

unsigned long batch_model_size(void)
{
    return (unsigned long)sizeof(bg_model);
}

int batch_model_begin(void *model, const double *parameters, batch_numbers *found)
{
    bg_model *const m = model;
    const bg_numbers *const a = &m->numbers;
    const int status = bg_model_init(m, parameters);
    if (status != BG_OK)
        return status;
    for (int i = 0; i < BG_STATES; i++)
        if (!(fabs(a->A[i * BG_STATES + i]) > DOUBTFUL))
            return BG_SINGULAR;
    *found = (batch_numbers){a->P, a->Q, a->R, a->F, a->D, bg_friction_inputs,
                             bg_friction_readings, bg_beside};
    return BG_OK;
}

int batch_model_mode(void *model, const int *mode, double *map, batch_hold *held)
{
    bg_model *const m = model;
    bg_hold *hold = NULL;
    int sticking = 0, status = bg_model_affine_map(m, mode, map);
    for (int i = 0; i < BG_FRICTION; i++)
        sticking |= mode[i] == 0;
    *held = (batch_hold){0, NULL, NULL, NULL};
    if (status != BG_OK || !sticking)
        return status;
    status = bg_hold_of(m, mode, &hold);
    if (status == BG_OK)
        *held = (batch_hold){hold->kept, hold->slip_x, hold->slip_u, hold->take_away};
    return status;
}

int batch_model_start(void *model, double t, const double *states, const double *w, double *s)
{
    return bg_model_vector(model, t, states, w, s);
}
