"""Every signal of a large linear graph as a sparse row of numbers, along the causal order.

Each entry is a float with its residue modulo a large prime beside it, so that what cancels is known
exactly, whatever rounding leaves of it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import scipy
import sympy as sp

from bondgraph.algebra.elimination import ResidueRows
from bondgraph.algebra.residues import PRIME, residues
from bondgraph.causality.lines import is_independent, signal_lines, variable_of
from bondgraph.causality.record import Strokes
from bondgraph.causality.signals import causal_equations, causal_groups
from bondgraph.errors import AlgebraicLoopError
from codegen.numbers.arrays import Array


class Entry(NamedTuple):
    """A number, and its residue modulo the prime."""

    value: float
    residue: int


Row = dict[int, Entry]
Terms = Sequence[tuple[int, sp.Expr]]


class SignalRows:
    """One graph's signals as rows over columns: states, inputs, the rates of states, those of inputs.

    All values of the graph are numbers. ``states``, ``sources``: node numbers of storages with integral
    causality and of ports that give an input. ``inputs``: the inputs, each once. ``rows``: for each signal
    its row. ``node``: each node's number by its name.
    """

    def __init__(self, strokes: Strokes) -> None:
        self.strokes = strokes
        self._number = numbers_of()
        self._equations = causal_equations(strokes)
        self._lines = list(signal_lines(strokes, self._equations))
        ports = [node for node, element in enumerate(strokes.elements) if element.one_port]
        storages = [node for node in ports if strokes.elements[node].kind.stores]
        self.states = [n for n in storages if is_independent(strokes, n)]
        self.sources = [
            n for n in ports if strokes.elements[n].gives and is_independent(strokes, n)
        ]
        self.inputs = list(dict.fromkeys(self.given(n) for n in self.sources))
        self.node = {name: at for at, name in enumerate(strokes.names)}
        self.rows = self._signals()

    def given(self, node: int) -> sp.Symbol:
        """The variable that a one-port gives."""
        return variable_of(self.strokes.elements[node], self.strokes.gives(node))

    def received(self, node: int) -> Row:
        """What a one-port receives, over the columns."""
        signal, sign = self._equations.received[node]
        row = self.rows[signal]
        return (
            row if sign == 1 else {c: Entry(-e.value, -e.residue % PRIME) for c, e in row.items()}
        )

    def _signals(self) -> list[Row]:
        place = {node: at for at, node in enumerate(self.states)}
        inputs = {name: len(self.states) + at for at, name in enumerate(self.inputs)}
        place |= {node: inputs[self.given(node)] for node in self.sources}
        rows: list[Row] = [{} for _ in self._lines]
        terms = [line[1] for line in self._lines]
        for group in causal_groups(terms):
            if len(group) > 1:
                self._solve(group, terms, rows)
            elif group[0] in self._equations.given and not terms[group[0]]:
                node, sign = self._equations.given[group[0]]
                if node in place:
                    rows[group[0]] = {place[node]: Entry(float(sign), sign % PRIME)}
            else:
                rows[group[0]] = self._sum(terms[group[0]], rows)
                if self._is_rate(group[0]):
                    rows[group[0]] = self._rate(rows[group[0]])
        return rows

    def _is_rate(self, signal: int) -> bool:
        return self._lines[signal][0] == "rate"

    def _rate(self, row: Row) -> Row:
        """What a dependent storage gives: the rate of what it holds."""
        shift = len(self.states) + len(self.inputs)
        return {shift + column: entry for column, entry in row.items()}

    def _sum(self, terms: Terms, rows: Sequence[Row]) -> Row:
        if len(terms) == 1 and terms[0][1] == 1:
            return rows[terms[0][0]]
        total: Row = {}
        for source, factor in terms:
            _add(total, rows[source], self._number(factor))
        return {column: entry for column, entry in total.items() if entry.residue}

    def _solve(self, group: tuple[int, ...], terms: Sequence[Terms], rows: list[Row]) -> None:
        """A loop of signals. What dependent storages in it give is known last, as a column of its own."""
        rates = [signal for signal in group if self._is_rate(signal)]
        others = [signal for signal in group if not self._is_rate(signal)]
        first = 2 * (len(self.states) + len(self.inputs))
        for at, signal in enumerate(rates):
            rows[signal] = {first + at: Entry(1.0, 1)}
        place = {signal: at for at, signal in enumerate(others)}
        inside: list[Row] = []
        outside: list[Row] = []
        for at, signal in enumerate(others):
            inner: Row = {at: Entry(1.0, 1)}
            for source, factor in terms[signal]:
                if source in place:
                    _add(inner, {place[source]: self._number(-factor)}, Entry(1.0, 1))
            inside.append(inner)
            outside.append(self._sum([t for t in terms[signal] if t[0] not in place], rows))
        for signal, row in zip(others, self._solved(group, inside, outside), strict=True):
            rows[signal] = row
        for signal in rates:
            held = self._sum(terms[signal], rows)
            rows[signal] = self._rate({c: e for c, e in held.items() if c < first})
        for signal in others:
            rows[signal] = _put_in(
                rows[signal], {first + at: rows[r] for at, r in enumerate(rates)}
            )

    def _solved(self, group: tuple[int, ...], inside: list[Row], outside: list[Row]) -> list[Row]:
        """``inside s = outside`` in floats, with what vanishes, and whether it can be solved, by residues."""
        from scipy.sparse.linalg import splu

        size = len(inside)
        columns = sorted({column for row in outside for column in row})
        place = {column: size + at for at, column in enumerate(columns)}
        exact = ResidueRows(
            {j: e.residue for j, e in row.items() if e.residue}
            | {place[j]: -e.residue % PRIME for j, e in known.items()}
            for row, known in zip(inside, outside, strict=True)
        )
        if not all(exact.pivot(column) for column in range(size)):
            raise AlgebraicLoopError(
                f"{self._listed(group)} form a loop whose determinant vanishes at these parameters; "
                "change a value, or put a storage on it"
            )
        packed = [{place[c] - size: e for c, e in row.items()} for row in outside]
        right = matrix(packed, len(columns)).toarray()
        values = splu(matrix(inside, size).tocsc()).solve(right)
        result: list[Row] = [{} for _ in range(size)]
        for at, pivot in exact.pivots.items():
            scale = pow(-exact.rows[at][pivot], -1, PRIME)
            for column, residue in sorted(exact.rows[at].items()):
                if column >= size:
                    value = float(values[pivot, column - size])
                    result[pivot][columns[column - size]] = Entry(value, residue * scale % PRIME)
        return result

    def _listed(self, group: tuple[int, ...]) -> str:
        names = [
            f"the {'flow' if signal % 2 else 'effort'} of {tail!r} -> {head!r}"
            for signal in group[:8]
            for tail, head in [self.strokes.declared[signal // 2]]
        ]
        return ", ".join(names) + (f" and {len(group) - 8} more" if len(group) > 8 else "")


def numbers_of() -> Callable[[sp.Expr], Entry]:
    """A function from numbers in sympy to entries; equal ones are worked out once."""
    residue = residues()
    known: dict[sp.Expr, Entry] = {}

    def number(expr: sp.Expr) -> Entry:
        if expr not in known:
            known[expr] = Entry(float(expr), residue(expr))
        return known[expr]

    return number


def _add(target: Row, row: Row, factor: Entry) -> None:
    """Add a multiple of a row in place; entries that vanish stay until all is added."""
    for column, entry in row.items():
        old = target.get(column, Entry(0.0, 0))
        target[column] = Entry(
            old.value + factor.value * entry.value,
            (old.residue + factor.residue * entry.residue) % PRIME,
        )


def _put_in(row: Row, rows: dict[int, Row]) -> Row:
    """A row with some columns replaced by rows."""
    if not rows or not row.keys() & rows.keys():
        return row
    result = {column: entry for column, entry in row.items() if column not in rows}
    for column in row.keys() & rows.keys():
        _add(result, rows[column], row[column])
    return {column: entry for column, entry in result.items() if entry.residue}


def matrix(rows: Sequence[Row], width: int) -> scipy.sparse.csr_array:
    """Sparse rows as a csr array."""
    starts = np.cumsum([0, *(len(row) for row in rows)])
    columns = np.fromiter((j for row in rows for j in row), dtype=np.int64, count=starts[-1])
    entries: Array = np.fromiter(
        (e.value for row in rows for e in row.values()), float, count=starts[-1]
    )
    made = scipy.sparse.csr_array((entries, columns, starts), shape=(len(rows), width))
    made.sort_indices()
    return made
