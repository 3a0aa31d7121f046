"""Laws that determine one another at once: linear ones are solved, of others the equations are left."""

import random

import networkx as nx
import numpy as np
import pytest
import sympy as sp
from references.build import bond_graph
from references.random_graphs import random_graph
from scipy.optimize import fsolve
from soak.families import seeds

import bondgraph as bg
from codegen import simulator


def amplifier(gain: str) -> nx.DiGraph:
    """An inverting amplifier whose output is ``gain`` of what is left between its inputs."""
    nodes = [bg.Se("source", "u"), bg.One("in"), bg.R("R1", "R1"), bg.Zero("m", effort="v_m"),
             bg.One("back"), bg.Zero("pair"), bg.R("R2", "R2"), bg.C("C", "C", effort="v_f"),
             bg.Zero("o"), bg.Se("amp", gain)]  # fmt: skip
    return bond_graph(nodes, "source>in>R1 in>m>back>pair>R2 pair>C back>o amp>o")


u, v, a, R1, R2, C = sp.symbols("u v_f a R1 R2 C")


def test_an_amplifier_of_finite_gain_is_solved() -> None:
    """``v_f = v_m - v_o`` and ``v_o = -a v_m``, so that ``v_m = v_f/(1 + a)``."""
    found = bg.explicit(bg.derive(amplifier("-a*v_m")))
    assert not found.implicit
    assert sp.cancel(found[v] - ((u - v / (1 + a)) / R1 - v / R2) / C) == 0


def test_an_amplifier_of_finite_gain_has_the_transfer_function_of_its_nodes() -> None:
    """``v_m = (u/R1) / ((1 + a) (C s + 1/R2 + 1/(R1 (1 + a))))``."""
    model = bg.linearize(bg.derive(amplifier("-a*v_m")), outputs=["v_m"])
    s = sp.Symbol("s")
    right = 1 / R1 / (1 + a) / (C * s + 1 / R2 + 1 / (R1 * (1 + a)))
    assert sp.cancel(model.transfer_function()[0] - right) == 0


def test_an_amplifier_that_saturates_is_left_as_an_equation_by_name() -> None:
    found = bg.explicit(bg.derive(amplifier("-V*tanh(a*v_m/V)")))
    ((name, right),) = found.implicit.items()
    V = sp.Symbol("V")
    assert sp.simplify(right + V * sp.tanh(a * (v + name) / V)) == 0
    assert sp.cancel(found[v] - ((u - v - name) / R1 - v / R2) / C) == 0
    lines = str(found).splitlines()
    assert lines[1:] == ["nonlinear laws at once, left to be solved:", f"  {name} = {right}"]
    assert r"\text{nonlinear laws at once, left to be solved:}" in found.latex()
    assert r"\begin{aligned}" in found._repr_latex_()
    assert "implicit={" in repr(found)


def test_an_amplifier_without_a_solution_is_refused() -> None:
    """``v_o = v_m`` leaves v_m open, whatever v_f is."""
    with pytest.raises(
        bg.AlgebraicLoopError, match="'amp' determine one another at once and leave no"
    ):
        bg.explicit(bg.derive(amplifier("1*v_m")))


def test_what_is_linear_in_a_loop_with_a_nonlinear_law_is_solved() -> None:
    """Two resistances in series on a spring's rate: the linear one is put into the equation of the other."""
    nodes = [bg.Se("F", "F"), bg.One("j"), bg.I("m", "m", flow="v"), bg.Zero("z"),
             bg.R("first", law="a*f_first + e_second", gives="effort"),
             bg.R("second", law="f_second**3 + e_first/2", gives="effort")]  # fmt: skip
    found = bg.explicit(bg.derive(bond_graph([*nodes[:3], *nodes[4:]], "F>j>m j>first j>second")))
    w, F, m = sp.symbols("v F m")
    e2 = 2 * (w**3 + a * w / 2)
    assert not found.implicit
    assert sp.expand(found[w] - (F - a * w - 2 * e2) / m) == 0


@pytest.mark.parametrize("seed", seeds("explicit-laws"))
def test_random_laws(seed: int) -> None:
    """Rates are the simulator's, equations that are left being solved by scipy."""
    rng = random.Random(seed)
    graph = random_graph(rng, 8 + seed % 10, mesh=0.2)
    try:
        equations = bg.derive(graph, outputs=[])
        laws = _random_laws(equations, rng)
        found = bg.explicit(equations, laws)
    except bg.BondGraphError:
        return
    if not equations.states or not laws:
        return
    numbers = {name.name: 0.7 + random.Random(name.name).random() for name in equations.parameters}
    ready = simulator(equations, numbers, laws=laws)
    draw = np.random.default_rng(seed)
    x, given = draw.normal(size=len(ready.states)), draw.normal(size=len(ready.inputs))
    names = (*numbers, *ready.states, *ready.inputs, *(f"d_{name}" for name in ready.inputs))
    values = (*numbers.values(), *x, *given, *np.zeros(len(given)))
    point = dict(zip(map(sp.Symbol, names), values, strict=True))
    rates = _solved(found, point)
    assert rates == pytest.approx(list(ready.rhs(0.0, x, given)), rel=1e-7, abs=1e-9)


def _random_laws(equations: bg.StateEquations, rng: random.Random) -> dict[str, str]:
    """Laws over open ports, small enough that loops have one solution; each may read any signal."""
    signals = sorted(map(str, equations.signals))
    laws = {}
    for port in equations.ports:
        if port.element.kind.resists and rng.random() < 0.85:
            read = " + ".join([str(port.received), *rng.choices(signals, k=rng.randint(0, 1))])
            law = rng.choice(["({0})", "({0})/(1 + ({0})**2)"]).format(read)
            laws[str(port.element.name)] = f"{rng.choice([0.2, 0.3, -0.25])}*{law}"
    return laws


def _solved(found: bg.ExplicitRates, point: dict[sp.Symbol, float]) -> list[float]:
    """The rates at a point, where parts and equations that are left are solved in numbers."""
    unknowns = list(found.implicit)

    def known(values: np.ndarray) -> dict[sp.Symbol, float]:
        all_ = point | dict(zip(unknowns, map(float, values), strict=True))
        for name, part in found.where.items():
            all_[name] = float(part.xreplace(all_))
        return all_

    def left(values: np.ndarray) -> list[float]:
        at = known(values)
        return [float(right.xreplace(at)) - at[name] for name, right in found.implicit.items()]

    solution = fsolve(left, np.zeros(len(unknowns)), xtol=1e-13) if unknowns else np.zeros(0)
    return [float(rate.xreplace(known(solution))) for rate in found.values()]
