"""Every signal of a large linear graph as a sparse row of floats, along the causal order."""

from collections.abc import Mapping

import numpy as np
import scipy.sparse as sps
import scipy.sparse.linalg as spl
import sympy as sp

from bondgraph import ParameterError, SingularStorageError, StructureError
from bondgraph.causal_order import causal_equations, causal_groups
from bondgraph.elements import STORAGES, Element
from bondgraph.laws import ExpressionLaw
from bondgraph.lines import is_independent, signal_lines, variable_of
from bondgraph.strokes import Strokes
from codegen.arrays import Array
from codegen.numbers import at_parameters, exact_parameters

Matrix = sps.csr_array
Row = dict[int, float]


class SignalRows:
    """One graph's signals as rows over columns: states, inputs, the rates of states, those of inputs.

    ``states``, ``sources``: node numbers of storages with integral causality and of ports that give an
    input. ``inputs``: the inputs, each once. ``rows``: for each signal its row. ``node``: each node's
    number by its name.
    """

    def __init__(self, strokes: Strokes, parameters: Mapping[str, object]) -> None:
        self.strokes = strokes
        self._exact = exact_parameters(parameters)
        self._cache: dict[sp.Expr, float] = {}
        self._equations = causal_equations(strokes)
        self._lines = list(signal_lines(strokes, self._equations))
        ports = [node for node, element in enumerate(strokes.elements) if element.one_port]
        storages = [node for node in ports if strokes.elements[node].kind in STORAGES]
        for node in ports:
            self._check_linear(strokes.elements[node])
        self.states = [n for n in storages if is_independent(strokes, n)]
        sources = [n for n in ports if strokes.elements[n].gives and is_independent(strokes, n)]
        self.inputs = list(dict.fromkeys(self.given(n) for n in sources))
        self.sources = sources
        self.node = {name: at for at, name in enumerate(strokes.names)}
        self._check_definite(storages)
        self.rows = self._signals()

    def given(self, node: int) -> sp.Symbol:
        """The variable that a one-port gives."""
        return variable_of(self.strokes.elements[node], self.strokes.gives(node))

    def number(self, expr: sp.Expr) -> float:
        """A value at the parameters."""
        if expr not in self._cache:
            value = at_parameters(expr, self._exact)
            missing = sorted(map(str, value.free_symbols))
            if missing:
                raise ParameterError(
                    f"the value {expr} needs a number for {missing[0]}; where that is a signal, derive the "
                    "graph and use simulator, which lets values change"
                )
            number = complex(value.evalf(30))
            if number.imag or not np.isfinite(number.real):
                raise ParameterError(f"{expr} has no finite real value at these parameters")
            self._cache[expr] = number.real
        return self._cache[expr]

    def _check_linear(self, element: Element) -> None:
        if element.integral is not None:
            raise StructureError(
                f"{element.kind} {element.name!r} integrates; derive the graph and use simulator"
            )
        constant = isinstance(element.law, ExpressionLaw) and element.law.state is None
        if element.law is not None and not (
            constant and all(name.name in self._exact for name in element.law.free_symbols)
        ):
            raise StructureError(
                f"{element.kind} {element.name!r} has a law that is no constant; derive the graph and use "
                "simulator"
            )

    def _check_definite(self, storages: list[int]) -> None:
        """Refuse storages that may cancel: floats must not decide whether A has an inverse."""
        for node in storages:
            element = self.strokes.elements[node]
            if element.row or self.number(element.constant) <= 0:
                raise SingularStorageError(
                    f"{element.kind} {element.name!r} is a field or not positive: floats would "
                    "decide whether A has an inverse; derive the graph, which decides it exactly"
                )

    def _signals(self) -> list[Row]:
        """Every signal over the columns; what a dependent storage gives is the rate of what it holds."""
        place = {node: at for at, node in enumerate(self.states)}
        n, m = len(self.states), len(self.inputs)
        inputs = {name: at for at, name in enumerate(self.inputs)}
        place |= {node: n + inputs[self.given(node)] for node in self.sources}
        rows: list[Row] = [{} for _ in self._lines]
        terms = [line[1] for line in self._lines]
        for group in causal_groups(terms):
            if len(group) > 1:
                self._solve(group, terms, rows)
                continue
            signal = group[0]
            if signal in self._equations.given and not terms[signal]:
                node, sign = self._equations.given[signal]
                rows[signal] = {place[node]: float(sign)} if node in place else {}
            else:
                rows[signal] = self._sum(terms[signal], rows)
                if self._lines[signal][0] == "rate":
                    rows[signal] = {n + m + column: v for column, v in rows[signal].items()}
        return rows

    def _sum(self, terms: list[tuple[int, sp.Expr]], rows: list[Row]) -> Row:
        if len(terms) == 1 and terms[0][1] == 1:
            return rows[terms[0][0]]
        total: Row = {}
        for source, factor in terms:
            value = self.number(factor)
            for column, entry in rows[source].items():
                total[column] = total.get(column, 0.0) + value * entry
        return {column: entry for column, entry in total.items() if entry}

    def _solve(
        self, group: tuple[int, ...], terms: list[list[tuple[int, sp.Expr]]], rows: list[Row]
    ) -> None:
        """A loop of signals: one sparse system with a right side for every column that enters it."""
        place = {signal: at for at, signal in enumerate(group)}
        inside: list[Row] = []
        outside: list[Row] = []
        for at, signal in enumerate(group):
            inner = {at: 1.0}
            for source, factor in terms[signal]:
                if source in place:
                    column = place[source]
                    inner[column] = inner.get(column, 0.0) - self.number(factor)
            inside.append(inner)
            outside.append(self._sum([t for t in terms[signal] if t[0] not in place], rows))
        columns = sorted({column for row in outside for column in row})
        index = {column: at for at, column in enumerate(columns)}
        packed = [{index[column]: entry for column, entry in row.items()} for row in outside]
        right = matrix(packed, len(columns)).toarray()
        solved = spl.splu(matrix(inside, len(group)).tocsc()).solve(right)
        for at, signal in enumerate(group):
            found = np.flatnonzero(solved[at])
            rows[signal] = {columns[j]: float(solved[at, j]) for j in found.tolist()}

    def received(self, node: int) -> Row:
        """What a one-port receives, over the columns."""
        signal, sign = self._equations.received[node]
        row = self.rows[signal]
        return row if sign == 1 else {column: sign * entry for column, entry in row.items()}


def matrix(rows: list[Row], width: int) -> Matrix:
    """Sparse rows as a csr array."""
    starts = np.cumsum([0, *(len(row) for row in rows)])
    columns = np.fromiter((j for row in rows for j in row), dtype=np.int64, count=starts[-1])
    entries: Array = np.fromiter((v for row in rows for v in row.values()), float, count=starts[-1])
    made = Matrix((entries, columns, starts), shape=(len(rows), width))
    made.sort_indices()
    return made
