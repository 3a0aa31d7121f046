"""One derivation for all modes: every choice of held and free rows, against the derivation of that mode alone."""

import itertools
from collections.abc import Iterable, Mapping

import networkx as nx
import pytest
import sympy as sp
from references.random_switches import random_switched
from soak.families import seeds
from sympy.polys.matrices import DomainMatrix
from sympy.polys.matrices.exceptions import DMNonInvertibleMatrixError

import bondgraph as bg
from bondgraph.reduce.record import Reading

REFUSALS = (bg.CausalityError, bg.AlgebraicLoopError, bg.SingularStorageError)

RATES = [sp.Rational(k, 7) for k in (3, 5, 11, -13, 19, 23, -29, 31, 37, 41, 43, -47)]
"""Values of s at which a pencil of so many rows, less one, is not zero unless it is so everywhere."""

Answers = Mapping[sp.Symbol, Mapping[sp.Symbol, sp.Expr]]
"""Every signal per unit of every source and open port, at one complex frequency."""


def _pencil(
    equations: bg.StateEquations, held: Iterable[bg.SwitchPort], s: sp.Rational
) -> tuple[sp.Matrix, sp.Matrix, list[int]]:
    """``(s A - J) x - B_H u_H = (B + s E) v`` over ``F_H x + D_HH u_H = -(D_HK + s K_HK) v``, what is let go at 0."""
    switched = {equations.inputs.index(one.port.given) for one in equations.switches}
    columns = [equations.inputs.index(one.port.given) for one in held]
    driven = [j for j in range(len(equations.inputs)) if j not in switched]
    rows = [equations.readings[one.port.received] for one in held]
    n, h = len(equations.states), len(columns)
    left, right = sp.zeros(n + h, n + h), sp.zeros(n + h, len(driven))
    left[:n, :n] = s * equations.A - equations.J
    for at, j in enumerate(columns):
        left[:n, n + at] = -equations.B[:, j]
    for at, j in enumerate(driven):
        right[:n, at] = equations.B[:, j] + s * equations.E[:, j]
    for i, row in enumerate(rows, start=n):
        assert not row.H
        for j, entry in row.F.items():
            left[i, j] = entry
        for at, j in enumerate(columns):
            left[i, n + at] = row.D.get(j, 0)
        for at, j in enumerate(driven):
            right[i, at] = -row.D.get(j, 0) - s * row.K.get(j, 0)
    return left, right, [*columns, *driven]


def _determinant(left: sp.Matrix) -> sp.Expr:
    return sp.QQ.to_sympy(DomainMatrix.from_Matrix(left).convert_to(sp.QQ).det())


def _solved(left: sp.Matrix, right: sp.Matrix) -> sp.Matrix:
    one, other = (DomainMatrix.from_Matrix(m).convert_to(sp.QQ) for m in (left, right))
    try:
        return one.lu_solve(other).to_Matrix()
    except DMNonInvertibleMatrixError:
        pytest.fail("the pencil is singular where its determinant is not zero")


def _answers(
    equations: bg.StateEquations, held: Iterable[bg.SwitchPort], s: sp.Rational
) -> Answers:
    left, right, order = _pencil(equations, list(held), s)
    n, h = len(equations.states), left.rows - len(equations.states)
    found = _solved(left, right) if left.rows else sp.zeros(0, right.cols)
    driven = order[h:]
    result: dict[sp.Symbol, dict[sp.Symbol, sp.Expr]] = {name: {} for name in equations.signals}
    readings = {name: equations.reduction.reading(row) for name, row in equations.signals.items()}
    for at, source in enumerate(driven):
        u = {j: found[n + k, at] for k, j in enumerate(order[:h])} | {source: sp.Integer(1)}
        x = dict(enumerate(found[:n, at]))
        for name, row in readings.items():
            value = _at(row, x, u, s)
            result[name][equations.inputs[source]] = value
    return result


def _at(
    row: Reading, x: Mapping[int, sp.Expr], u: Mapping[int, sp.Expr], s: sp.Rational
) -> sp.Expr:
    total = sum((entry * x[j] for j, entry in row.F.items()), sp.Integer(0))
    total += sum(entry * u.get(j, 0) for j, entry in row.D.items())
    total += s * sum(entry * x[j] for j, entry in row.H.items())
    return total + s * sum(entry * u.get(j, 0) for j, entry in row.K.items())


def _own(graph: "nx.DiGraph[str]", on: Iterable[object]) -> bg.StateEquations | None:
    """The mode's own equations, None where it is refused."""
    try:
        return bg.derive(bg.in_mode(graph, on))
    except REFUSALS:
        return None


def _own_answers(equations: bg.StateEquations, s: sp.Rational, zero: set[sp.Symbol]) -> Answers:
    found = _answers(equations, [], s)
    return {
        name: {source: value for source, value in row.items() if source not in zero}
        for name, row in found.items()
    }


def _assert_one_motion(
    graph: "nx.DiGraph[str]", whole: bg.StateEquations, on: list[object]
) -> bool:
    """Whether the mode exists: then poles, hidden ones too, and all answers are those of its own equations."""
    held = [one for one in whole.switches if (one.held == "on") == (one.name in on)]
    determinants = [_determinant(_pencil(whole, held, s)[0]) for s in RATES]
    own = _own(graph, on)
    if own is None:
        assert not any(determinants), f"{on}: a mode with a motion is refused"
        return False
    ratios = {
        sp.cancel(mine / _determinant(s * own.A - own.J))
        for s, mine in zip(RATES, determinants, strict=True)
        if mine != 0
    }
    assert len(ratios) == 1, f"{on}: other poles"
    s = next(s for s, mine in zip(RATES, determinants, strict=True) if mine != 0)
    zero = {name for one in whole.switches for name in (one.port.given, one.port.received)}
    assert _answers(whole, held, s) == _own_answers(own, s, zero), f"{on}: other answers"
    return True


@pytest.mark.parametrize("seed", seeds("switched-modes"))
def test_every_mode_is_a_choice_of_rows(seed: int) -> None:
    graph = random_switched(seed)
    try:
        whole = bg.derive(graph)
    except REFUSALS:
        return
    names = [one.name for one in whole.switches]
    for k in range(len(names) + 1):
        for on in itertools.combinations(names, k):
            _assert_one_motion(graph, whole, list(on))


@pytest.mark.parametrize("seed", seeds("switched-columns"))
def test_no_switch_drives_a_dependent_storage(seed: int) -> None:
    """`derive` would refuse such a one by name; and no signal whatever shows the rate of what one gives."""
    try:
        equations = bg.derive(random_switched(seed))
    except REFUSALS:
        return
    columns = {equations.inputs.index(one.port.given) for one in equations.switches}
    assert columns
    assert not columns & {j for _, j in equations.E.todok()}
    for row in equations.signals.values():
        assert not columns & equations.reduction.reading(row).K.keys()


def test_the_slice_has_switches_beside_dependent_storages() -> None:
    """What the two tests above see: graphs of both causalities, with dependent storages and modes."""
    forms, dependent, modes = set(), 0, 0
    for seed in range(60):
        graph = random_switched(seed)
        try:
            whole = bg.derive(graph)
        except REFUSALS:
            continue
        forms |= {one.gives for one in whole.switches}
        dependent += bool(whole.reduction.dependent)
        modes += _own(graph, []) is not None
    assert forms == {"effort", "flow"}
    assert dependent >= 10
    assert modes >= 20
