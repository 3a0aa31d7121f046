"""What loops over runs need of a family, whatever is swept: C sources, libraries, checks of values."""

from collections.abc import Callable
from functools import cached_property, reduce
from threading import Lock
from weakref import WeakKeyDictionary

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from bondgraph.equations import StateEquations
from bondgraph.errors import ParameterError
from codegen.batch.engine import batch_engine
from codegen.c.export import stepped, texts
from codegen.engine.sized import sizes
from codegen.engine.sizes import Engine
from codegen.family import Family
from codegen.model.exact_values import exact_parameters
from codegen.model.numbers import check_values
from codegen.numbers.arrays import Array
from codegen.numbers.lambdified import lambdified
from codegen.program.records import Program
from codegen.tuning import TUNING

Flags = NDArray[np.bool_]


class BatchModel:
    """A family's model in C.

    ``defaults``: its parameters. ``usable``: which rows of parameters have values that can be used.
    """

    def __init__(self, family: Family) -> None:
        self.program = family.program
        self.closed = family.simulator().closed
        exact = self.closed.parameters
        self.defaults = np.array([float(exact[p.name]) for p in self.program.parameters])
        check = _checked_run_by_run if self.program.varying else _checked_values
        self.usable = check(family.equations, self.program)
        self._engines: dict[int, Engine] = {}
        self._lock = Lock()

    @cached_property
    def _sources(self) -> dict[str, str]:
        return stepped(texts(self.closed, "model", [0.0] * len(self.defaults)))

    def engine(self, slots: int) -> Engine:
        """The library of an affine model for inputs whose generators have so many slots."""
        wanted = sizes(self.closed, slots)
        with self._lock:
            if wanted.G not in self._engines:
                self._engines[wanted.G] = batch_engine(self._sources, wanted)
            return self._engines[wanted.G]


def batch_model(family: Family) -> BatchModel:
    """The model of a family, made once."""
    if family not in _models:
        _models[family] = BatchModel(family)
    return _models[family]


_models: WeakKeyDictionary[Family, BatchModel] = WeakKeyDictionary()


def _checked_values(equations: StateEquations, program: Program) -> Callable[[Array], Flags]:
    """Whether storages and moduli are certain not to be zero, for rows of parameters."""
    elements = [e for e in equations.elements.values() if not e.kind.resists]
    values = [sp.sympify(e.value) for e in elements if e.value is not None]
    known = {symbol.name for symbol in program.parameters}
    constant = [v for v in values if {s.name for s in v.free_symbols} <= known]
    pairs = [(value, _size(value)) for value in constant]
    function = lambdified(list(program.parameters), pairs, cse=True)

    def usable(parameters: Array) -> Flags:
        found = np.ones(len(parameters), dtype=bool)
        for value, size in function(*parameters.T):
            found &= np.isfinite(size) & (np.abs(value) > TUNING.cancelling * np.abs(size))
        return found

    return usable


def _checked_run_by_run(equations: StateEquations, program: Program) -> Callable[[Array], Flags]:
    """Whether what changes in time has values that can be used, by exact rank."""
    names = [symbol.name for symbol in program.parameters]

    def usable(row: Array) -> bool:
        try:
            exact = exact_parameters(dict(zip(names, row.tolist(), strict=True)))
            check_values(equations, exact)
        except ParameterError:
            return False
        return True

    return lambda parameters: np.array([usable(row) for row in parameters], dtype=bool)


def _size(value: sp.Expr) -> sp.Expr:
    """The magnitude of an expression's terms, before they cancel."""
    if value.is_Add:
        return reduce(lambda a, b: a + b, (_size(part) for part in value.args))
    if value.is_Mul:
        return reduce(lambda a, b: a * b, (_size(part) for part in value.args))
    if value.is_Pow and value.exp.is_positive:
        return _size(value.base) ** value.exp
    return abs(value)
