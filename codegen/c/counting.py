"""What a real-time step of an exported model costs, as a count of operations."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import sympy as sp

from bondgraph.algebra.lookups import Tabled
from bondgraph.inverses.inverse import Inverse
from bondgraph.searching import MOST
from bondgraph.tables.pieces import pieces
from codegen.program.records import Block, Program
from codegen.tuning import TUNING

TURNS_EACH, TURNS_MORE = 4, 8
"""Ways that one problem of so many ports tries at the most: as many as `port_box.c`."""


@dataclass(frozen=True)
class Count:
    """Operations in floating point: multiplications, additions, divisions, and calls of functions."""

    multiplications: int = 0
    additions: int = 0
    divisions: int = 0
    calls: int = 0

    def __add__(self, other: "Count") -> "Count":
        return Count(*(a + b for a, b in zip(self.parts, other.parts, strict=True)))

    def __mul__(self, times: int) -> "Count":
        return Count(*(times * a for a in self.parts))

    @property
    def parts(self) -> tuple[int, int, int, int]:
        """The four numbers."""
        return self.multiplications, self.additions, self.divisions, self.calls

    @property
    def total(self) -> int:
        """All of them."""
        return sum(self.parts)

    def __str__(self) -> str:
        words = ("multiplications", "additions", "divisions", "calls")
        return (
            ", ".join(
                f"{count} {word}" for count, word in zip(self.parts, words, strict=True) if count
            )
            or "none"
        )


@dataclass(frozen=True)
class StepCost:
    """Of one evaluation of the rates, of a step in which no port changes, of one change, of any step.

    ``pivots``: how many systems one change solves at the most; ``changes``: how many there are.
    """

    evaluation: Count
    usual: Count
    change: Count
    most: Count
    evaluations: int
    pivots: int
    changes: int


def step_cost(program: Program, implicit: bool) -> StepCost:
    """Counts by the sizes of a program; matrices as if they were full.

    Neither counted are integers, nor, where there are any, searches for what laws that determine one another
    give, and how redundant ports share a load.
    """
    ports, size = len(program.friction), len(program.states) + len(program.law_states)
    one = _evaluation(program)
    outside = len(program.external)
    method, evaluations = _rosenbrock(size, outside) if implicit else _runge_kutta(size)
    around = _products(2 * ports * _width(program)) + _settling(program)
    evaluations += 2 if ports else 0
    usual = one * evaluations + method + (around if ports else Count())
    pivots = TURNS_EACH * ports + TURNS_MORE if ports else 0
    change = _change(program, pivots) + one * 2 if ports else Count()
    # Where a task sets anything at a start, that is decided once more.
    changes = (TUNING.rounds + 1) * (2 if program.clocks else 1) if ports else 0
    return StepCost(one, usual, change, usual + change * changes, evaluations, pivots, changes)


def counted(expressions: Iterable[sp.Expr]) -> Count:
    """The operations of expressions as they are written.

    >>> x, y = sp.symbols("x y")
    >>> print(counted([x*y + 2*x/y - sp.sin(x)]))
    2 multiplications, 2 additions, 1 divisions, 1 calls

    A comparison, as when a table is halved to find an argument's cell, counts as an addition. A law that is
    turned round counts with all the steps that its search may take.
    """
    found = Count()
    for one in expressions:
        for look in one.atoms(Tabled):
            found += _looked_up(look)
        for inverse in one.atoms(Inverse):
            found += _searched(inverse)
        for term in sp.Add.make_args(sp.sympify(sp.count_ops(one, visual=True))):
            times, word = term.as_coeff_Mul()
            found += _of(str(word), int(times)) if word != 1 else Count()
    return found


def _looked_up(look: Tabled) -> Count:
    """What looking into a table takes beside its call: halving along each axis, and polynomials."""
    breaks, degree, _, _ = pieces(look.handle.table)
    searched = Count(8 * (MOST + 1), 7 * (MOST + 1), MOST + 1) if degree < 0 else Count()
    halves = sum((len(knots) + 1).bit_length() for knots in breaks)
    size = abs(degree) + 1
    lines = 1 if len(breaks) == 1 else size + 1
    return Count(2 * lines * size, lines * size + halves) + searched


def _searched(inverse: Inverse) -> Count:
    """What turning a law round takes where the search needs all of its steps, from zero on."""
    once = counted(inverse.turning.evaluated())
    steps = MOST + 1
    return Count(
        steps * once.multiplications, steps * (once.additions + 2), steps * (once.divisions + 1),
        steps * once.calls,
    )  # fmt: skip


def _of(word: str, times: int) -> Count:
    if word == "MUL":
        return Count(multiplications=times)
    if word in ("ADD", "SUB"):
        return Count(additions=times)
    if word == "DIV":
        return Count(divisions=times)
    return Count() if word == "NEG" else Count(calls=times)


def _products(count: int) -> Count:
    """So many products, each added to a sum."""
    return Count(count, count)


def _blocks(blocks: Sequence[Block]) -> Count:
    return counted(
        value
        for block in blocks
        for value in (*(one for _, one in block.assignments), *block.results)
    )


def _width(program: Program) -> int:
    return len(program.states) + len(program.inputs)


def _evaluation(program: Program) -> Count:
    """Everything at one instant, all ports held."""
    n, m, rows = len(program.states), len(program.inputs), len(program.readings)
    k = len(program.friction)
    given = sum(len(group.inputs) for group in program.groups) + len(program.coupled.inputs) + k
    blocks = [program.known.values, *(group.values for group in program.groups)]
    blocks += [program.friction_values, program.coupled.values, program.known_rates]
    found = _blocks(blocks) + _products(rows * (n + m) + rows * given + n * (n + m))
    if program.rated:
        found += _products(rows * m)
    if program.layout["E"].rows:
        found += _products(n * m)
    found += _products(k * (n + 2 * m) + k * k + 2 * k * n + k * m + 2 * k)
    if program.varying:
        found += _blocks([program.coefficients]) + _solved(n, n + 2 * m)
        found += _products(rows * (n + 2 * m)) + (_hold(program) if k else Count())
    return found


def _solved(size: int, columns: int) -> Count:
    """A dense system in factors, and its solution for so many columns."""
    each = size * (size - 1) * (2 * size - 1) // 6 + size * size * columns
    return Count(each, each, size * (size - 1) // 2 + size * columns)


def _hold(program: Program) -> Count:
    """What holds one set of ports, all of them."""
    n, m, k = len(program.states), len(program.inputs), len(program.friction)
    found = _products(k * k * (n + 2 * m) + k * n * (n + 2 * m) + 3 * k * k * n)
    return found + _solved(n, k) + _solved(k, k) * 3


def _runge_kutta(size: int) -> tuple[Count, int]:
    """Stages, and what looks at the stability of a step."""
    stages = Count(2 * 3 * size + 3 * size, 3 * size + 4 * size)
    looks = Count(24 * size + 12 * size * size, 16 * size + 12 * size * size, 14 * size + 12, 24)
    return stages + looks, 6


def _rosenbrock(size: int, outside: int) -> tuple[Count, int]:
    """Slopes by differences, factors, six solutions; inputs along the parabola at each evaluation."""
    evaluations = 8 + size
    stages = Count(2 * 20 * size, 2 * 20 * size + 3 * size, 15)
    slopes = Count(16 * size, 2 * size * size + 9 * size, size * size + 8 * size + 8, 8)
    along = _products(8 * outside * evaluations)
    return stages + slopes + along + _solved(size, 6), evaluations


def _settling(program: Program) -> Count:
    """What decides that no port changes, at the start and at the end of a step."""
    n, m, k = len(program.states), len(program.inputs), len(program.friction)
    found = _blocks([program.friction_values]) * 2 + _products(k * (n + 2 * m) + k * k + 12 * k)
    return found + _products(2 * k * n) + _blocks([program.guards])


def _change(program: Program, pivots: int) -> Count:
    """One problem solved, and what holds in the mode that it finds."""
    n, m, k = len(program.states), len(program.inputs), len(program.friction)
    response = _solved(n, k) + _products(k * k * n + k * n)
    turn = _solved(k, 1) + _products(2 * k * k)
    return response + turn * pivots + _hold(program) + _products(k * n * (n + m))
