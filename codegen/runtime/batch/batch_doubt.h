/* Whether a matrix A may well be singular: whoever decides exactly has to look at it then. */
#ifndef BATCH_DOUBT_H
#define BATCH_DOUBT_H

#include <math.h>

#include "model_internal.h"
#include "tuning.h"

/* Of an instance whose matrices are assembled: whether a pivot of A, whose diagonal is scaled to 1,
 * is small. */
static inline int batch_doubtful(const bg_model *m)
{
    for (int i = 0; i < BG_STATES; i++)
        if (!(fabs(m->numbers.A[i * BG_STATES + i]) > BG_DOUBTFUL))
            return 1;
    return 0;
}

#endif
