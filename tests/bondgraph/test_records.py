"""What the package hands out cannot be changed afterwards, and was whole when it was made."""

import copy
import pickle
import random
from collections import ChainMap
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
from types import MappingProxyType
from typing import Any

import networkx as nx
import numpy as np
import pytest
import scipy.sparse as sps
import sympy as sp
from references.build import bond_graph
from references.cases import CASES
from references.frozen import changeable
from references.random_graphs import random_graph

import bondgraph as bg
from bondgraph.reduce.motion import Motion
from bondgraph.reduce.ports import reduce_ports
from bondgraph.reduce.record import Reading, ReadingSum
from bondgraph.reduce.resistances import resistive_groups

a, b = sp.symbols("a b")

Make = Callable[[], nx.DiGraph]


def _drive() -> nx.DiGraph:
    """Two states, a dependent storage, a loop of resistances, a law with a state, an open port."""
    nodes = [bg.Se("push", "P"), bg.One("near"), bg.I("m", "m", flow="v"), bg.R("rub", flow="slip"),
             bg.C("spring", "1/k", effort="F"), bg.TF("gear", "r"), bg.One("far"), bg.I("rotor", "J"),
             bg.C("bend", law="k_3*q_bend**3"), bg.R("air", "d"), bg.Zero("node"), bg.R("left", "d_1"),
             bg.R("right", "d_2")]  # fmt: skip
    bonds = "push>near>m near>spring near>gear>far>rotor near>rub far>bend far>air near>node>left node>right"
    return bond_graph(nodes, bonds)


def _moving() -> nx.DiGraph:
    """A pendulum on a crank: a ratio and a storage that change with an angle, and a detector."""
    nodes = [bg.Se("torque", "tau"), bg.One("shaft"), bg.I("wheel", "J + c*cos(phi)**2", flow="w"),
             bg.Df("angle", flow="w_s", integrate="phi"), bg.TF("crank", "1/(r*sin(phi))"), bg.One("rod"),
             bg.I("mass", "m"), bg.R("damper", "b")]  # fmt: skip
    return bond_graph(nodes, "torque>shaft>wheel shaft>angle shaft>crank>rod>mass rod>damper")


def _looped() -> nx.DiGraph:
    """Ratios in a ring, solved as a loop of bonds."""
    nodes = [bg.Se("e", "E"), bg.One("a"), bg.R("R", "R"), bg.TF("up", "m"), bg.Zero("b"), bg.C("c", "C"),
             bg.GY("round", "g"), bg.One("d"), bg.I("i", "L"), bg.TF("back", "n")]  # fmt: skip
    return bond_graph(nodes, "e>a>up>b>c a>R b>round>d>i d>back>a")


@pytest.mark.parametrize("make", [_drive, _moving, _looped])
def test_no_stage_hands_out_what_can_be_changed(make: Make) -> None:
    graph = make()
    causal = bg.assign_causality(graph)
    structure = bg.junction_structure(causal)
    assert structure.S.shape == (len(structure.ports),) * 2
    assert structure.places
    equations = bg.state_equations(structure)
    told = equations.with_readings(equations.signals)
    assert set(told.readings) > set(equations.readings)
    reduction = reduce_ports(structure)
    found = (causal, structure, equations, told, reduction, *resistive_groups(reduction))
    assert [changeable(record) for record in found] == [[]] * len(found)
    assert changeable(tuple(equations.bond(*bond) for bond in graph.edges)) == []


def test_no_stage_hands_out_what_can_be_changed_of_any_graph() -> None:
    found = [bg.derive(bond_graph(case.nodes, case.bonds)) for case in CASES.values()]
    for seed in range(12):
        with suppress(bg.CausalityError):
            found.append(bg.derive(random_graph(random.Random(seed), 12)))
    assert len(found) >= len(CASES) + 6
    assert [changeable(equations) for equations in found] == [[]] * len(found)


@pytest.mark.parametrize("make", [_drive, _moving])
def test_no_view_of_a_graph_can_be_changed(make: Make) -> None:
    graph = make()
    found = (bg.loops(graph), bg.assignments(graph), bg.explain(graph), bg.drawing(graph),
             bg.drawing(bg.assign_causality(graph)))  # fmt: skip
    assert [changeable(record) for record in found] == [[]] * len(found)


def test_no_linear_model_can_be_changed() -> None:
    model = bg.linearize(bg.derive(_drive()), {"q_bend": 1}, {"rub": "c*slip"})
    numbers = dict(zip(map(str, model.parameters), range(2, 99), strict=False))
    space = model.numeric(numbers)
    held = bg.linearize(bg.derive(_drive()), {"q_bend": 1}, stuck=["rub"])
    assert bg.explicit(bg.derive(_looped()))
    found = (model, space, space.modes(), held, bg.explicit(bg.derive(_looped())))
    assert [changeable(record) for record in found] == [[]] * len(found)
    with pytest.raises(ValueError, match="read-only"):
        space.P[0, 0] = 1.0


def test_nothing_can_be_put_into_a_record() -> None:
    equations, causal = bg.derive(_drive()), bg.assign_causality(_drive())
    with pytest.raises(TypeError, match="does not support item assignment"):
        equations.reduction.columns[99] = "x"  # type: ignore[index]
    with pytest.raises(TypeError, match="does not support item assignment"):
        next(iter(equations.readings.values())).F[0] = a  # type: ignore[index]
    with pytest.raises(TypeError, match="does not support item assignment"):
        equations.reduction.structure.rows[0][0] = a  # type: ignore[index]
    with pytest.raises(AttributeError, match="no attribute 'undo'"):
        causal.assignment.undo(0)  # type: ignore[attr-defined]


def test_a_reduction_is_whole_when_it_is_made() -> None:
    """Every port's column is there, and its values do not grow with what is asked later."""
    for make in (_drive, _moving, _looped):
        equations = bg.derive(make())
        ports = equations.reduction.structure.ports
        assert sorted(equations.reduction.columns) == list(range(len(ports)))
    motion = bg.derive(_moving()).reduction.motion
    assert isinstance(motion, Motion)
    assert set(map(str, motion.rates)) >= {"phi", "w", "tau"}


def test_a_reading_keeps_rows_of_its_own() -> None:
    row = {0: a}
    reading = Reading(row, {}, {}, {})
    row[0] = b
    assert dict(reading.F) == {0: a}


def test_a_sum_is_gathered_apart_from_the_readings_in_it() -> None:
    start = Reading({0: a}, {}, {}, {1: b})
    total = ReadingSum(start)
    before = total.whole()
    total.add(Reading({0: b, 2: a}, {3: b}, {0: a}, {1: a}), sp.Integer(2))
    total.add(start, sp.Integer(0))
    assert before == start == Reading({0: a}, {}, {}, {1: b})
    assert total.whole() == Reading(
        {0: a + 2 * b, 2: 2 * a}, {3: 2 * b}, {0: 2 * a}, {1: 2 * a + b}
    )
    total.add(total.whole(), sp.Integer(-1))
    assert total.whole() == ReadingSum().whole() == Reading({}, {}, {}, {})


@pytest.mark.parametrize("again", [copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))])
def test_a_reading_can_be_copied_and_pickled(again: Callable[[Any], Any]) -> None:
    pair = bg.derive(_drive()).bond("near", "gear")
    copied = again(pair)
    assert copied == pair
    assert changeable(copied) == []


@dataclass
class _Open:
    rows: list[int] = field(default_factory=list)


@dataclass(frozen=True)
class _Holds:
    part: object

    def kept(self) -> object:
        return self.part


@pytest.mark.parametrize(
    ("part", "told"),
    [
        ([1], "a list"), ({}, "a dict"), (MappingProxyType({"k": set()}), "a set"),
        ((1, (bytearray(),)), "a bytearray"), ((_Holds([]),), "a list"),
        (partial(max, [1]), "a list"), (np.zeros((2, 2))[0], "an array that can be written to"),
        (np.zeros(2), "an array that can be written to"), (_Open(), "a record that is not frozen"),
        (nx.DiGraph(), "a graph that is not frozen"), (sps.csr_array(np.eye(2)), "an array that can be"),
        (ChainMap(), "a mapping that is not read-only"), (_Holds([]).kept, "a list"),
    ],
)  # fmt: skip
def test_what_can_be_changed_is_found(part: object, told: str) -> None:
    """The walk itself."""
    assert told in changeable(_Holds(part))[0]
