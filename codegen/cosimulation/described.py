"""What a unit says of itself: its variables, what it can do, and whether it can take part here."""

from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import Any
from zipfile import ZipFile, is_zipfile

import sympy as sp

from bondgraph.errors import MissingExtraError, UnitError
from codegen.cosimulation.instants import seconds

INTEGERS = {
    "Integer": "Integer", "Int8": "Int8", "Int16": "Int16", "Int32": "Int32", "Int64": "Int64",
    "UInt8": "UInt8", "UInt16": "UInt16", "UInt32": "UInt32", "UInt64": "UInt64",
}  # fmt: skip
KINDS: Mapping[str, str] = MappingProxyType(
    {"Real": "Real", "Float64": "Float64", "Float32": "Float32", "Boolean": "Boolean", **INTEGERS}
)
"""Types of which a value is one number."""

READ = ("output", "local", "independent", "calculatedParameter")
"""What a connection may come from, by its causality."""


@dataclass(frozen=True)
class UnitVariable:
    """A variable: ``kind`` is the type by which it is got and set."""

    name: str
    reference: int
    kind: str
    causality: str
    unit: str
    #: The inputs that its value at the start depends on; None where that is not told.
    first: frozenset[str] | None


@dataclass(frozen=True)
class UnitDescription:
    """A unit for co-simulation. ``second``: FMI 2; ``variables``: those of which a value is one number.

    ``fixed_step``: what communication steps must be whole multiples of [s], 0 where there is none.
    """

    path: Path
    second: bool
    token: str
    identifier: str
    variables: Mapping[str, UnitVariable]
    variable_steps: bool
    fixed_step: float
    interpolates: bool
    #: Whether a process may have one instance of it only.
    once: bool

    def names(self, *causalities: str) -> tuple[str, ...]:
        """Variables of these causalities."""
        return tuple(one.name for one in self.variables.values() if one.causality in causalities)


def fmpy_module() -> Any:
    """The package that loads units; `MissingExtraError` without it."""
    try:
        import fmpy
    except ImportError:
        raise MissingExtraError(
            "units of others are loaded by fmpy; install the optional extra: pip install "
            '"bondgraph-toolkit[fmu]"'
        ) from None
    return fmpy


def described(path: str | PathLike[str]) -> UnitDescription:
    """What the unit in a file says of itself.

    Raises `UnitError` for a file that is no unit, of another version than FMI 2 or 3, for model exchange
    alone, or without a library for this platform; `MissingExtraError` without fmpy.
    """
    fmpy, file = fmpy_module(), Path(path)
    if not file.is_file():
        raise UnitError(f"unit {str(file)!r}: there is no such file")
    if not is_zipfile(file):
        raise UnitError(f"unit {str(file)!r}: the file is no archive, and so no unit")
    try:
        told = fmpy.read_model_description(str(file), validate=False)
    except Exception as error:  # noqa: BLE001 - whatever fmpy and lxml say of a broken description
        raise UnitError(
            f"unit {str(file)!r}: its modelDescription.xml cannot be read: {error}"
        ) from None
    version = str(told.fmiVersion)
    if version[:2] not in ("2.", "3."):
        raise UnitError(f"unit {str(file)!r} is of FMI {version}; FMI 2 and 3 take part")
    if told.coSimulation is None:
        raise UnitError(
            f"unit {str(file)!r} is not for co-simulation; export it anew, with co-simulation"
        )
    second = version.startswith("2.")
    _check_library(file, told.coSimulation.modelIdentifier, fmpy, second)
    about = told.coSimulation
    return UnitDescription(
        file,
        second,
        told.guid if second else told.instantiationToken,
        about.modelIdentifier,
        MappingProxyType(_variables(told, second)),
        bool(about.canHandleVariableCommunicationStepSize),
        float(about.fixedInternalStepSize or 0.0),
        second and bool(about.canInterpolateInputs),
        bool(about.canBeInstantiatedOnlyOncePerProcess),
    )


def check_steps(one: UnitDescription, every: sp.Rational, where: str) -> None:
    """Refuse an interval that is no whole number of the steps of a unit that has fixed ones."""
    if not one.fixed_step or one.variable_steps:
        return
    step = seconds(one.fixed_step, "fixedInternalStepSize")
    if (every / step).q != 1:
        raise UnitError(
            f"{where} goes in steps of {step} s: a communication interval of {every} s is no whole number of "
            f"them; take every={float(step * max((every / step).ceiling(), 1))}"
        )


def _variables(told: Any, second: bool) -> dict[str, UnitVariable]:
    listed = {one.variable.name: one.dependencies for one in told.initialUnknowns}
    found = dict[str, UnitVariable]()
    for one in told.modelVariables:
        kind = KINDS.get(one.type)
        if one.type == "Enumeration":
            kind = "Integer" if second else "Int64"
        if kind is None or one.dimensions:
            continue
        first: frozenset[str] | None = None
        if one.name in listed and listed[one.name] is not None:
            first = frozenset(other.name for other in listed[one.name])
        elif one.initial == "exact":
            first = frozenset()
        causality = one.causality or "local"
        unit = one.unit or (one.declaredType.unit if one.declaredType else None) or ""
        found[one.name] = UnitVariable(
            one.name, int(one.valueReference), kind, causality, unit, first
        )
    return found


def _check_library(file: Path, identifier: str, fmpy: Any, second: bool) -> None:
    """Refuse a unit without a library for this machine, naming those that it has."""
    platform = fmpy.platform if second else fmpy.platform_tuple
    with ZipFile(file) as archive:
        names = archive.namelist()
    if f"binaries/{platform}/{identifier}{fmpy.sharedLibraryExtension}" in names:
        return
    parts = [name.split("/") for name in names]
    there = sorted(
        {part[1] for part in parts if part[0] == "binaries" and len(part) > 2 and part[2]}
    )
    raise UnitError(
        f"unit {str(file)!r} has no library for this platform, {platform}; it has "
        f"{', '.join(there) or 'none'}: export it for this platform, too"
    )
