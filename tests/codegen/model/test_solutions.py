"""Laws of a signal in itself with several solutions: told once, by name, with the one that runs take."""

import re
import warnings
from collections.abc import Callable, Mapping

import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph

import bondgraph as bg
from codegen import (
    Family,
    final,
    simulator,
    sweep,
    switched_simulator,
    to_c,
    to_python,
    trim,
    write_fmu,
)
from codegen.model.real_roots import roots_of
from codegen.model.solutions import _slope


def _graph() -> object:
    nodes = [
        bg.Se("F", "F"), bg.One("j"), bg.I("m", "m", flow="v"), bg.C("k", "1/k", effort="F_k"),
        bg.R("b", "b"),
    ]  # fmt: skip
    return bond_graph(nodes, "F>j>m j>k j>b")


def _mass() -> bg.StateEquations:
    return bg.derive(_graph())


NUMBERS = {"m": 2.0, "k": 800.0, "b": 4.0}
TIMES = np.linspace(0.0, 0.1, 3)


def _swept(laws: dict, backend: str) -> object:
    family = Family(_mass(), NUMBERS, laws, backend)
    grid = {"k": [400.0, 800.0, 900.0]}
    return sweep(family, grid, TIMES, {"F": final("F")}, workers=0, progress=False)


WAYS: Mapping[str, Callable[[dict, object], object]] = {
    "numpy": lambda laws, path: simulator(_mass(), NUMBERS, laws).run(TIMES),
    "c": lambda laws, path: simulator(_mass(), NUMBERS, laws, "c").run(TIMES),
    "trim": lambda laws, path: trim(simulator(_mass(), NUMBERS, laws)),
    "sweep": lambda laws, path: _swept(laws, "numpy"),
    "sweep in c": lambda laws, path: _swept(laws, "c"),
    "to_c": lambda laws, path: to_c(_mass(), NUMBERS, laws),
    "to_python": lambda laws, path: to_python(_mass(), NUMBERS, laws),
    "write_fmu": lambda laws, path: write_fmu(path / "unit.fmu", _mass(), NUMBERS, laws),
}


@pytest.mark.parametrize("way", WAYS)
def test_every_way_out_tells_it_once(way: str, tmp_path: object) -> None:
    with pytest.warns(
        bg.ModelWarning,
        match=r"'F' gives F from itself, with 2 real solutions, F = -1, 2; .*F = -1\)",
    ) as told:
        WAYS[way]({"F": "F**2 - 2"}, tmp_path)
    assert [one.filename for one in told] == [__file__]


def test_a_model_with_switches_tells_it_once_for_all_modes() -> None:
    graph = _graph()
    graph.add_nodes_from([bg.Zero("z"), bg.Sw("s", on="t - 1/20"), bg.R("c", 3)])
    graph.add_edges_from([("j", "z"), ("z", "s"), ("z", "c")])
    with pytest.warns(bg.ModelWarning, match="2 real solutions, F = -1, 2") as told:
        result = switched_simulator(graph, NUMBERS, {"F": "F**2 - 2"}).run(TIMES)
    assert [event.kind for event in result.events] == ["on"]
    assert [one.filename for one in told] == [__file__]


# Solutions by hand: of F = F^3, of F (F^2 - 3 F + 1) = 0 and of sin F = F/2, and of F = 2/(1 + F).
TOLD = {
    "F**2": ("2", "", [0, 1]),
    "F**3": ("3", "", [-1, 0, 1]),
    "1.5*F**2 - 0.5": ("2", "", [-1 / 3, 1]),
    "2*b*F**2 - 10": ("2", "", [(1 - np.sqrt(321)) / 16, (1 + np.sqrt(321)) / 16]),
    "3*F**2 - F**3": ("3", "", [0, (3 - np.sqrt(5)) / 2, (3 + np.sqrt(5)) / 2]),
    "2/(1 + F)": ("2", "", [-2, 1]),
    "sqrt(2)*F**2 - F": ("2", "", [0, np.sqrt(2)]),
    "F**2 - v": ("2", " where v = 0", [0, 1]),
    "v*F**2": ("2", " where v = 1", [0, 1]),
    "F**2 + v*F_k": ("2", " where F_k = 0 and v = 0", [0, 1]),
    "F**2 + sin(t)": ("2", " where t = 0", [0, 1]),
    "2*sin(F)": (
        "at least 3",
        " between -100 and 100",
        [-1.8954942670339809, 0, 1.8954942670339809],
    ),
    # W(-exp(-2)): F + 2 = exp(F).
    "exp(F) - 2": (
        "at least 2",
        " between -100 and 100",
        [-1.8414056604369606, 1.1461932206205825],
    ),
    "2*Abs(F) - 3": ("at least 2", " between -100 and 100", [-1, 3]),
}


@pytest.mark.parametrize("law", TOLD)
def test_how_many_there_are_and_which_one_is_taken(law: str) -> None:
    """The one that is told to be taken is the one that a run takes: at rest, where the warning looks."""
    count, where, solutions = TOLD[law]
    with pytest.warns(bg.ModelWarning) as told:
        ready = simulator(_mass(), NUMBERS, {"F": law})
    (text,) = [str(one.message) for one in told]
    listed = ", ".join(f"{value:.6g}" for value in solutions)
    assert f"with {count} real solutions{where}, F = {listed}; taken is" in text
    start = {"v": 1.0} if law.startswith("v*") else {}
    taken = ready.run([0.0, 1e-9], start)["F"][0]
    assert float(re.findall(r"\(F = (.*)\)", text)[0]) == pytest.approx(taken, rel=1e-5, abs=1e-6)
    assert min(abs(taken - one) for one in solutions) < 1e-6


@pytest.mark.parametrize(
    "law",
    ["F/2 + v", "v - F**3", "v - F*Abs(F)", "v - atan(F)", "F**2 + 1 + v**2", "F**2 + 1/4", "-F/3",
     "v**2 - 5*F", "exp(-F)", "2*sign(F - 1) - 3*F"],
)  # fmt: skip
def test_where_there_is_one_nothing_is_said(law: str) -> None:
    """Monotone laws; a double solution is one, and laws without a real solution have none to tell."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        simulator(_mass(), NUMBERS, {"F": law})


def test_a_law_by_way_of_a_resistance() -> None:
    """``f = e^2``, ``e = V - R f``: at V = 0 and R = 2 that is ``f = 4 f^2``."""
    nodes = [
        bg.Se("s", "V"),
        bg.One("n"),
        bg.R("r", 2),
        bg.R("port", law="e_port**2", gives="flow"),
    ]
    equations = bg.derive(bond_graph(nodes, "s>n>r n>port"), outputs=["port"])
    message = (
        r"'port' gives f_port from itself, with 2 real solutions where V = 0, f_port = 0, 0\.25;"
    )
    with pytest.warns(bg.ModelWarning, match=message):
        ready = simulator(equations, {})
    assert ready.run([0.0, 1.0], {}, {"V": 0.0})["f_port"][0] == 0.0


def test_laws_of_which_all_but_one_are_affine() -> None:
    """``e_a = e_b^2``, ``e_b = 2 - e_a`` + v: at v = 0 ``e_a = (2 - e_a)^2``, so 1 and 4."""
    nodes = [
        bg.One("n"),
        bg.I("m", 2, flow="v"),
        bg.R("a", law="e_b**2"),
        bg.R("b", law="2 - e_a + v"),
    ]
    equations = bg.derive(bond_graph(nodes, "n>m n>a n>b"))
    message = (
        r"'a', 'b' give e_a, e_b from one another, with 2 real solutions where v = 0, e_b = -2, 1;"
    )
    with pytest.warns(bg.ModelWarning, match=message):
        simulator(equations, {})


def test_a_stretch_of_solutions_is_more_than_one() -> None:
    with pytest.warns(
        bg.ModelWarning, match="with more than one real solution between -100 and 100;"
    ):
        simulator(_mass(), NUMBERS, {"F": "Abs(F)"})


def test_roots_are_counted_exactly() -> None:
    """Two that are 1e-15 apart are two, and none where they have just met: only rationals can tell."""
    x, off = sp.Symbol("x"), sp.Rational(1, 10**30)
    assert roots_of(x**2 - 2 * x + 1 - off, x).count == 2
    assert roots_of(x**2 - 2 * x + 1, x).count == 1
    assert roots_of(x**2 - 2 * x + 1 + off, x).count == 0
    assert roots_of((x**2 - 1) / (x - 1), x).values == (-1.0,)
    assert roots_of(x + sp.gamma(x), x) is None


def test_neither_poles_nor_jumps_are_roots() -> None:
    """Between -100 and 100 the tangent has 63 zeros and 64 poles; a sign leaps over zero."""
    x = sp.Symbol("x")
    assert roots_of(sp.tan(x), x).values == pytest.approx(np.pi * np.arange(-31, 32))
    assert roots_of(sp.sign(x - 3) + sp.Rational(1, 2), x).count == 0
    assert roots_of(sp.Abs(x) - 3 + x / 2, x).values == pytest.approx((-6.0, 2.0))


@pytest.mark.parametrize("seed", range(6))
def test_solutions_that_were_put_in_are_found(seed: int) -> None:
    """``F = F + 3 (F - r_1) (F - r_2) .. (F^2 + 1)``, one of them twice: a double solution is one."""
    rng = np.random.default_rng(seed)
    put = sorted({sp.Rational(int(n), 4) for n in rng.integers(-20, 20, 1 + seed % 4)})
    law = f"F + 3*(F**2 + 1)*(F - {put[0]})*" + "*".join(f"(F - ({r}))" for r in put)
    found = roots_of(sp.sympify(law) - sp.Symbol("F"), sp.Symbol("F"))
    assert found.values == pytest.approx([float(r) for r in put])
    if len(put) > 1:
        with pytest.warns(bg.ModelWarning, match=f"with {len(put)} real solutions, F = "):
            to_python(_mass(), NUMBERS, {"F": law})


@pytest.mark.parametrize(
    "law",
    ["v/F", "1/v + F**2", "atan2(F, v)", "F**v", "sqrt(F)", "log(F)", "tan(F) + 1", "sign(F)/2",
     "F**0.5 + v", "tanh(F)/v", "Min(F, v)/2", "sqrt(1 - F**2)", "exp(exp(F))", "exp(F/1e-3)"],
)  # fmt: skip
def test_laws_of_which_little_can_be_told_are_no_obstacle(law: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", bg.ModelWarning)
        assert simulator(_mass(), NUMBERS, {"F": law}).states == ("v", "F_k")


@pytest.mark.parametrize(
    "text",
    [
        "3",
        "u",
        "v",
        "2*u + v/3 - sin(v)",
        "-(2*u - 3*(v + u/5))/7",
        "pi*u + u*v",
        "u**2 + u",
        "abs(u) - u",
    ],
)
def test_a_slope_that_is_a_number_is_read_off(text: str) -> None:
    names = {name: sp.Symbol(name, real=True) for name in "uv"}
    law = sp.sympify(text, names)
    right = sp.diff(law, names["u"])
    assert _slope(law, names["u"]) == (right if right.is_number else None)
