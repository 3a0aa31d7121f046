"""A bridge of ideal diodes between a source with inductance and a choke, against its phases."""

import shutil

import numpy as np
import pytest
from oracles.phases import Phase, follow
from references.build import bond_graph

import bondgraph as bg
from codegen import Sine, simulator

U, W, LS, L, R = 325.0, 100 * np.pi, 1e-3, 1e-2, 10.0


def _equations() -> bg.StateEquations:
    legs = {"d1": "a>j1>d1 j1>p", "d2": "b>j2>d2 j2>p", "d3": "a>d3", "d4": "b>d4"}
    signs = {"d1": ("", "-"), "d2": ("", "-"), "d3": ("-", ""), "d4": ("-", "")}
    nodes = [bg.Se("mains", "u"), *map(bg.One, ("src", "j1", "j2", "out")), bg.Zero("a"), bg.Zero("b"),
             bg.Zero("p"), bg.I("Ls", LS, flow="i_s"), bg.I("L", L, flow="i"), bg.R("R", R)]  # fmt: skip
    nodes += [bg.Sw(d, on=f"{e}e_{d}", off=f"{f}f_{d}") for d, (e, f) in signs.items()]
    bonds = "mains>src>Ls src>a b>src p>out out>L out>R " + " ".join(legs.values())
    return bg.derive(bond_graph(nodes, bonds))


EQUATIONS = _equations()

# x = i_s, i, u, u'/w. While the source's current turns, the choke's flows through the bridge alone, by three
# diodes, two of which change over as the source's passes through zero.
WAVE = [[0, 0, 0, W], [0, 0, -W, 0]]
OVERLAP = [[0, 0, 1 / LS, 0], [0, -R / L, 0, 0], *WAVE]


def _conducting(way: int) -> list[list[float]]:
    rate = [0, -R / (L + LS), way / (L + LS), 0]
    return [[way * entry for entry in rate], rate, *WAVE]


PHASES: dict[str, Phase] = {
    "forth": (_conducting(1), [([0, LS * R, L, 0], "turns back")]),
    "turns back": (OVERLAP, [([1, 0, 0, 0], "turned back")]),
    "turned back": (OVERLAP, [([1, 1, 0, 0], "back")]),
    "back": (_conducting(-1), [([0, LS * R, -L, 0], "turns forth")]),
    "turns forth": (OVERLAP, [([-1, 0, 0, 0], "turned forth")]),
    "turned forth": (OVERLAP, [([-1, 1, 0, 0], "forth")]),
}


@pytest.mark.parametrize("phase", [0.0, 0.001, 0.3, 1.0])
@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_it_commutates_at_any_phase(phase: float, backend: str) -> None:
    if backend == "c" and shutil.which("cc") is None:
        pytest.skip("needs a C compiler")
    times = np.linspace(0, 0.04, 401)
    start = np.array([0.0, 0.0, U * np.sin(phase), U * np.cos(phase)])
    expected, began = follow(PHASES, "forth", start, times, {})
    ready = simulator(EQUATIONS, {}, backend=backend)
    result = ready.run(times, inputs={"u": Sine(U, 50, phase=phase)}, rtol=1e-11, atol=1e-11)
    assert result["i_s"] == pytest.approx(expected[:, 0], abs=1e-7)
    assert result["i"] == pytest.approx(expected[:, 1], abs=1e-7)
    told = np.array([event.time for event in result.events])
    told = told[np.diff(told, prepend=-1.0) > 1e-8]
    assert told == pytest.approx([at for at, _ in began], abs=1e-9)
    assert len(began) >= 9
