/* The terms of external inputs, one after the other. */
#ifndef BG_MODEL_TERMS_H
#define BG_MODEL_TERMS_H

#include "model_signals.h"

/* Those that hold in a span, NULL after the last. Those of waves are told from where their part
 * begins, in `own`. */
typedef struct {
    const bg_signals *signals;
    const bg_span *span;
    int wave, next, last;
    double begin;
    bg_term own;
} bg_term_walk;

bg_term_walk bg_walk_terms(const bg_signals *signals, const bg_span *span);
const bg_term *bg_next_term(bg_term_walk *walk);

#endif
