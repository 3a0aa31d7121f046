/* Sizes of alsd; written by bondgraph-toolkit. */
#ifndef BG_CONFIG_H
#define BG_CONFIG_H

/* What a real-time step takes, in operations of floating point; tables count as if full. */
/* One evaluation of the rates: 201 multiplications, 199 additions, 2 divisions. */
/* A step in which no port changes, 8 evaluations: 2297 multiplications, 2221 additions, 112
 * divisions, 24 calls. */
/* Each change of ports, at most 7 in a step: 811 multiplications, 807 additions, 61 divisions, with
 * 12 ways to hold and let go at the most. */
#define BG_STEP_OPERATIONS 4654
#define BG_STEP_MOST_OPERATIONS 16407

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
#define BG_EARLY 2
#define BG_LARGEST 1
#define BG_LOOP 0
#define BG_FRICTION 1
#define BG_PORTS 1
#define BG_SWITCHES 0
#define BG_HUNG 0
#define BG_STOPPING 0
#define BG_GUARDS 0
#define BG_RESETS 0
#define BG_CLOCKS 0
#define BG_MOMENTA 0
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
#define BG_TABLES 0
#define BG_TABLE_VALUES 0
#define BG_TABLE_FACTORS 0
#define BG_TABLE_WORK 0
#define BG_REFUSING 0
#define BG_HOLDINGS 6
#define BG_HOLDING_VALUES 6
#define BG_ROSENBROCK 0
#define BG_DELAYS 0
#define BG_DELAYED_FROM 0
#define BG_MEMORY 1

/* The longest step [s] that is stable at the default start, parameters and inputs, in every
 * friction mode; 1e300 if nothing bounds it. */
#define BG_LONGEST_STEP 0.00272547

/* Whether each step is checked for stability, at two evaluations more. */
#ifndef BG_CHECK_STEP
#define BG_CHECK_STEP 1
#endif

#endif
