/* How a call or a run ended. */
#ifndef BG_RUN_STATUS_H
#define BG_RUN_STATUS_H

enum bg_status {
    BG_OK,
    BG_PARAMETER,    /* a parameter is not a finite number */
    BG_COEFFICIENT,  /* a coefficient is not finite */
    BG_SINGULAR,     /* A has no inverse */
    BG_NOT_FINITE,   /* a law or a rate has no finite value */
    BG_NO_SOLUTION,  /* laws that depend on one another: no solution found */
    BG_BAD_FRICTION, /* a level or curve below zero, or a breakaway below the friction at rest */
    BG_NO_HOLD,      /* sticking ports have no unique holding efforts */
    BG_NO_SHARE,     /* how redundant ports share a load was not found */
    BG_STRUCTURE,    /* parameters change which ports are redundant */
    BG_NEEDS_SLOPE,  /* holding would need the slope in time of an input that a law gives */
    BG_NOT_AFFINE,   /* the model, or this mode of it, is no affine map */
    BG_BAD_MODE,     /* a mode is none of -1, 0, 1 */
    BG_UNDECIDED,    /* no way of sticking and slipping is consistent */
    BG_STALLS,       /* events follow one another and time makes no progress */
    BG_STEPS,        /* the integrator no longer advances: the rates jump there */
    BG_EVENTS,       /* more events than there is room for */
    BG_UNSTABLE,     /* a step is beyond the stability of its method */
    BG_BAD_STEP,     /* a step is no positive number */
    BG_BEYOND,       /* a stop begins beyond its bound */
    BG_STRUCK,       /* stops are struck in one instant, and what meets them still closes */
    BG_SET_TWICE,    /* two ports reset one state to two values at once */
    BG_SET_HELD,     /* a reset contradicts what is held */
    BG_SET_ENDLESSLY, /* resets set off one another without end */
    BG_TABLE_VALUE,  /* a value of a table, or what comes of it, is not finite */
    BG_PIVOTS,       /* a step's ports were not decided in so many pivots; the best was taken */
    BG_INACCURATE,   /* a step's error is beyond 1 % of a state's range; it was taken */
    BG_UNEXCHANGED,  /* no impulse is found that keeps what nonlinear storages hold */
    BG_INSTANTS,     /* a step crosses more instants of tasks than it may */
    BG_NOT_LATE,     /* a delay is no positive number, or gives none at first */
    BG_FORGETS,      /* a delay reaches farther back than what is known of a run */
    /* of exact steps alone */
    BG_MISSING,      /* a mode is not in the table */
    BG_NEGATIVE,     /* a friction level falls below zero */
    BG_STIFF,        /* most steps would follow what has decayed */
    BG_WORK,         /* a search for an event had no end */
    BG_BLUNT,        /* the rates of a mode are wanted: with 32 digits, or at all */
    BG_ENDLESS,      /* so many steps have no end */
    BG_CROWDED,      /* a run comes to more modes than it may */
    BG_REFUSED,      /* of many runs: the model refuses these numbers */
    /* of runs that are taken on the way */
    BG_UNTAKEN       /* who takes what has been recorded cannot */
};

/* Whether a step was taken: some statuses only tell of it. */
static inline int bg_is_taken(int status)
{
    return status == BG_OK || status == BG_PIVOTS || status == BG_INACCURATE;
}

#endif
