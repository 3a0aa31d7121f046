"""C by hand that generated code is measured against: with tires all but linear it is the exact reference."""

import ctypes
import re
import shutil
from fractions import Fraction
from functools import reduce
from math import factorial

import numpy as np
import pytest
from references import fig11

from benchmarks import nonlinear
from benchmarks.floor import magic_floor

TIGHT, LIMIT = 1e-12, 1e-6
LINEAR = {**magic_floor.FIGURE, "D": 1e9}
"""So strong a tire that its torque is its slope times its slip, but for 1e-11 of it."""

SOME = np.linspace(4300.0, 17200.0, 19), np.linspace(600.0, 1400.0, 19)[::-1]
"""More runs than there are lanes."""

needs_compiler = pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("CFLAGS", "-O1 -std=c99 -Wall -Wextra -Wno-psabi -Werror")
        return magic_floor.build(tmp_path_factory.mktemp("floor"))


def test_weights_of_the_method_are_exact() -> None:
    """The integrals of (1 - x)^l / l! times the basis polynomials, in fractions."""
    text = (magic_floor.HERE / "magic_table.h").read_text(encoding="utf-8")
    rows = re.findall(r"^    \{(.*?)\},$", text, re.DOTALL | re.MULTILINE)
    found = [[float(word) for word in row.split(",") if word.strip()] for row in rows]
    count, terms = len(found), len(found[0])
    for j in range(count):
        others = [Fraction(i) for i in range(count) if i != j]
        basis = reduce(lambda p, i: _times(p, i / (i - j), 1 / (i - j)), others, [Fraction(1)])
        for power in range(terms):
            wanted = sum(
                c * Fraction(factorial(m), factorial(power + m + 1)) for m, c in enumerate(basis)
            )
            assert found[j][power] == float(wanted)


def _times(p: list[Fraction], constant: Fraction, slope: Fraction) -> list[Fraction]:
    """p (constant + slope x)."""
    low, high = [constant * c for c in p] + [Fraction(0)], [Fraction(0)] + [slope * c for c in p]
    return [a + b for a, b in zip(low, high, strict=True)]


@needs_compiler
@pytest.mark.parametrize("way", ["DOP853", "exponential", "at once"])
def test_linear_tires_give_the_exact_reference(library: ctypes.CDLL, way: str) -> None:
    k, torque = np.full(9, 8600.0), np.full(9, 1000.0)
    if way == "at once":
        runs = magic_floor.at_once(library, k, torque, True, LINEAR)
    else:
        tolerance = TIGHT if way == "DOP853" else magic_floor.EXPONENTIAL
        runs = magic_floor.one_by_one(library, k, torque, tolerance, True, LINEAR)
    expected = fig11.fig11()
    wanted = np.column_stack([expected.states, expected.tau_f, expected.omega_f])
    assert runs.rows is not None
    assert (np.abs(runs.rows - wanted) / np.ptp(wanted, axis=0)).max() < 1e-7
    assert runs.peak == pytest.approx(np.abs(expected.states[:, 2]).max(), rel=1e-8)
    assert (runs.events == 2).all()
    assert runs.lock == pytest.approx(expected.events[0][0], abs=1e-9)
    assert runs.last == pytest.approx(expected.events[1][0], abs=1e-8)


@needs_compiler
def test_magic_formula_tires_are_as_by_scipy(library: ctypes.CDLL) -> None:
    case = nonlinear.tires()
    hand = nonlinear.ByHand(case)
    states = hand.run(1e-11, 1e-11)
    wanted = states[:, [hand.names.index(name) for name in magic_floor.STATES]]
    numbers = np.array([8600.0]), np.array([1000.0])
    for tolerance in (TIGHT, magic_floor.EXPONENTIAL):
        rows = magic_floor.one_by_one(library, *numbers, tolerance, True).rows
        assert rows is not None
        assert nonlinear.errors(rows[0, :, : len(magic_floor.STATES)], wanted) < LIMIT


@needs_compiler
def test_all_ways_find_the_same(library: ctypes.CDLL) -> None:
    exact = magic_floor.one_by_one(library, *SOME, TIGHT, True)
    assert exact.rows is not None
    span = np.ptp(exact.rows, axis=1)[:, None]
    alone = magic_floor.one_by_one(library, *SOME, magic_floor.EXPONENTIAL, True)
    for found in (alone, magic_floor.at_once(library, *SOME, True)):
        assert found.rows is not None
        assert (np.abs(found.rows - exact.rows) / span)[:, :, :6].max() < LIMIT
        assert (found.events == exact.events).all()
        assert found.lock == pytest.approx(exact.lock, abs=1e-8, nan_ok=True)


def test_sources_keep_to_their_width() -> None:
    for source in magic_floor.HERE.glob("magic_*.[ch]"):
        lines = source.read_text(encoding="utf-8").splitlines()
        assert max(map(len, lines)) <= 100, source.name
