"""One derivation for all modes: each choice of held and free rows, against the mode derived alone."""

import itertools
from collections.abc import Iterable

import networkx as nx
import pytest
import sympy as sp
from references.random_switches import random_switched
from references.switched_modes import answers, determinant, of_the_mode, pencil
from soak.families import seeds

import bondgraph as bg

REFUSALS = (bg.CausalityError, bg.AlgebraicLoopError, bg.SingularStorageError)

RATES = [sp.Rational(k, 7) for k in (3, 5, 11, -13, 19, 23, -29, 31, 37, 41, 43, -47)]
"""Values of s: a polynomial of a lower degree than there are values is zero at all only if it is zero."""


def _own(graph: "nx.DiGraph[str]", on: Iterable[object]) -> bg.StateEquations | None:
    """The mode's own equations, None where it is refused."""
    try:
        return bg.derive(bg.in_mode(graph, on))
    except REFUSALS:
        return None


def _assert_one_motion(
    graph: "nx.DiGraph[str]", whole: bg.StateEquations, on: list[object]
) -> bool:
    """Whether the mode exists: then its poles, hidden ones too, and all answers are its own equations'."""
    held = [one for one in whole.switches if (one.held == "on") == (one.name in on)]
    own = _own(graph, on)
    # Both are polynomials of s, of no higher degree than there are states.
    rates = RATES[: 1 + max(len(one.states) for one in (whole, own or whole))]
    determinants = [determinant(pencil(whole, held, s)[0]) for s in rates]
    if own is None:
        assert not any(determinants), f"{on}: a mode with a motion is refused"
        return False
    alone = [determinant(s * own.A - own.J) for s in rates]
    assert [d == 0 for d in determinants] == [d == 0 for d in alone], f"{on}: other poles"
    ratios = {sp.cancel(d / e) for d, e in zip(determinants, alone, strict=True) if d != 0}
    assert len(ratios) == 1, f"{on}: other poles"
    s = next(s for s, d in zip(rates, determinants, strict=True) if d != 0)
    zero = {name for one in whole.switches for name in (one.port.given, one.port.received)}
    assert answers(whole, held, s) == of_the_mode(own, s, zero), f"{on}: other answers"
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
