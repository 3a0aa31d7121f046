"""`LinearModel`: small deviations from an operating point, in symbols."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from bondgraph.algebra.exact import SingularError, rows_of, solve
from bondgraph.algebra.factored import factored
from bondgraph.errors import SingularStorageError, StructureError

if TYPE_CHECKING:
    from bondgraph.analyse.state_space import StateSpace

LARGEST_SYMBOLIC = 8
"""Transfer functions of more states are too long to be read, or to be found in reasonable time."""


@dataclass(frozen=True)
class LinearModel:
    """Small deviations from an operating point; the matrices are immutable, sparse, symbolic.

    A x' = J x + B u + E u'
       y = F x + D u + G u'
    """

    states: tuple[sp.Symbol, ...]
    inputs: tuple[sp.Symbol, ...]
    outputs: tuple[sp.Symbol, ...]
    A: sp.ImmutableSparseMatrix
    J: sp.ImmutableSparseMatrix
    B: sp.ImmutableSparseMatrix
    E: sp.ImmutableSparseMatrix
    F: sp.ImmutableSparseMatrix
    D: sp.ImmutableSparseMatrix
    G: sp.ImmutableSparseMatrix

    def __str__(self) -> str:
        """The matrices; of large models sizes and places of entries."""
        from bondgraph.show.display import equations_text

        return equations_text(self)

    def _repr_latex_(self) -> str:
        """The matrices, and where they are numbers the poles."""
        from bondgraph.show.latex_matrices import notebook_matrices
        from bondgraph.show.poles import poles_latex

        matrices = notebook_matrices(self)
        if not self.states or self.parameters:
            return matrices
        return f"{matrices}\n$${poles_latex(self.numeric({}).modes())}$$"

    @property
    def parameters(self) -> tuple[sp.Symbol, ...]:
        """The names that the matrices need numbers for, sorted."""
        matrices = (self.A, self.J, self.B, self.E, self.F, self.D, self.G)
        return tuple(sorted(set().union(*(m.free_symbols for m in matrices)), key=str))

    def transfer_function(self, s: object = "s") -> sp.ImmutableMatrix:
        """Outputs over inputs, ``F (s A - J)^-1 (B + s E) + D + s G``, for up to 8 states.

        Raises `StructureError` above that; `numeric` has no such bound.
        """
        n = len(self.states)
        if n > LARGEST_SYMBOLIC:
            raise StructureError(
                f"a transfer function of {n} states is no expression for people; there is "
                f"numeric(parameters).transfer(s) (symbolic up to {LARGEST_SYMBOLIC} states)"
            )
        at = sp.Symbol(s) if isinstance(s, str) else sp.sympify(s)
        # An own symbol: a parameter may be called s as well.
        rate = sp.Dummy("s")
        pencil, driven = rows_of(rate * self.A - self.J), rows_of(self.B + rate * self.E)
        try:
            states = solve(pencil, driven) if n else []
        except SingularError:
            raise SingularStorageError("s A - J is singular whatever s is") from None
        X = sp.Matrix(n, len(self.inputs), lambda i, j: states[i].get(j, 0))
        found = self.F * X + self.D + rate * self.G
        return sp.ImmutableMatrix(found.applyfunc(lambda g: factored(g).subs(rate, at)))

    def numeric(self, parameters: Mapping[str, object]) -> "StateSpace":
        """The same with numbers: poles, modes, frequency responses, objects for scipy and control.

        Raises `ParameterError` for names without a number, and numbers at which A is singular.
        """
        # numpy is loaded only when numbers are asked for.
        from bondgraph.analyse.state_space import state_space

        names = (self.states, self.inputs, self.outputs)
        matrices = (self.A, self.J, self.B, self.E, self.F, self.D, self.G)
        return state_space(names, matrices, parameters)
