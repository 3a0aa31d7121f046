"""modelDescription.xml of FMI 2.0 and 3.0, and FMI 3.0's description of how sources are built."""

from collections.abc import Iterable, Mapping, Sequence
from importlib.metadata import version as installed
from xml.etree import ElementTree

from codegen.fmu.dependencies import dependencies
from codegen.fmu.model import FmuModel
from codegen.fmu.variable import Variable

Element = ElementTree.Element

TOOL = "bondgraph-toolkit"


def description(model: FmuModel, version: str, token: str, sources: Sequence[str]) -> str:
    """modelDescription.xml; ``sources``: the C files, which FMI 2.0 lists here."""
    second = version == "2.0"
    root = Element("fmiModelDescription")
    _put(root, {
        "fmiVersion": version,
        "modelName": model.name,
        "guid" if second else "instantiationToken": token,
        "generationTool": f"{TOOL} {installed(TOOL)}",
        "variableNamingConvention": "flat",
    })  # fmt: skip
    if second:
        root.set("numberOfEventIndicators", str(model.indicators))
    _interfaces(root, model.identifier, second, sources)
    _units(root, model.variables)
    categories = _child(root, "LogCategories")
    for category in ("logStatusError", "logStatusWarning"):
        _child(categories, "Category", {"name": category})
    _child(root, "DefaultExperiment", {
        "startTime": "0.0", "stopTime": "1.0", "tolerance": "1e-6",
        "stepSize": repr(model.starts.step),
    })  # fmt: skip
    listed = _child(root, "ModelVariables")
    for at, variable in enumerate(model.variables):
        if second and variable.kind != "FMU_INDICATOR":
            _variable_2(listed, at, variable)
        elif not second:
            _variable_3(listed, at, variable)
    _structure(root, model, second)
    return text_of(root)


def text_of(root: Element) -> str:
    """A document as text, indented."""
    ElementTree.indent(root, "  ")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{ElementTree.tostring(root, "unicode")}\n'


def build_description(identifier: str, sources: Iterable[str]) -> str:
    """sources/buildDescription.xml of FMI 3.0."""
    root = Element("fmiBuildDescription", {"fmiVersion": "3.0"})
    made = _child(root, "BuildConfiguration", {"modelIdentifier": identifier})
    files = _child(made, "SourceFileSet", {"language": "C99"})
    for name in sources:
        _child(files, "SourceFile", {"name": name})
    return text_of(root)


def _interfaces(root: Element, identifier: str, second: bool, sources: Sequence[str]) -> None:
    state = "FMUstate" if second else "FMUState"
    both = {
        "modelIdentifier": identifier,
        f"canGetAndSet{state}": "true",
        f"canSerialize{state}": "true",
        "providesDirectionalDerivative" if second else "providesDirectionalDerivatives": "true",
    }
    more = {"canHandleVariableCommunicationStepSize": "true"}
    if second:
        more["canInterpolateInputs"] = "true"
    for element in (
        _child(root, "ModelExchange", both),
        _child(root, "CoSimulation", both | more),
    ):
        if second:
            files = _child(element, "SourceFiles")
            for name in sources:
                _child(files, "File", {"name": name})


def _units(root: Element, variables: Sequence[Variable]) -> None:
    names = sorted({variable.unit for variable in variables if variable.unit})
    listed = _child(root, "UnitDefinitions")
    for name in names:
        unit = _child(listed, "Unit", {"name": name})
        if name == "s":
            _child(unit, "BaseUnit", {"s": "1"})


def _about(at: int, variable: Variable) -> dict[str, str]:
    found = {
        "name": variable.name,
        "valueReference": str(at),
        "causality": variable.causality,
        "variability": variable.variability,
    }
    found |= {"description": variable.description} if variable.description else {}
    return found | ({"initial": variable.initial} if variable.initial else {})


def _typed(variable: Variable, derivative: int) -> dict[str, str]:
    starts = variable.array or (() if variable.start is None else (variable.start,))
    found = {"start": " ".join(repr(float(one)) for one in starts)} if starts else {}
    if variable.unit:
        found["unit"] = variable.unit
    if variable.derivative is not None:
        found["derivative"] = str(variable.derivative + derivative)
    return found


def _variable_2(parent: Element, at: int, variable: Variable) -> None:
    scalar = _child(parent, "ScalarVariable", _about(at, variable))
    # There a state is told by its place among the variables, from 1.
    _child(scalar, "Integer" if variable.integer else "Real", _typed(variable, 1))


def _variable_3(parent: Element, at: int, variable: Variable) -> None:
    kind = "Int32" if variable.integer else "Float64"
    one = _child(parent, kind, _about(at, variable) | _typed(variable, 0))
    for size in variable.sizes:
        _child(one, "Dimension", {"start": str(size)})


def _structure(root: Element, model: FmuModel, second: bool) -> None:
    """Which variables are outputs, rates of states, and found at the start; what they depend on."""
    variables, known = model.variables, dependencies(model)
    structure = _child(root, "ModelStructure")
    outputs = [at for at, one in enumerate(variables) if one.causality == "output"]
    rates = [at for at, one in enumerate(variables) if one.derivative is not None]
    states = [one.derivative for one in variables if one.derivative is not None]
    first = {at for at in (*outputs, *rates, *states) if variables[at].initial != "exact"}
    named = (
        ("Outputs", "Output", outputs),
        ("Derivatives", "ContinuousStateDerivative", rates),
        ("InitialUnknowns", "InitialUnknown", sorted(first)),
    )
    for plural, single, places in named:
        listed = _child(structure, plural) if second and places else structure
        for at in places:
            # At the start values depend on parameters, too: on all, where nothing is told.
            about = {} if single == "InitialUnknown" or known is None else _used(known, at, second)
            if second:
                _child(listed, "Unknown", {"index": str(at + 1)} | about)
            else:
                _child(listed, single, {"valueReference": str(at)} | about)
    for at, one in enumerate(variables):
        if not second and one.kind == "FMU_INDICATOR":
            _child(structure, "EventIndicator", {"valueReference": str(at)})


def _used(known: Mapping[int, Sequence[int]], at: int, second: bool) -> dict[str, str]:
    """The dependencies of one variable, if they are known."""
    if at not in known:
        return {}
    return {"dependencies": " ".join(str(one + second) for one in known[at])}


def _child(parent: Element, name: str, attributes: Mapping[str, str] | None = None) -> Element:
    made = ElementTree.SubElement(parent, name)
    _put(made, attributes or {})
    return made


def _put(element: Element, attributes: Mapping[str, str]) -> None:
    for key, value in attributes.items():
        element.set(key, value)
