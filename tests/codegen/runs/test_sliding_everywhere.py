"""Sliding in closed form in what is exported: C that locates, and units of either version and kind."""

import subprocess
from collections.abc import Callable, Mapping
from itertools import cycle
from pathlib import Path

import numpy as np
import pytest
from oracles.c_model import compiled, written
from oracles.relays import RELAYS, oscillating, two
from oracles.swings import Swings
from oracles.units import Case, ran

import codegen

pytestmark = pytest.mark.usefixtures("compiled_quickly")

EXACT, BY_IMPORTER = 1e-9, 1e-8
"""Of a range of 1 or more; where an importer locates, to some 1e-9 of a second."""

SAMPLES = 41

Known = Callable[[np.ndarray], Mapping[str, np.ndarray]]


def relay(name: str) -> tuple[Case, Known, float]:
    """A relay of first order, its run, and from when on that is known."""
    found = RELAYS[name]()
    end = found.slides + 1.0
    return (
        Case(found.equations, {}, None, found.start, found.inputs, end),
        found.known,
        found.slides,
    )


def spiral() -> tuple[Case, Known, float]:
    """Two relays that turn each other: each quarter turn is a third of the last, until 1/2 s."""
    model = two("-sign(x) + 2*sign(y)", "-sign(y) - 2*sign(x)")

    def known(t: np.ndarray) -> Mapping[str, np.ndarray]:
        return {name: np.zeros(len(t)) for name in ("x", "y")}

    return Case(model, {}, None, {"x": 0.0, "y": 1.0}, {}, 2.0), known, 0.5


def twist() -> tuple[Case, Known, float]:
    """A relay of second order beside one of first: swings that gather to rest."""
    swings = Swings(2.0, 1.0)
    case = Case(oscillating("2*sign(x) + sign(v_r)"), {}, None, {"x": 1.0}, {}, swings.rests + 1.0)
    return case, lambda t: {"x": swings.at(t)}, 0.0


MAKERS = {
    **{name: lambda name=name: relay(name) for name in ("sides", "thermostat", "cubic")},
    "spiral": spiral, "twist": twist,
}  # fmt: skip


VERSIONS = dict(zip(MAKERS, cycle(["3.0", "2.0"]), strict=False))
"""Of FMI, in turn."""


@pytest.fixture(params=MAKERS)
def name(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture
def made(name: str) -> tuple[Case, Known, float]:
    return MAKERS[name]()


def off(
    found: Mapping[str, np.ndarray], t: np.ndarray, made: tuple[Case, Known, float]
) -> dict[str, float]:
    """How far states are off what is known, where it is."""
    case, known, since = made
    late = t > since + 1e-2
    values = {name: value for name, value in known(t[late]).items() if name in case.initial}
    assert values
    return {name: np.abs(found[name][late] - value).max() for name, value in values.items()}


def test_exported_c_slides(made: tuple[Case, Known, float], tmp_path: Path) -> None:
    case = made[0]
    files = codegen.to_c(
        case.equations, {}, name="relay", main=True, initial=case.initial, inputs=case.inputs
    )
    program = compiled(tmp_path, written(tmp_path, files), "-O0")
    words = [
        program,
        *(repr(float(one)) for one in (case.end, case.end / (SAMPLES - 1))),
        "located",
    ]
    told = subprocess.run(words, capture_output=True, text=True, check=True).stdout.splitlines()
    rows = np.array([row.split(",") for row in told[1:]], dtype=float)
    found = dict(zip(told[0].removeprefix("# ").split(","), rows.T, strict=True))
    assert max(off(found, rows[:, 0], made).values()) < EXACT


def test_units_slide(name: str, made: tuple[Case, Known, float], tmp_path: Path) -> None:
    case = made[0]
    path, t = (
        case.written(tmp_path / "relay.fmu", VERSIONS[name]),
        np.linspace(0.0, case.end, SAMPLES),
    )
    for kind, near in (("CoSimulation", EXACT), ("ModelExchange", BY_IMPORTER)):
        found, _ = ran(path, kind, case, [*case.initial], SAMPLES)
        for state, far in off(found, t, made).items():
            assert far < near, (kind, state)
