"""`Family`: a model whose numbers are still free; its simulators share one program."""

import hashlib
import pickle
from collections.abc import Hashable, Iterator, Mapping
from dataclasses import dataclass, fields
from functools import cached_property
from types import MappingProxyType
from typing import Any

import sympy as sp

from bondgraph.algebra.atoms import normal
from bondgraph.analyse.closures import merged_laws
from bondgraph.equations import StateEquations
from bondgraph.errors import ParameterError, SignalError
from codegen.corners.located import with_corners
from codegen.engine.located import LocatedLibrary
from codegen.model.doubts import warn_of_doubts
from codegen.model.exact_values import exact_parameters
from codegen.packing import packed
from codegen.program.lower import lower
from codegen.program.records import Program
from codegen.simulate import BACKENDS, bound, with_engine
from codegen.simulator import Simulator
from codegen.supplied import supplied


@dataclass(frozen=True, eq=False)
class Family:
    """Equations, laws and default numbers; ``simulator`` binds other numbers to the same program.

    Arguments as of `codegen.simulator`. Nothing is derived or lowered anew for other numbers. A family
    can be pickled.

    >>> import bondgraph as bg
    >>> import networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("force", "F_0"), bg.One("mass"), bg.I("m", "m", flow="v"),
    ...                   bg.R("damper", "b")])
    >>> g.add_edges_from([("force", "mass"), ("mass", "m"), ("mass", "damper")])
    >>> family = Family(bg.derive(g), {"m": 2, "b": 1})
    >>> family.simulator().rhs(0, [1], [0])
    array([-0.5])
    >>> family.simulator(b=3).rhs(0, [1], [0])
    array([-1.5])
    """

    equations: StateEquations
    parameters: Mapping[str, object]
    laws: Mapping[Any, object] | None = None
    backend: str = "numpy"

    def __post_init__(self) -> None:
        if not isinstance(self.parameters, Mapping):
            raise ParameterError(
                f"parameters must map names to numbers, not be {self.parameters!r}"
            )
        if self.backend not in BACKENDS:
            raise SignalError(f"unknown backend {self.backend!r}; there is {', '.join(BACKENDS)}")
        exact_parameters(self.parameters)
        named = {str(normal(name)): value for name, value in self.parameters.items()}
        object.__setattr__(self, "equations", supplied(self.equations, self.laws, named))
        object.__setattr__(self, "parameters", MappingProxyType(named))
        if isinstance(self.laws, Mapping):
            object.__setattr__(self, "laws", MappingProxyType(dict(self.laws)))

    @cached_property
    def program(self) -> Program:
        """The equations lowered, for parameters of these names."""
        program = with_corners(lower(self.equations, self.laws, self.parameters, timed=True))
        # Once for the family's own numbers, not for every run's.
        warn_of_doubts(program, self.equations, exact_parameters(self.parameters))
        return program

    @property
    def states(self) -> tuple[str, ...]:
        """The states' names, as of every simulator."""
        return tuple(name.name for name in (*self.program.states, *self.program.law_states))

    @property
    def inputs(self) -> tuple[str, ...]:
        """The names of what a run must be given, as of every simulator."""
        return tuple(name.name for name in self.program.wanted)

    def simulator(self, /, **changes: object) -> Simulator:
        """A simulator with other numbers for some of the parameters.

        Raises `ParameterError` for a name that is no parameter and for numbers that can't be used.
        """
        changes = {str(normal(name)): value for name, value in changes.items()}
        for name in changes:
            if name not in self.parameters:
                known = ", ".join(self.parameters) or "none"
                raise ParameterError(f"{name!r} is not a parameter; there are {known}")
        values = {**self.parameters, **changes}
        ready = bound(self.program, self.equations, values, self.laws)
        return ready if self.backend != "c" else with_engine(ready, "c", self.library)

    @cached_property
    def library(self) -> LocatedLibrary:
        """The generated C that all its simulators share; `MissingExtraError` without a compiler."""
        return LocatedLibrary(bound(self.program, self.equations, self.parameters).closed)

    def fingerprint(self) -> str:
        """A digest of the model and its numbers, the same in every process.

        Two families with the same one have the same equations, elements, laws and numbers.
        """
        return hashlib.sha256("\n".join(self._described()).encode()).hexdigest()

    def _described(self) -> Iterator[str]:
        equations = self.equations
        yield f"backend {self.backend}"
        for what in ("states", "inputs", "outputs", "ports"):
            yield f"{what} {_text(getattr(equations, what))}"
        for name in "AJBEFDG":
            yield f"{name} {_text(dict(getattr(equations, name).todok()))}"
        for name, reading in equations.readings.items():
            yield f"reading {name} {_text(reading)}"
        for node, element in equations.elements.items():
            yield f"element {node!r} {element.kind} {_text(element.value)}"
        yield f"bonds {list(equations.reduction.structure.bonds)!r}"
        yield f"integrals {_text(equations.integrals)}"
        yield f"laws {_text(merged_laws(equations, self.laws or {}))}"
        yield f"parameters {_text(exact_parameters(self.parameters))}"

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled with its program, so that every process runs the very same one."""
        parts = (self.equations, dict(self.parameters), self.laws, self.backend)
        return _restored, (packed(parts), packed(self.program))


def _restored(parts: bytes, program: bytes) -> Family:
    family = Family(*pickle.loads(parts))
    object.__setattr__(family, "program", pickle.loads(program))
    return family


def _text(value: object) -> str:
    """Text that is the same in every process: expressions in a fixed order of terms, mappings sorted."""
    if isinstance(value, sp.Basic):
        return str(sp.sstr(value, order="lex"))
    if isinstance(value, Mapping):
        return "{" + ", ".join(sorted(f"{_key(k)}: {_text(v)}" for k, v in value.items())) + "}"
    if isinstance(value, tuple):
        return "(" + ", ".join(_text(part) for part in value) + ")"
    if hasattr(value, "__dataclass_fields__"):
        parts = (f"{f.name}={_text(getattr(value, f.name))}" for f in fields(value) if f.compare)  # type: ignore[arg-type]
        return f"{type(value).__name__}({', '.join(parts)})"
    return repr(value)


def _key(name: Hashable) -> str:
    return _text(name) if isinstance(name, sp.Basic) else repr(name)
