/* Which table was left, in words. */
#ifndef BG_MODEL_LEFT_H
#define BG_MODEL_LEFT_H

#include <stdio.h>

#include "model_runtime.h"

/* After a call that failed: whether a table was left, which is told in `text`. */
static inline int bg_left_text(const bg_model *m, int status, char *text, size_t room)
{
    bg_leaving told;
    if (!bg_model_left(m, status, &told))
        return 0;
    if (told.never) {
        snprintf(text, room, "at t = %.9g %.60s %.150s", told.time, told.argument, told.never);
        return 1;
    }
    snprintf(text, room, "at t = %.9g %.60s leaves table '%.40s', which is from %.9g to %.9g and "
             "refuses what is outside", told.time, told.argument, told.table, told.low, told.high);
    return 1;
}

#endif
