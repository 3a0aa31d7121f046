/* What only other inputs rule of slips that stick, as a choice of mode asks for it. */
#include "model_ruling.h"

#include <string.h>

enum { K = BG_FRICTION };

void bg_rule(bg_model *m, const signed char *mode, bg_ruling *ruling)
{
    int signs[BG_ROOM(K)] = {0}, sticking = 0;
    bg_hold *held = NULL;
    for (int i = 0; i < K; i++) {
        signs[i] = mode[i];
        sticking |= mode[i] == 0;
    }
    if (!sticking || bg_hold_of(m, signs, &held) != BG_OK)
        return;
    ruling->count = held->ruled;
    memset(ruling->rows, 0, sizeof ruling->rows);
    for (int r = 0; r < held->ruled; r++)
        for (int c = 0; c < held->count; c++)
            ruling->rows[r][held->ports[c]] = held->share[r * held->count + c];
}
