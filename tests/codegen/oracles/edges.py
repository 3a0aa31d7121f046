"""Models with a size that is zero, and small ones of every kind: what code must not trip over."""

from collections.abc import Callable, Mapping

import networkx as nx
from references.build import bond_graph
from references.cases import CASES

import bondgraph as bg
import codegen
from oracles.units import Case, belt, divider, duffing


def _case(
    nodes: list, bonds: str, numbers: Mapping[str, float], outputs: list | None = None, **more
) -> Case:
    equations = bg.derive(bond_graph(nodes, bonds), outputs)
    return Case(
        equations,
        numbers,
        None,
        more.get("initial", {}),
        more.get("inputs", {}),
        more.get("end", 2.0),
    )


def brake() -> Case:
    """No states: a brake on a shaft whose speed is imposed."""
    nodes = [bg.Sf("w", "w"), bg.One("j"), bg.R("br", law=bg.DryFriction("10"), effort="tau")]
    return _case(nodes, "w>j>br", {}, inputs={"w": codegen.Sampled([0, 2], [-1, 1])})


def brakes() -> Case:
    """No states, two ports whose slips one source rules, one of them told by a law."""
    nodes = [
        bg.Sf("w", "w"), bg.One("j"), bg.R("one", law=bg.DryFriction("h"), effort="e_1"),
        bg.TF("gear", "2"), bg.One("k"), bg.R("other", law=bg.DryFriction("3", "1 + slip**2")),
    ]  # fmt: skip
    inputs = {"w": codegen.Sine(1.0, 0.7), "h": codegen.Step(1.0, 2.0)}
    return _case(nodes, "w>j>one j>gear>k>other", {}, inputs=inputs)


def resistor() -> Case:
    """No states and no port: a source on a resistance."""
    nodes = [bg.Se("s", "V"), bg.One("j"), bg.R("r", "R")]
    return _case(nodes, "s>j>r", {"R": 2.0}, ["r"], inputs={"V": codegen.Sine(1.0, 1.0)})


def constant() -> Case:
    """No states, inputs, parameters or ports: a known source on a resistance of one."""
    return _case([bg.Se("s", "10"), bg.One("j"), bg.R("r", "1")], "s>j>r", {}, ["r"])


def free() -> Case:
    """No inputs, outputs, ports or laws: a mass on a spring."""
    nodes = [bg.One("j"), bg.I("m", "m", flow="v"), bg.C("s", "1/k", effort="F")]
    return _case(nodes, "j>m j>s", {"m": 1.0, "k": 40.0}, [], initial={"v": 1.0})


def wound() -> Case:
    """No states but a law's own: a hardening spring whose end is moved."""
    nodes = [bg.Sf("w", "w"), bg.One("j"), bg.C("s", law="k*q_s + q_s**3")]
    return _case(nodes, "w>j>s", {"k": 3.0}, [], inputs={"w": codegen.Sine(1.0, 1.0)})


def wound_brake() -> Case:
    """No states but a law's own, and a friction port whose slip a source rules."""
    nodes = [
        bg.Sf("w", "w"), bg.One("j"), bg.C("s", law="k*q_s + q_s**3"),
        bg.R("rub", law=bg.DryFriction("h")),
    ]  # fmt: skip
    inputs = {"w": codegen.Sine(1.0, 1.0), "h": 2.0}
    return _case(nodes, "w>j>s j>rub", {"k": 3.0}, [], inputs=inputs)


def rubbing() -> Case:
    """No inputs, one port, without parameters: a mass on a spring that rubs."""
    nodes = [
        bg.One("j"), bg.I("m", "1", flow="v"), bg.C("s", "1/40", effort="F"),
        bg.R("rub", law=bg.DryFriction("1/2")),
    ]  # fmt: skip
    return _case(nodes, "j>m j>s j>rub", {}, [], initial={"v": 1.0})


def stiff() -> Case:
    """Time constants far apart, a law that is not affine: implicit steps."""
    nodes = [
        bg.Se("P", "P"), bg.One("j"), bg.I("m", "1/100", flow="v"),
        bg.R("r", law="c*v_r + v_r**3", flow="v_r"), bg.C("s", "1/k", effort="F"),
    ]  # fmt: skip
    return _case(nodes, "P>j>m j>r j>s", {"c": 2e2, "k": 10.0}, [], inputs={"P": 1.0}, end=0.01)


EDGES: Mapping[str, Callable[[], Case]] = {
    made.__name__: made
    for made in (brake, brakes, resistor, constant, free, wound, wound_brake, rubbing, stiff)
}

KINDS: Mapping[str, Callable[[], Case]] = {made.__name__: made for made in (duffing, belt, divider)}


def textbook(name: str) -> Case:
    """A textbook case: parameters between 1/2 and 2, inputs that move."""
    case = CASES[name]
    graph: nx.DiGraph = bond_graph(case.nodes, case.bonds)
    equations = bg.derive(graph, list(case.outputs) or None)
    names = [symbol.name for symbol in equations.parameters]
    numbers = {key: 0.5 + 1.5 * (at + 1) / (len(names) + 1) for at, key in enumerate(names)}
    moving = (codegen.Sine(1.0, 0.3), codegen.Step(0.4, 1.0), 1.0)
    inputs = {str(u): moving[at % 3] for at, u in enumerate(equations.inputs)}
    return Case(equations, numbers, None, {}, inputs, 1.0)


def every() -> dict[str, Callable[[], Case]]:
    """All of them by name."""
    from functools import partial

    return {**EDGES, **KINDS, **{name: partial(textbook, name) for name in CASES}}
