/* FMI 3.0: what these units do not have. Asking for none of it is no error. */
#include "fmi3Functions.h"
#include "fmu3.h"

#define REFUSED(name, rest, count)                                            \
    fmi3Status name rest                                                      \
    {                                                                         \
        return (count) == 0 ? fmi3OK : fmu3_tell(c, #name ": not supported"); \
    }

#define VR fmi3Instance c, const fmi3ValueReference vr[], size_t nvr
#define VALUES(type)                                                                            \
    REFUSED(fmi3Get##type, (VR, fmi3##type v[], size_t n), ((void)vr, (void)v, (void)n, nvr))   \
    REFUSED(fmi3Set##type, (VR, const fmi3##type v[], size_t n), ((void)vr, (void)v, (void)n, nvr))

VALUES(Float32)
VALUES(Int8)
VALUES(UInt8)
VALUES(Int16)
VALUES(UInt16)
VALUES(UInt32)
VALUES(Int64)
VALUES(UInt64)
VALUES(Boolean)
VALUES(String)
REFUSED(fmi3SetInt32, (VR, const fmi3Int32 v[], size_t n), ((void)vr, (void)v, (void)n, nvr))
REFUSED(fmi3GetBinary, (VR, size_t s[], fmi3Binary v[], size_t n),
        ((void)vr, (void)s, (void)v, (void)n, nvr))
REFUSED(fmi3SetBinary, (VR, const size_t s[], const fmi3Binary v[], size_t n),
        ((void)vr, (void)s, (void)v, (void)n, nvr))
REFUSED(fmi3GetClock, (VR, fmi3Clock v[]), ((void)vr, (void)v, nvr))
REFUSED(fmi3SetClock, (VR, const fmi3Clock v[]), ((void)vr, (void)v, nvr))
REFUSED(fmi3GetIntervalDecimal, (VR, fmi3Float64 v[], fmi3IntervalQualifier q[]),
        ((void)vr, (void)v, (void)q, nvr))
REFUSED(fmi3GetIntervalFraction, (VR, fmi3UInt64 a[], fmi3UInt64 b[], fmi3IntervalQualifier q[]),
        ((void)vr, (void)a, (void)b, (void)q, nvr))
REFUSED(fmi3GetShiftDecimal, (VR, fmi3Float64 v[]), ((void)vr, (void)v, nvr))
REFUSED(fmi3GetShiftFraction, (VR, fmi3UInt64 a[], fmi3UInt64 b[]),
        ((void)vr, (void)a, (void)b, nvr))
REFUSED(fmi3SetIntervalDecimal, (VR, const fmi3Float64 v[]), ((void)vr, (void)v, nvr))
REFUSED(fmi3SetIntervalFraction, (VR, const fmi3UInt64 a[], const fmi3UInt64 b[]),
        ((void)vr, (void)a, (void)b, nvr))
REFUSED(fmi3SetShiftDecimal, (VR, const fmi3Float64 v[]), ((void)vr, (void)v, nvr))
REFUSED(fmi3SetShiftFraction, (VR, const fmi3UInt64 a[], const fmi3UInt64 b[]),
        ((void)vr, (void)a, (void)b, nvr))
REFUSED(fmi3GetOutputDerivatives, (VR, const fmi3Int32 o[], fmi3Float64 v[], size_t n),
        ((void)vr, (void)o, (void)v, (void)n, nvr))
REFUSED(fmi3GetNumberOfVariableDependencies,
        (fmi3Instance c, fmi3ValueReference vr, size_t *n), ((void)vr, (void)n, 1))
REFUSED(fmi3GetVariableDependencies,
        (fmi3Instance c, fmi3ValueReference vr, size_t e[], fmi3ValueReference i[], size_t j[],
         fmi3DependencyKind k[], size_t n),
        ((void)vr, (void)e, (void)i, (void)j, (void)k, (void)n, 1))
REFUSED(fmi3GetAdjointDerivative,
        (VR, const fmi3ValueReference k[], size_t nk, const fmi3Float64 s[], size_t ns,
         fmi3Float64 r[], size_t nr),
        ((void)vr, (void)nvr, (void)k, (void)nk, (void)s, (void)ns, (void)r, (void)nr, 1))
REFUSED(fmi3EnterConfigurationMode, (fmi3Instance c), 1)
REFUSED(fmi3ExitConfigurationMode, (fmi3Instance c), 1)
REFUSED(fmi3EnterStepMode, (fmi3Instance c), 1)
REFUSED(fmi3ActivateModelPartition, (fmi3Instance c, fmi3ValueReference k, fmi3Float64 t),
        ((void)k, (void)t, 1))
