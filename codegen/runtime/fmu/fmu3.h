/* An instance as FMI 3.0 sees it. */
#ifndef FMU3_H
#define FMU3_H

#include "fmi3PlatformTypes.h"
#include "fmi3FunctionTypes.h"
#include "fmu_common.h"

typedef struct {
    fmu_instance core;
    fmi3InstanceEnvironment environment;
    fmi3LogMessageCallback log;
} fmu3;

/* What all versions share of the instance that a call is for. */
#define CORE(c) (&((fmu3 *)(c))->core)

/* The status of a call; why it failed goes to the log. */
fmi3Status fmu3_tell(fmu3 *f, fmu_error failed);

#endif
