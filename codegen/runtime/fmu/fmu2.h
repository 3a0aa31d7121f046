/* An instance as FMI 2.0 sees it. */
#ifndef FMU2_H
#define FMU2_H

#include "fmi2TypesPlatform.h"
#include "fmi2FunctionTypes.h"
#include "fmu_common.h"

typedef struct {
    fmu_instance core;
    fmi2CallbackFunctions call;
    char *name;
} fmu2;

/* What all versions share of the instance that a call is for. */
#define CORE(c) (&((fmu2 *)(c))->core)

/* The status of a call; why it failed goes to the log. */
fmi2Status fmu2_tell(fmu2 *f, fmu_error failed);

#endif
