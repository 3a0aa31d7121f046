/* What only other inputs rule of slips that stick, as a choice of mode asks for it. */
#ifndef BG_MODEL_RULING_H
#define BG_MODEL_RULING_H

#include "bg_choose.h"
#include "model_internal.h"

/* Of a mode that has been evaluated. */
void bg_rule(bg_model *m, const signed char *mode, bg_ruling *ruling);

#endif
