"""Textbook cases, random runs and sweeps close their power balance to 1e-9 of the energy turned over."""

import numpy as np
import pytest
from oracles.audited import CLOSED, FAMILIES, Case, open_part, rectifying, textbook
from references.cases import CASES as TEXTBOOKS
from soak.families import seeds

from codegen import Result, balance, integral, work
from codegen.numbers.arrays import Array

SEEDS = {
    "linear": seeds("audits-linear"), "rubbing": seeds("audits-rubbing"),
    "turning": seeds("audits-turning"),
}  # fmt: skip
RANDOM = [(family, seed) for family, row in SEEDS.items() for seed in row]


@pytest.mark.parametrize(("family", "seed"), RANDOM)
def test_random_runs_close(family: str, seed: int) -> None:
    case = FAMILIES[family](seed)
    if case is not None:
        assert open_part(case.run()) < CLOSED


@pytest.mark.parametrize("seed", seeds("audits-rectifying"))
def test_networks_with_diodes_close(seed: int) -> None:
    assert open_part(rectifying(seed)) < CLOSED


@pytest.mark.parametrize("name", TEXTBOOKS)
def test_textbook_cases_close(name: str) -> None:
    result = textbook(name).run()
    assert open_part(result) < CLOSED
    audit = result.audit()
    assert np.isfinite([*audit.gave.values(), *audit.took.values(), *audit.lost.values()]).all()


ROUNDING = 1e-16
"""Of numbers near 1, which is all that is seen where nothing moves; work is a product of two."""

UNIT = 2.0**-53
"""The unit roundoff."""


def _at_rest(case: Case, result: Result) -> float:
    """What works are rounded to where friction holds all masses: none is known better.

    A rate's n terms, pushes over a mass, round by n units of themselves (Higham, Accuracy and
    Stability of Numerical Algorithms, 3.1); what is left of a slip's rate is taken out once more,
    and rounds alike. That speeds a mass up for the whole run, while a push works on it.
    """
    own = [str(state) for state in case.equations.states]
    masses = [float(case.equations.A[k, k]) for k, name in enumerate(own) if name in case.start]
    push = max(abs(result[name]).max() for name in case.inputs)
    rounded = ((len(own) + len(case.inputs)) * UNIT) ** 2
    return float(rounded * (push * np.ptp(case.times)) ** 2 / min(masses))


def _nodes(case: Case) -> list[object]:
    ports = case.equations.reduction.structure.ports
    return list(dict.fromkeys(port.element.owner or port.element.name for port in ports))


def _swept(case: Case, method: str) -> list[Array] | None:
    measures = {"open": balance(), **{f"work {node}": work(node) for node in _nodes(case)}}
    return case.swept({**measures, **{f"integral {s}": integral(s) for s in case.start}}, method)


def _check_swept(case: Case, found: list[Array]) -> None:
    """What C gives is what Python gives; near 1e-9 where both keep steps to the tolerance."""
    result, nodes, states = case.run(), _nodes(case), list(case.start)
    turned = result.audit().turned_over
    assert found[0] < CLOSED
    works = [result.work(node)[-1] for node in nodes]
    rounded = ROUNDING**2 if turned > ROUNDING else _at_rest(case, result)
    assert found[1 : 1 + len(nodes)] == pytest.approx(works, abs=2e-8 * turned + rounded)
    size = max(abs(result[state]).max() for state in states) * float(np.ptp(case.times))
    integrals = [result.integral(state)[-1] for state in states]
    assert found[1 + len(nodes) :] == pytest.approx(integrals, abs=1e-8 * size + ROUNDING)


@pytest.mark.parametrize(
    ("family", "seed", "method"),
    [("linear", 7, "auto"), ("rubbing", 1, "DOP853"), ("turning", 3, "auto")],
)
def test_sweeps_in_c_close(family: str, seed: int, method: str) -> None:
    """Both loops in C, exact and located."""
    case = FAMILIES[family](seed)
    assert case is not None
    found = _swept(case, method)
    assert found is not None
    _check_swept(case, found)


def test_a_work_that_is_off_by_a_millionth_is_found() -> None:
    """Where masses move; and where none does, a creep of 1e-14 m/s."""
    moving, resting = FAMILIES["rubbing"](1), FAMILIES["rubbing"](114)
    assert moving is not None
    assert resting is not None
    for case, add in ((moving, None), (resting, 1e-14)):
        found = _swept(case, "auto")
        assert found is not None
        _check_swept(case, found)
        works = np.array(found[1 : 1 + len(_nodes(case))])
        at = 1 + int(np.abs(works).argmax())
        found[at] = found[at] * (1 + 1e-6) if add is None else found[at] + add
        with pytest.raises(AssertionError):
            _check_swept(case, found)


@pytest.mark.parametrize("seed", seeds("audits-swept"))
def test_random_sweeps_in_c_close(seed: int) -> None:
    """Where the loop does such a run; what it leaves to others is run by itself."""
    case = FAMILIES[("rubbing", "linear", "turning")[seed % 3]](seed // 3)
    found = None if case is None else _swept(case, "auto" if seed // 3 % 2 == 0 else "DOP853")
    if case is not None and found is not None:
        _check_swept(case, found)
