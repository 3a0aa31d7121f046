"""Units that are somebody else's: a first-order lag ``T y' + y = k u``, written by hand in C for FMI 2 and 3.

Nothing of them is the toolkit's. Between communication points u is held, so each step is exact:
``y += (k u - y) (1 - exp(-h/T))``. ``u`` beyond 1000 is an error, with a word in the log.
"""

# ruff: noqa: E501

import subprocess
import zipfile
from pathlib import Path

import fmpy

HEADERS = Path(fmpy.__file__).parent / "c-code"

CORE = r"""
#include <math.h>
#include <stdlib.h>
#include <string.h>
typedef struct { double u, y, k, T, start, slope; int n, on; LOG } lag;
static void lag_go(lag *f, double h)
{
    /* u is a line over the step: y follows it by a lag. */
    const double a = exp(-h / f->T), lead = f->k * (f->u - f->slope * f->T);
    f->y = lead + f->k * f->slope * h + (f->y - lead) * a;
    f->u += f->slope * h;
    f->n++;
}
static double *lag_real(lag *f, unsigned vr)
{
    return vr == 0 ? &f->u : vr == 1 ? &f->y : vr == 2 ? &f->k : vr == 3 ? &f->T : NULL;
}
"""

SECOND = (
    r"""
#define LOG fmi2CallbackFunctions call; char name[64];
#include "fmi2Functions.h"
"""
    + CORE
    + r"""
#define F ((lag *)c)
const char *fmi2GetTypesPlatform(void) { return "default"; }
const char *fmi2GetVersion(void) { return "2.0"; }
fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String cs[])
{ F->on = on; return fmi2OK; }
fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String at,
                              const fmi2CallbackFunctions *call, fmi2Boolean visible, fmi2Boolean on)
{
    lag *f = call->allocateMemory(1, sizeof *f);
    f->k = f->T = 1.0; f->call = *call; f->on = on;
    strncpy(f->name, name, 63);
    return f;
}
void fmi2FreeInstance(fmi2Component c) { F->call.freeMemory(c); }
fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean td, fmi2Real t, fmi2Real start,
                               fmi2Boolean sd, fmi2Real stop) { F->start = start; return fmi2OK; }
fmi2Status fmi2EnterInitializationMode(fmi2Component c) { return fmi2OK; }
fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return fmi2OK; }
fmi2Status fmi2Terminate(fmi2Component c) { return fmi2OK; }
fmi2Status fmi2Reset(fmi2Component c) { return fmi2OK; }
fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2Real v[])
{ for (size_t i = 0; i < n; i++) v[i] = *lag_real(F, vr[i]); return fmi2OK; }
fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2Real v[])
{ for (size_t i = 0; i < n; i++) *lag_real(F, vr[i]) = v[i]; return fmi2OK; }
fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2Integer v[])
{ for (size_t i = 0; i < n; i++) v[i] = F->n; return fmi2OK; }
fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2Integer v[])
{ for (size_t i = 0; i < n; i++) F->n = v[i]; return fmi2OK; }
fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2Boolean v[])
{ for (size_t i = 0; i < n; i++) v[i] = F->y > 0.5; return fmi2OK; }
fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2Boolean v[])
{ return fmi2Error; }
fmi2Status fmi2DoStep(fmi2Component c, fmi2Real t, fmi2Real h, fmi2Boolean no)
{
    if (fabs(F->u) > 1000) {
        F->call.logger(F->call.componentEnvironment, F->name, fmi2Error, "logStatusError",
                       "u = %g is out of range at t = %g", F->u, t);
        return fmi2Error;
    }
    if (DISCARDS && h > 0.15)
        return fmi2Discard;
    lag_go(F, h);
    return fmi2OK;
}
fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                       const fmi2Integer order[], const fmi2Real v[])
{ F->slope = v[0]; return order[0] == 1 && vr[0] == 0 ? fmi2OK : fmi2Error; }
#define NOT(name, ...) fmi2Status name(fmi2Component c, __VA_ARGS__) { return fmi2Error; }
#define VR const fmi2ValueReference vr[], size_t n
NOT(fmi2GetString, VR, fmi2String v[])
NOT(fmi2SetString, VR, const fmi2String v[])
NOT(fmi2GetFMUstate, fmi2FMUstate *s)
NOT(fmi2SetFMUstate, fmi2FMUstate s)
NOT(fmi2FreeFMUstate, fmi2FMUstate *s)
NOT(fmi2SerializedFMUstateSize, fmi2FMUstate s, size_t *n)
NOT(fmi2SerializeFMUstate, fmi2FMUstate s, fmi2Byte b[], size_t n)
NOT(fmi2DeSerializeFMUstate, const fmi2Byte b[], size_t n, fmi2FMUstate *s)
NOT(fmi2GetDirectionalDerivative, VR, const fmi2ValueReference k[], size_t m, const fmi2Real d[], fmi2Real v[])
NOT(fmi2GetRealOutputDerivatives, VR, const fmi2Integer o[], fmi2Real v[])
NOT(fmi2GetStatus, const fmi2StatusKind k, fmi2Status *v)
NOT(fmi2GetRealStatus, const fmi2StatusKind k, fmi2Real *v)
NOT(fmi2GetIntegerStatus, const fmi2StatusKind k, fmi2Integer *v)
NOT(fmi2GetBooleanStatus, const fmi2StatusKind k, fmi2Boolean *v)
NOT(fmi2GetStringStatus, const fmi2StatusKind k, fmi2String *v)
fmi2Status fmi2CancelStep(fmi2Component c) { return fmi2Error; }
"""
)

THIRD = (
    r"""
#define LOG fmi3LogMessageCallback log; void *env;
#include "fmi3Functions.h"
"""
    + CORE
    + r"""
#include <stdio.h>
#define F ((lag *)c)
const char *fmi3GetVersion(void) { return "3.0"; }
fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String at,
    fmi3Boolean visible, fmi3Boolean on, fmi3Boolean events, fmi3Boolean early,
    const fmi3ValueReference vr[], size_t n, fmi3InstanceEnvironment env, fmi3LogMessageCallback log,
    fmi3IntermediateUpdateCallback update)
{
    lag *f = calloc(1, sizeof *f);
    f->k = f->T = 1.0; f->log = log; f->env = env; f->on = on;
    return f;
}
void fmi3FreeInstance(fmi3Instance c) { free(c); }
fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean td, fmi3Float64 t, fmi3Float64 start,
                                       fmi3Boolean sd, fmi3Float64 stop) { return fmi3OK; }
fmi3Status fmi3ExitInitializationMode(fmi3Instance c) { return fmi3OK; }
fmi3Status fmi3Terminate(fmi3Instance c) { return fmi3OK; }
fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference vr[], size_t n, fmi3Float64 v[], size_t m)
{ for (size_t i = 0; i < n; i++) v[i] = *lag_real(F, vr[i]); return fmi3OK; }
fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference vr[], size_t n, const fmi3Float64 v[], size_t m)
{ for (size_t i = 0; i < n; i++) *lag_real(F, vr[i]) = v[i]; return fmi3OK; }
fmi3Status fmi3GetInt32(fmi3Instance c, const fmi3ValueReference vr[], size_t n, fmi3Int32 v[], size_t m)
{ for (size_t i = 0; i < n; i++) v[i] = F->n; return fmi3OK; }
fmi3Status fmi3SetInt32(fmi3Instance c, const fmi3ValueReference vr[], size_t n, const fmi3Int32 v[], size_t m)
{ for (size_t i = 0; i < n; i++) F->n = v[i]; return fmi3OK; }
fmi3Status fmi3GetBoolean(fmi3Instance c, const fmi3ValueReference vr[], size_t n, fmi3Boolean v[], size_t m)
{ for (size_t i = 0; i < n; i++) v[i] = F->y > 0.5; return fmi3OK; }
fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 t, fmi3Float64 h, fmi3Boolean no, fmi3Boolean *event,
                      fmi3Boolean *ended, fmi3Boolean *early, fmi3Float64 *last)
{
    char text[80];
    *event = *early = false; *last = t + h;
    *ended = F->u == 999;
    if (fabs(F->u) > 1000) {
        snprintf(text, sizeof text, "u = %g is out of range at t = %g", F->u, t);
        F->log(F->env, fmi3Error, "logStatusError", text);
        return fmi3Error;
    }
    if (DISCARDS && h > 0.15)
        return fmi3Discard;
    lag_go(F, h);
    return fmi3OK;
}
"""
)

SECOND_ABOUT = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="lag" guid="{{lag}}">
  {kind}
  <UnitDefinitions><Unit name="N"><BaseUnit kg="1" m="1" s="-2"/></Unit><Unit name="m/s"><BaseUnit m="1" s="-1"/></Unit></UnitDefinitions>
  <ModelVariables>
    <ScalarVariable name="u" valueReference="0" causality="input" variability="continuous"><Real start="0" unit="N"/></ScalarVariable>
    <ScalarVariable name="y" valueReference="1" causality="output" variability="continuous" initial="calculated"><Real unit="m/s"/></ScalarVariable>
    <ScalarVariable name="k" valueReference="2" causality="parameter" variability="fixed"><Real start="1"/></ScalarVariable>
    <ScalarVariable name="T" valueReference="3" causality="parameter" variability="fixed"><Real start="1"/></ScalarVariable>
    <ScalarVariable name="steps" valueReference="4" causality="output" variability="discrete"><Integer/></ScalarVariable>
    <ScalarVariable name="high" valueReference="5" causality="output" variability="discrete"><Boolean/></ScalarVariable>
    <ScalarVariable name="label" valueReference="6" causality="output" variability="discrete"><String/></ScalarVariable>
  </ModelVariables>
  <ModelStructure><Outputs><Unknown index="2"/><Unknown index="5"/><Unknown index="6"/><Unknown index="7"/></Outputs><InitialUnknowns><Unknown index="2"/><Unknown index="5"/><Unknown index="6"/><Unknown index="7"/></InitialUnknowns></ModelStructure>
</fmiModelDescription>
"""

THIRD_ABOUT = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="lag" instantiationToken="{{lag}}">
  {kind}
  <UnitDefinitions><Unit name="N"><BaseUnit kg="1" m="1" s="-2"/></Unit><Unit name="m/s"><BaseUnit m="1" s="-1"/></Unit></UnitDefinitions>
  <ModelVariables>
    <Float64 name="time" valueReference="9" causality="independent" variability="continuous"/>
    <Float64 name="u" valueReference="0" causality="input" start="0" unit="N"/>
    <Float64 name="y" valueReference="1" causality="output" initial="calculated" unit="m/s"/>
    <Float64 name="k" valueReference="2" causality="parameter" variability="fixed" start="1"/>
    <Float64 name="T" valueReference="3" causality="parameter" variability="fixed" start="1"/>
    <Int32 name="steps" valueReference="4" causality="output" initial="calculated"/>
    <Boolean name="high" valueReference="5" causality="output" initial="calculated"/>
  </ModelVariables>
  <ModelStructure><Output valueReference="1"/><Output valueReference="4"/><Output valueReference="5"/><InitialUnknown valueReference="1"/><InitialUnknown valueReference="4"/><InitialUnknown valueReference="5"/></ModelStructure>
</fmiModelDescription>
"""

KIND = '<CoSimulation modelIdentifier="lag" {more}/>'
VARIABLE = 'canHandleVariableCommunicationStepSize="true"'


def lag_unit(
    folder: Path, version: str, kind: str = "", *, discards: bool = False, platform: str = ""
) -> Path:
    """A unit of the lag; ``kind``: its interface, ``discards``: steps above 0.15 s."""
    second = version == "2.0"
    folder.mkdir(exist_ok=True)
    source, library = folder / f"lag{version[0]}.c", folder / f"lag{version[0]}.so"
    text = SECOND if second else THIRD + _missing(THIRD)
    source.write_text(f"#define DISCARDS {int(discards)}\n{text}")
    subprocess.run(
        [
            "gcc",
            "-shared",
            "-fPIC",
            "-O1",
            "-w",
            f"-I{HEADERS}",
            str(source),
            "-o",
            str(library),
            "-lm",
        ],
        check=True,
    )
    about = (SECOND_ABOUT if second else THIRD_ABOUT).format(
        kind=kind or KIND.format(more=VARIABLE)
    )
    place = platform or (fmpy.platform if second else fmpy.platform_tuple)
    path = folder / f"lag{version[0]}.fmu"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("modelDescription.xml", about)
        archive.write(library, f"binaries/{place}/lag{fmpy.sharedLibraryExtension}")
    return path


def _missing(text: str) -> str:
    """The rest of FMI 3's functions, none of which works: importers look for all of them."""
    import re

    from fmpy.fmi3 import _FMU3, FMU3Slave

    wanted = {name for kind in (_FMU3, FMU3Slave) for name in dir(kind) if name.startswith("fmi3")}
    have = set(re.findall(r"\b(fmi3[A-Z]\w+)\(", text))
    declared = (HEADERS / "fmi3Functions.h").read_text() + (
        HEADERS / "fmi3FunctionTypes.h"
    ).read_text()
    found = []
    for name in sorted(wanted - have):
        typedef = re.search(rf"typedef\s+(\w+)\s+{name}TYPE\s*\((.*?)\);", declared, re.DOTALL)
        assert typedef, name
        empty = {"fmi3Status": "return fmi3Error;", "void": ""}.get(typedef[1], "return 0;")
        found.append(f"{typedef[1]} {name}({typedef[2]}) {{ {empty} }}")
    return "\n".join(found)
