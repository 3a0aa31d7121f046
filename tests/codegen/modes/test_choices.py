"""What a run keeps of what it decided changes nothing: random converters, with it and without."""

import networkx as nx
import numpy as np
import pytest
from references.build import bond_graph
from soak.families import seeds

import bondgraph as bg
from codegen import Constant, Result, Sine, Step, simulator
from codegen.modes.choices import Choice, Choices
from codegen.modes.glances import Judged

BUCK = "src>s>q s>n>d n>l>L l>n2>c n2>r"
BOOST = "src>l>L l>n>q n>s>d s>n2>c n2>r"
TWO_WAYS = "src>s>q s>n>r n>l>d l>r1 l>n2>c n2>r2 back>n back>d2 back>r3"
"""What flows, flows through one diode or the other, as the source has its sign when the switch closes."""


def _graph(bonds: str, on: str) -> nx.DiGraph:
    """A switch that is told, and a diode or two."""
    diode = bg.Sw("d", on="-e_d", off="f_d") if bonds == BUCK else bg.Diode("d")
    nodes = [bg.Se("src", "E"), bg.One("s"), bg.Sw("q", on=on), bg.Zero("n"), diode, bg.One("l"),
             bg.I("L", "L", flow="i"), bg.Zero("n2"), bg.C("c", "C", effort="v"), bg.One("back"),
             bg.Diode("d2"), *(bg.R(f"r{k}", "R") for k in ("", 1, 2, 3))]  # fmt: skip
    names = set(bonds.replace(">", " ").split())
    return bond_graph([node for node in nodes if node[0] in names], bonds)


def _run(seed: int) -> Result:
    """40 periods of a converter; its current may die in each, and what it is fed with may turn."""
    rng = np.random.default_rng(seed)
    f = 10 ** rng.uniform(3, 4.5)
    numbers = {"L": 10 ** rng.uniform(-4.5, -2), "C": 10 ** rng.uniform(-6, -3)}
    numbers |= {"R": 10 ** rng.uniform(-0.3, 2.3), "w": 2 * np.pi * f, "a": rng.uniform(-0.9, 0.9)}
    on = ("sin(w*t) - a", "a - cos(w*t + 1/3)")[rng.integers(2)]
    fed = (24.0, Constant(10) + Step(13.3 / f, 5), Sine(20, f / 7.1, 0.2, 30))[rng.integers(3)]
    bonds = (BUCK, BOOST, TWO_WAYS)[seed % 3]
    if bonds == TWO_WAYS:
        fed = Sine(20, f / 5.7, 0.2)
    ready = simulator(bg.derive(_graph(bonds, on)), numbers)
    return ready.run(np.linspace(0, 40 / f, 93), inputs={"E": fed})


def _without(monkeypatch: pytest.MonkeyPatch, seed: int) -> Result:
    """The same with every mode looked at anew, beside bounds of its own."""
    with monkeypatch.context() as patch:
        patch.setattr(Choices, "again", lambda *_: None)
        patch.setattr(Judged, "generous", Judged.exact)
        return _run(seed)


@pytest.mark.parametrize("seed", seeds("converters"))
def test_runs_are_those_without_what_is_kept(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    kept, anew = _run(seed), _without(monkeypatch, seed)
    assert kept.events == anew.events
    assert len(kept.events) > 60
    for name in kept:
        assert kept[name].tolist() == anew[name].tolist()


def test_what_recurs_is_chosen_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a steady converter nearly all choices are those of the period before."""
    found = list[bool]()
    holds = Choice.holds

    def counted(self: Choice, *given: np.ndarray) -> bool:
        found.append(holds(self, *given))
        return found[-1]

    monkeypatch.setattr(Choice, "holds", counted)
    numbers = {"L": 1e-3, "C": 1e-4, "R": 5.0, "w": 4e4 * np.pi}
    ready = simulator(bg.derive(_graph(BUCK, "sin(w*t)")), numbers)
    run = ready.run(np.linspace(0, 5e-3, 3), {"i": 2.4, "v": 12.0}, {"E": 24.0})
    assert len(run.events) == 400
    assert sum(found) > 170
