/* The generated model as many runs use it. Matrices are by rows. */
#ifndef BATCH_MODEL_H
#define BATCH_MODEL_H

#include "model_internal.h"

typedef double batch_row[BG_MAP_COLUMNS];

/* The parts of a map over [s, w, dw, 1]. */
#define BATCH_FIELD(part, count) batch_row part[BG_ROOM(count)];
typedef struct {
    BG_PARTS(BATCH_FIELD)
} batch_map;

/* An instance; where `based`, without friction, and the efforts of slipping forwards; the latest mode,
 * in parts and without the room of those that are empty. */
typedef struct {
    bg_model m;
    int based;
    batch_map base;
    batch_row forward[BG_ROOM(BG_FRICTION)];
    batch_map parts;
    double map[BG_MAP_ROWS * BG_MAP_COLUMNS];
} batch_instance;

/* What there is of a mode: all, no more than the slips of a similar one, nothing that holds its
 * ports, or a refusal. */
enum batch_found { BATCH_MODE_WHOLE, BATCH_MODE_SLIPS, BATCH_MODE_NONE, BATCH_MODE_REFUSED };

/* Binds parameters; a status, of a refusal or a doubt. */
int batch_model_begin(batch_instance *own, const double *parameters);

/* The affine map of a mode, -1, 0 or 1 for each port, and what holds it, if anything does. */
enum batch_found batch_model_mode(batch_instance *own, const int *mode, bg_hold **held);

#endif
