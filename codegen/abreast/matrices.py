"""The matrices and maps of many runs at once: a program evaluated over arrays with a place for each run."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import sympy as sp

from bondgraph.errors import SimulationError
from codegen.model.numbers import assembled
from codegen.model.numpy_backend import compiled
from codegen.numbers.arrays import Array
from codegen.ports.forming import formed, rubbing
from codegen.ports.slips import ExactSlips
from codegen.program.affine import AffineMap
from codegen.program.layout import RATE, readable, widths
from codegen.program.records import Block, Program
from codegen.standalone.evaluation import Point, evaluated
from codegen.standalone.instant import Formula, Instant
from codegen.standalone.matrices import Numbers
from codegen.tuning import TUNING


class RunsBinding:
    """Blocks of a program with the numbers of many runs for its parameters, as `model.instant.Binding`."""

    def __init__(self, program: Program, parameters: Mapping[str, float | Array]) -> None:
        self.places = readable(program, lambda place, *_: place)
        self.constants = _objects([parameters[name.name] for name in program.parameters])

    def function(self, code: Block) -> "RunsBlock":
        """A block as a function of an instant of all runs."""
        return RunsBlock(self, code)


class RunsBlock(Formula):
    """A block of a program as a formula over objects, each an array with a place for each run."""

    def __init__(self, binding: RunsBinding, code: Block) -> None:
        super().__init__(binding.constants)
        self._run, self._read = compiled(code), [binding.places[n] for n in code.arguments]

    def of_pool(self, pool: Array, like: Instant) -> Array:
        """The results, of a pool."""
        return _called(self._run, [pool[at] for at in self._read])


def matrices_of(program: Program, parameters: Mapping[str, float | Array], runs: int) -> Numbers:
    """The matrices of each run; each entry is a number, or an array of those of all runs.

    Raises `SimulationError` where formulas do not take arrays, as that of a largest of numbers of which some
    are the same in all runs.
    """
    code = program.coefficients
    values = _called(compiled(code), [parameters[name.name] for name in code.arguments])

    def solve(A: Array, right: Array) -> Array:
        return unstacked(solved(stacked(A, runs), stacked(right, runs)))

    return assembled(program, values, solve)


def solved(A: Array, right: Array) -> Array:
    """``A^-1 right`` of stacks, with rows and columns scaled first; not finite where A has no inverse.

    So it is, too, where rounding could hide that.
    """
    with np.errstate(all="ignore"):
        scale = 1 / np.sqrt(np.abs(np.diagonal(A, axis1=1, axis2=2)))
        scale = np.where(np.isfinite(scale), scale, 1.0)[:, :, None]
        even = A * scale * scale.transpose(0, 2, 1)
        good = np.isfinite(even).all(axis=(1, 2))
        even[~good] = np.eye(A.shape[1])
        sizes = np.linalg.svd(even, compute_uv=False)
        good &= sizes.min(axis=1, initial=1.0) > TUNING.regular * sizes.max(axis=1, initial=0.0)
        even[~good] = np.eye(A.shape[1])
        found: Array = scale * np.linalg.solve(even, scale * right)
        found[~good] = np.nan
    return found


def forwards_map(
    program: Program, binding: RunsBinding, numbers: Numbers, slips: ExactSlips, inputs: int,
    runs: int,
) -> AffineMap:  # fmt: skip
    """The maps in which all ports slip forwards, as `modes.maps` has that of one run.

    All places where a map is probed are evaluated at once: entries are arrays of probes by runs.
    """
    made: Any = binding
    form = formed(program, made, lambda _: numbers)
    contact = rubbing(program, made, form, slips) if program.friction else None
    n, length = program.size, program.size + 2 * inputs
    probes = np.vstack([np.zeros(length), TUNING.far * np.eye(length)])
    v = _objects(list(probes.T[:, :, None]))
    point = Point(0.0, v[:n], v[n : n + inputs], v[n + inputs :])
    now = evaluated(form, contact, point, tuple(1 for _ in program.friction), checked=False)
    parts = [now.x, now.z, now.u, now.du, now.y, now.rate, now.caps]
    table = np.empty((sum(map(len, parts)), length + 1, runs))
    for row, value in enumerate(one for part in parts for one in part):
        table[row] = value
    table[:, 1:] = (table[:, 1:] - table[:, :1]) / TUNING.far
    columns = [*range(1, length + 1), 0]
    return AffineMap(
        widths(program)[: len(parts)], table[:, columns].transpose(2, 0, 1).copy(), RATE
    )


def stacked(matrix: Array, runs: int) -> Array:
    """A matrix of numbers and of arrays with a place for each run as a stack of matrices."""
    found = np.empty((*matrix.shape, runs))
    for at, value in np.ndenumerate(matrix):
        found[at] = value
    return np.moveaxis(found, -1, 0).copy()


def unstacked(stack: Array) -> Array:
    """A stack of matrices as one of arrays with a place for each run."""
    found = np.empty(stack.shape[1:], dtype=object)
    for at in np.ndindex(found.shape):
        found[at] = stack[(slice(None), *at)]
    return found


def _called(function: Callable[..., list[Any]], given: Sequence[Any]) -> Array:
    try:
        return _objects(function(*given))
    except (ArithmeticError, TypeError, ValueError) as error:
        raise SimulationError(f"a formula has no values over many runs: {error}") from None


def _objects(values: list[Any]) -> Array:
    found = np.empty(len(values), dtype=object)
    for at, value in enumerate(values):
        found[at] = value
    return found


def swept_in(expr: sp.Expr, swept: frozenset[str]) -> bool:
    """Whether an expression has a number that is another in each run."""
    return any(name.name in swept for name in expr.free_symbols)
