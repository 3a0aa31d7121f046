"""One instant under evaluation, and program blocks as functions of it."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.errors import ParameterError, SimulationError
from codegen.model.numbers import Numbers
from codegen.model.numpy_backend import compiled
from codegen.numbers.arrays import Array, real_values
from codegen.program.records import Block, Program


@dataclass
class Instant:
    """Every variable at one time; inputs ``u`` and readings ``y`` are completed law by law.

    ``x``, ``z``: states, and states that laws own. ``du``: rates of those inputs that have one. ``w``,
    ``dw``: external inputs and their rates. ``caps``: breakaway efforts of the friction ports.
    ``numbers``: the matrices, as they are at this instant.
    """

    t: float
    x: Array
    z: Array
    u: Array
    du: Array
    y: Array
    w: Array
    dw: Array
    caps: Array
    numbers: Numbers
    #: The largest magnitudes that x and z have had, where a run is known: what they round by.
    seen: Array | None = None

    def give(self, columns: Sequence[int], values: Array, D: Array) -> None:
        """Add to inputs, and to the readings that show them at once."""
        index = list(columns)
        self.u[index] += values
        self.y += D[:, index] @ values


Evaluation = Callable[[Instant], Array]


class Binding:
    """Blocks of a program with its parameters' numbers filled in."""

    def __init__(self, program: Program, parameters: Mapping[str, sp.Rational]) -> None:
        self._places = _places(program)
        self._constants = np.array([float(parameters[name.name]) for name in program.parameters])

    def function(self, code: Block) -> Evaluation:
        """A block as a function of an instant, giving its results as an array."""
        if not code.results:
            return lambda now: np.zeros(0)
        evaluate = self.of_pool(code)
        return lambda now: evaluate(self.pool(now))

    def pool(self, now: Instant) -> Array:
        """Everything that blocks read, in one array: t, x, z, y, u, w, w' and the parameters."""
        return np.concatenate(
            ((now.t,), now.x, now.z, now.y, now.u, now.w, now.dw, self._constants)
        )

    def of_pool(self, code: Block) -> Callable[[Array], Array]:
        """A block as a function of a pool."""
        run, indices = compiled(code), self.read(code)

        def evaluate(pool: Array) -> Array:
            try:
                return real_values(run(*pool[indices].tolist()))
            except (ArithmeticError, TypeError) as error:
                raise SimulationError(f"at t = {pool[0]:g} a law has no value: {error}") from None

        return evaluate

    def read(self, code: Block) -> list[int]:
        """Where in a pool the names stand that a block reads."""
        unknown = [name.name for name in code.arguments if name not in self._places]
        if unknown:
            raise ParameterError(f"{', '.join(unknown)} need a number in parameters")
        return [self._places[name] for name in code.arguments]


def _places(program: Program) -> dict[sp.Symbol, int]:
    """Where each name's value stands in the pool; a parameter before an input that it holds."""
    listed = [
        TIME, *program.states, *program.law_states, *program.readings, *program.inputs,
        *program.external, *program.external_rates, *program.parameters,
    ]  # fmt: skip
    first_parameter = len(listed) - len(program.parameters)
    places = {name: first_parameter + at for at, name in enumerate(program.parameters)}
    for at, name in enumerate(listed[:first_parameter]):
        places.setdefault(name, at)
    return places
