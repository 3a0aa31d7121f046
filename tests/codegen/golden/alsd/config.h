/* Sizes of alsd; written by bondgraph-toolkit. */
#ifndef BG_CONFIG_H
#define BG_CONFIG_H

#define BG_STATES 6
#define BG_LAW_STATES 0
#define BG_INPUTS 4
#define BG_EXTERNAL 2
#define BG_OUTSIDE 1
#define BG_READINGS 8
#define BG_OUTPUTS 5
#define BG_PARAMETERS 11
#define BG_ENTRIES 46
#define BG_GROUPS 2
#define BG_LARGEST 1
#define BG_LOOP 0
#define BG_FRICTION 1
#define BG_PORTS 1
#define BG_SWITCHES 0
#define BG_HUNG 0
#define BG_STOPPING 0
#define BG_GUARDS 0
#define BG_RESETS 0
#define BG_COUPLED 0
#define BG_HOLDS 2
#define BG_CONSTANTS 13
#define BG_VARYING 0
#define BG_AFFINE 1
#define BG_JOINT 0
#define BG_DRIVEN 0
#define BG_RATED 0
#define BG_STRAIGHT 1
#define BG_CORNERS 0
#define BG_CORNERS_TOLD 0

/* The longest step [s] that is stable at the default start, parameters and inputs, in every
 * friction mode; 1e300 if nothing bounds it. */
#define BG_LONGEST_STEP 0.00272547

/* Whether each step is checked for stability, at two evaluations more. */
#ifndef BG_CHECK_STEP
#define BG_CHECK_STEP 1
#endif

#endif
