"""What storages hold as starts of exported programs, at the parameters that these are given."""

import subprocess
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import networkx as nx
import pytest
from oracles.c_model import WARNED, compiled, written
from references.build import bond_graph

import bondgraph as bg
from codegen import to_c, to_python

Begins = Callable[..., dict[str, float]]
"""The states with which a run begins, from its initial values and parameters; `ValueError` by refusal."""

NUMBERS = {"m": 2.0, "k": 8.0, "a": 1.0, "b": 1.0, "c": 1.0}


def _graph() -> nx.DiGraph:
    """A mass on a spring, two coils as one field, and a mass whose law its friction has turned round."""
    # fmt: off
    nodes = [bg.One("j"), bg.I("m", "sqrt(m)*c", flow="v"), bg.C("k", "1/(k*c)"), bg.R("rub", "b"),
             bg.One("l"), bg.One("r"), bg.R("R_1", "1"), bg.R("R_2", "1"),
             bg.I("L", [["3", "c"], ["c", "2"]], ports=["l", "r"]),
             bg.One("n"), bg.I("h", law="p_h + a*p_h**3", flow="w"),
             bg.R("stick", law=bg.DryFriction("1")), *map(bg.Zero, "xyz"), *(bg.R(n, "1") for n in "XYZ")]
    # fmt: on
    graph = bond_graph(nodes, "j>m j>k j>rub l>R_1 r>R_2 n>h n>stick j>x>X x>l j>y>Y y>n j>z>Z z>r")
    graph.add_edge("l", "L", port="l")
    graph.add_edge("r", "L", port="r")
    return graph


def _in_python(scope: Mapping[str, Any]) -> Begins:
    def begins(start: Mapping[str, float], **parameters: float) -> dict[str, float]:
        found = scope["simulate"]([0.0, 1e-9], start, {}, parameters)
        return {name: float(found[name][0]) for name in scope["STATES"]}

    return begins


def _in_c(program: Path) -> Begins:
    def begins(start: Mapping[str, float], **parameters: float) -> dict[str, float]:
        words = [f"{name}={value!r}" for name, value in {**start, **parameters}.items()]
        done = subprocess.run(
            [program, "1e-9", "1e-9", *words], capture_output=True, text=True, check=False
        )
        if done.returncode:
            raise ValueError(done.stderr)
        head, row, *_ = done.stdout.splitlines()
        told = dict(zip(head.split(","), map(float, row.split(",")), strict=True))
        return {name: told[name] for name in ("v", "e_k", "f_L_l", "f_L_r", "w")}

    return begins


@pytest.fixture(scope="module", params=["python", "c"])
def begins(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Begins:
    equations = bg.derive(_graph())
    if request.param == "python":
        scope: dict[str, Any] = {}
        exec(to_python(equations, NUMBERS), scope)
        return _in_python(scope)
    folder = tmp_path_factory.mktemp("held")
    files = to_c(equations, NUMBERS, main=True)
    return _in_c(compiled(folder, written(folder, files), *WARNED, "-O0"))


def test_masses_and_springs_begin_by_the_values_of_the_run(begins: Begins) -> None:
    """v = p/(sqrt(m) c), e = k c q, w = p + a p^3."""
    found = begins({"p_m": 6.0, "q_k": 0.5, "p_h": 2.0}, m=9.0, a=2.0)
    assert (found["v"], found["e_k"], found["w"]) == pytest.approx((2.0, 4.0, 18.0))
    found = begins({"p_m": 3.0, "e_k": 1.0}, c=4.0)
    assert (found["v"], found["e_k"], found["w"]) == pytest.approx((3 / (4 * 2**0.5), 1.0, 0.0))


def test_a_field_begins_by_all_that_it_holds_or_by_its_other_states(begins: Begins) -> None:
    """3 l + r = 5, l + 2 r = 5: l = 1, r = 2."""
    for start in (
        {"p_L_l": 5.0, "p_L_r": 5.0}, {"p_L_l": 5.0, "f_L_r": 2.0}, {"p_L_l": 5.0, "f_L_l": 1.0},
    ):  # fmt: skip
        found = begins(start)
        assert (found["f_L_l"], found["f_L_r"]) == pytest.approx((1.0, 2.0))


@pytest.mark.parametrize(
    ("start", "name"),
    [
        ({"p_L_l": 5.0}, "p_L_l"),
        ({"p_L_l": 5.0, "f_L_l": 1.0, "f_L_r": 2.0}, "p_L_l"),
        ({"q_k": 1.0, "p_m": 1.0, "v": 2.0}, "p_m"),
        ({"p_h": 1.0, "w": 2.0}, "p_h"),
        ({"p_x": 1.0}, "p_x"),
    ],
)
def test_what_does_not_tell_a_state_is_refused_by_name(
    begins: Begins, start: dict[str, float], name: str
) -> None:
    with pytest.raises(ValueError, match=rf"{name}.* does not tell|called .*{name}"):
        begins(start)


def test_declared_starts_give_way_to_what_is_held() -> None:
    nodes = [bg.One("j"), bg.I("m", "m", flow="v", start=7.0), bg.R("b", "b")]
    scope: dict[str, Any] = {}
    exec(to_python(bg.derive(bond_graph(nodes, "j>m j>b")), NUMBERS), scope)
    assert scope["simulate"]([0.0, 1.0], {}, {})["v"][0] == 7.0
    assert scope["simulate"]([0.0, 1.0], {"p_m": 4.0}, {})["v"][0] == 2.0
