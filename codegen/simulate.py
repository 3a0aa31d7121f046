"""`simulator`: from equations, numbers and laws to what runs them."""

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any

from bondgraph.equations import StateEquations
from bondgraph.errors import ParameterError, SignalError
from codegen.corners.located import with_corners
from codegen.engine.located import LocatedLibrary, LocatedRuns
from codegen.engine.runs import CRuns
from codegen.model.doubts import warn_of_doubts
from codegen.modes.closed import ClosedModel
from codegen.program.lower import lower
from codegen.program.records import Program
from codegen.runs.arguments import check_names
from codegen.simulator import Simulator
from codegen.supplied import supplied

BACKENDS = ("numpy", "c")
"""What runs models."""


def simulator(
    equations: StateEquations,
    parameters: Mapping[str, object],
    laws: Mapping[Any, object] | None = None,
    backend: str = "numpy",
) -> Simulator:
    """A simulator of these equations with these numbers.

    ``parameters``: name to number. ``laws``: node (or the input it gives) to an expression or
    `DryFriction`, over the laws declared in the graph. A name in a law that parameters don't have is
    an input. ``backend``: "numpy", or "c", whose runs are generated C and much faster; it needs a C
    compiler and the extra ``c``.

    Warns (`ModelWarning`) of storages whose energy is not positive at these numbers, and of laws that give
    a signal from itself with several solutions, by name.

    Raises `ParameterError`, `StructureError` or `DependentSourceError` for what cannot be used,
    `SignalError` for what the backend cannot run, `MissingExtraError` for what it needs.
    """
    if backend not in BACKENDS:
        raise SignalError(f"unknown backend {backend!r}; there is {', '.join(BACKENDS)}")
    ready = bare_simulator(equations, parameters, laws)
    warn_of_doubts(ready.closed.program, equations, ready.closed.parameters)
    return with_engine(ready, backend)


def with_engine(ready: Simulator, backend: str, library: LocatedLibrary | None = None) -> Simulator:
    """The simulator with what runs it; ``library``: of one with the same program, if there is one."""
    if backend != "c":
        return ready
    located = LocatedRuns(ready.closed, library)
    if located.library.affine:
        return replace(ready, engine=CRuns(ready.closed), located=located)
    # Written now, so that what C cannot have is refused before there is a run.
    _ = located.library.sources
    return replace(ready, located=located)


def bare_simulator(
    equations: StateEquations,
    parameters: Mapping[str, object],
    laws: Mapping[Any, object] | None,
    timed: bool = True,
) -> Simulator:
    """A simulator in numpy, without a word on what is doubtful; ``timed``: as `lower` takes it."""
    if not isinstance(parameters, Mapping):
        raise ParameterError(f"parameters must map names to numbers, not be {parameters!r}")
    equations = supplied(equations, laws, parameters)
    return bound(
        with_corners(lower(equations, laws, parameters, timed)), equations, parameters, laws
    )


def bound(
    program: Program, equations: StateEquations, parameters: Mapping[str, object],
    laws: Mapping[Any, object] | None = None,
) -> Simulator:  # fmt: skip
    """A simulator of a program that was lowered for parameters of these names, with these laws."""
    closed = ClosedModel(program, equations, parameters)
    check_names(program, equations)
    return Simulator(
        tuple(name.name for name in (*program.states, *program.law_states)),
        tuple(name.name for name in program.wanted),
        tuple(name.name for name in program.outputs),
        tuple(port.name for port in program.switches),
        closed,
        None if laws is None else MappingProxyType(dict(laws)),
    )
