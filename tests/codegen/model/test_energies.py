"""Storages whose energy is not positive run, and are told by name where numbers are bound."""

import warnings
from collections.abc import Callable

import numpy as np
import pytest
from references.build import bond_graph

import bondgraph as bg
from codegen import Family, final, simulator, sweep, switched_simulator, to_c, to_python


def _oscillator() -> bg.StateEquations:
    nodes = [
        bg.One("j"),
        bg.I("mass", "m", flow="v"),
        bg.C("spring", "1/k", effort="F"),
        bg.R("damper", "b"),
    ]
    return bg.derive(bond_graph(nodes, "j>mass j>spring j>damper"))


GOOD = {"m": 2.0, "k": 8.0, "b": 1.0}
WAYS: dict[str, Callable[[dict], object]] = {
    "numpy": lambda numbers: simulator(_oscillator(), numbers),
    "c": lambda numbers: simulator(_oscillator(), numbers, backend="c"),
    "family": lambda numbers: Family(_oscillator(), numbers).program,
    "to_c": lambda numbers: to_c(_oscillator(), numbers),
    "to_python": lambda numbers: to_python(_oscillator(), numbers),
}


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize(("change", "name"), [({"m": -2.0}, "mass"), ({"k": -8.0}, "spring")])
def test_a_negative_mass_or_stiffness_is_told_by_name(way: str, change: dict, name: str) -> None:
    with pytest.warns(
        bg.ModelWarning, match=f"the energy stored in '{name}' is not positive"
    ) as told:
        WAYS[way](GOOD | change)
    assert len(told) == 1
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        WAYS[way](GOOD)


def test_it_is_run_all_the_same() -> None:
    """``m v' = -F - b v``, ``F' = -k v``: with k = -8 and b = 0 it grows as cosh(2 t)."""
    with pytest.warns(bg.ModelWarning, match="'spring'"):
        run = simulator(_oscillator(), {"m": 2.0, "k": -8.0, "b": 0.0})
    result = run.run([0.0, 1.0], {"v": 1.0})
    assert result["v"][1] == pytest.approx(np.cosh(2.0), rel=1e-9)


def test_a_field_is_judged_as_a_whole() -> None:
    """Two coils whose mutual inductance is larger than their own: a current gives energy away."""
    nodes = [bg.Se("u", "u"), bg.One("a"), bg.R("R", "R"), bg.One("b"), bg.R("S", "R"),
             bg.I("coils", [["L", "M"], ["M", "L"]], ports=["p", "s"])]  # fmt: skip
    graph = bond_graph(nodes, "u>a>R b>S")
    graph.add_edge("a", "coils", port="p")
    graph.add_edge("b", "coils", port="s")
    equations = bg.derive(graph)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        simulator(equations, {"R": 1, "L": 2, "M": 1.9})
    with pytest.warns(bg.ModelWarning, match="the energy stored in 'coils' is not positive"):
        simulator(equations, {"R": 1, "L": 2, "M": 2.1})


def test_a_sweep_warns_once() -> None:
    family = Family(_oscillator(), GOOD | {"k": -1.0})
    runs, measures = {"b": [1.0, 2.0, 3.0]}, {"v": final("v")}
    with pytest.warns(bg.ModelWarning, match="'spring'") as told:
        found = sweep(family, runs, [0.0, 0.1], measures, {"v": 1.0}, workers=1)
    assert not found.failed
    assert len([one for one in told if one.category is bg.ModelWarning]) == 1


def test_switched_models_warn_once() -> None:
    nodes = [
        bg.Se("u", 1),
        bg.One("j"),
        bg.Sw("k", on="t - 1"),
        bg.R("r", 1),
        bg.I("coil", "L", flow="i"),
    ]
    graph = bond_graph(nodes, "u>j>k j>r j>coil")
    with pytest.warns(bg.ModelWarning, match="'coil'") as told:
        switched_simulator(graph, {"L": -1.0})
    assert len(told) == 1
