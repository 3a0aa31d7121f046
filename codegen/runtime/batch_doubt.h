/* Whether a matrix A may well be singular: whoever decides exactly has to look at it then. */
#ifndef BATCH_DOUBT_H
#define BATCH_DOUBT_H

#include <math.h>

#include "model_internal.h"

/* Of an instance whose matrices are assembled: whether a pivot of A, whose diagonal is scaled to 1,
 * is small. */
static inline int batch_doubtful(const bg_model *m)
{
    const double least = 1e-9;
    for (int i = 0; i < BG_STATES; i++)
        if (!(fabs(m->numbers.A[i * BG_STATES + i]) > least))
            return 1;
    return 0;
}

#endif
