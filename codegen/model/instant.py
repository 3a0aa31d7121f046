"""Blocks of a program as formulas of an instant, by numpy."""

from collections.abc import Mapping, Sequence

import numpy as np
import sympy as sp

from bondgraph.errors import ParameterError, SimulationError
from codegen.model.numpy_backend import compiled
from codegen.numbers.arrays import Array, real_values
from codegen.program.layout import readable
from codegen.program.records import Block, Program
from codegen.standalone.instant import Formula, Instant


class Binding:
    """Blocks of a program with its parameters' numbers filled in, and the sides of its corners."""

    def __init__(
        self, program: Program, parameters: Mapping[str, sp.Rational], sides: Sequence[int] = ()
    ) -> None:
        self.places = readable(program, lambda place, *_: place)
        numbers = [float(parameters[name.name]) for name in program.parameters]
        self.constants = np.array([*numbers, *(sides or [0] * len(program.sides))], dtype=float)

    def function(self, code: Block) -> "BoundBlock":
        """A block as a function of an instant, giving its results as an array."""
        return BoundBlock(self, code)


class BoundBlock(Formula):
    """A block of a program as a formula; raises `SimulationError` where a law has no value."""

    def __init__(self, binding: Binding, code: Block) -> None:
        unknown = [name.name for name in code.arguments if name not in binding.places]
        if unknown:
            raise ParameterError(f"{', '.join(unknown)} need a number in parameters")
        super().__init__(binding.constants)
        self.code, self._run = code, compiled(code)
        self._read = [binding.places[name] for name in code.arguments]

    def of_pool(self, pool: Array, like: Instant) -> Array:
        """The results, of a pool."""
        try:
            return real_values(self._run(*pool[self._read].tolist()))
        except (ArithmeticError, TypeError) as error:
            raise SimulationError(f"at t = {pool[0]:g} a law has no value: {error}") from None

    def read(self, pool: Array) -> Sequence[int]:
        """The places in a pool of the names that the block reads."""
        return self._read
