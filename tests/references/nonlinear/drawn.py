"""Random graphs with laws, values that move, tables and fields, drawn over random structures."""

from __future__ import annotations

import random
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import count

import networkx as nx
import numpy as np

import bondgraph as bg
from bondgraph.nodes.elements import Element

from ..random_graphs import random_graph

METHODS = ("linear", "pchip", "akima", "bilinear", "bicubic")

RISING = (
    "{a}*x + {b}*x**3", "{a}*tanh({b}*x)", "{a}*sinh(x*{b}/2)", "{a}*(exp(x*{b}/3) - 1)",
    "{a}*x + {b}*abs(x)*x",
    "{a}*x + {b}*sign(x)*abs(x)**1.5", "{a}*atan({b}*x) + x/5", "{a}*x*sqrt(1 + {b}*x**2)",
    "{a}*x + {b}*max(x, 0)**2", "Piecewise(({a}*x, x > 0), ({b}*x, True))", "{a}*x/hypot(1, {b}*x)",
)  # fmt: skip
"""Laws that rise with x and vanish with it."""

TURNING = ("{a}*sinh({b}*x)", "{a}*(exp({b}*x) - 1)", "{a}*x", "2*x/{a}")
"""Those of storages that go either way."""

FACTORS = (
    "1 + sin({s})/3",
    "5/4 + tanh({s})/2",
    "1/(1 + {s}**2)",
    "exp({s}/4)",
    "sqrt(1 + {s}**2/2)",
)
"""What moves a value with a signal, above zero."""

OUTSIDE = ("load", "cos(2*t)")
"""What moves values from outside."""

SOURCES = ("{a}*sin({b}*t)", "{a}", "{a}*exp(-{b}*t)", "{a}*cos({b}*t + 1) - {b}/3")


@dataclass
class Drawn:
    """A graph, numbers of its parameters, and names in values that are inputs; ``signals`` move values."""

    graph: nx.DiGraph[str]
    rng: random.Random
    parameters: dict[str, float] = field(default_factory=dict)
    inputs: list[str] = field(default_factory=list)
    signals: list[str] = field(default_factory=list)
    serial: Callable[[], int] = field(default_factory=lambda: count().__next__)
    likely: float = 1.0
    gives: dict[str, str] = field(default_factory=dict)
    integral: set[str] = field(default_factory=set)
    driving: set[str] = field(default_factory=set)
    lawful: set[str] = field(default_factory=set)
    turned: set[str] = field(default_factory=set)
    free: set[str] = field(default_factory=set)

    def number(self) -> str:
        """A parameter, or a number as text."""
        value = self.rng.randint(3, 12) / self.rng.choice([4, 5, 6])
        if self.rng.random() < 0.4:
            name = f"v{self.serial()}"
            self.parameters[name] = value
            return name
        return repr(value)

    def filled(self, text: str, x: str) -> str:
        """A law of x with numbers in it."""
        return re.sub(r"\bx\b", f"({x})", text).format(a=self.number(), b=self.number())

    def factor(self, signals: list[str] | None = None) -> str:
        """A factor above zero that moves with a signal or two."""
        signals = signals or self.signals
        signal = self.rng.choice(signals)
        if self.rng.random() < 0.3:
            return self.table(signal, signals)
        return "(" + self.rng.choice(FACTORS).format(s=signal) + ")"

    @property
    def outside(self) -> list[str]:
        """Signals that nothing of the graph moves, and at times any."""
        known = self.rng.random() < self.likely
        return [s for s in self.signals if s in OUTSIDE] if known else self.signals

    @property
    def steady(self) -> list[str]:
        """Signals whose rates follow from states, and at times any."""
        if self.rng.random() > self.likely:
            return self.signals
        return [s for s in self.signals if s[0] not in "pqx" or s in self.free]

    def table(self, signal: str, signals: list[str] | None = None) -> str:
        """A look into a new table, of values above zero or rising through it."""
        rises = signals is None
        method = self.rng.choice(METHODS[:3] if rises else METHODS)
        draw = np.random.default_rng(self.rng.randrange(2**32))
        axes = [np.cumsum(draw.uniform(0.3, 0.9, 9)) for _ in range(1 + (method[0] == "b"))]
        axes = [axis - axis[4] + draw.uniform(-0.1, 0.1) for axis in axes]
        if rises:
            values = np.cumsum(draw.uniform(0.3, 1.2, 9))
            values -= np.interp(0.0, axes[0], values)
            outside = "extend"
        else:
            values = draw.uniform(0.7, 1.6, [len(axis) for axis in axes])
            outside = "hold"
        name = f"map{self.serial()}"
        new = bg.LookupTable(name, *axes, values, method=method, outside=outside)
        self.graph.graph.setdefault("tables", []).append(new)
        if len(axes) == 2:
            return f"{name}({signal}, {self.rng.choice(signals)})"
        return f"{name}({signal})"

    def law(self, x: str, texts: tuple[str, ...] = RISING) -> str:
        """A law that rises with x, at times with a factor that another signal moves."""
        if texts is RISING and self.rng.random() < 0.25:
            return self.table(x)
        text = self.filled(self.rng.choice(texts), x)
        if texts is RISING and self.rng.random() < 0.35:
            return f"({text})*{self.factor()}"
        return text


def drawn(rng: random.Random, bonds: int, likely: float = 0.95) -> Drawn:
    """A random graph of about so many bonds, whose elements have laws, moving values and tables.

    Its structure is one that has causality with linear elements. Each law gives what its port gives then, and
    is of a storage that is independent then, ``likely``; else whatever is drawn.
    """
    while True:
        made = _structure(rng, bonds)
        try:
            causal = bg.assign_causality(made.graph)
        except bg.BondGraphError:
            continue
        if causal.integral:
            break
    made.likely = likely
    graph, kinds = made.graph, dict(made.graph.nodes(data="kind"))
    made.gives = {name: "flow" if head == name else "effort"
                  for bond, head in causal.strokes.items() for name in bond}  # fmt: skip
    integral = {*map(str, causal.integral)}
    made.integral = {
        name
        for name in graph
        if kinds[name] in "IC" and (integral & {name, f"{name}.a", f"{name}.b"})
    }
    made.lawful = {
        name
        for name in graph
        if kinds[name] in "IC" and "ports" not in graph.nodes[name] and rng.random() < 0.35
    }
    _tell_driving(made, causal)
    _tell_signals(made)
    for name in list(graph):
        _give(made, name)
    values = [
        str(told.get("value")) for _, told in graph.nodes(data=True) if told["kind"][0] != "S"
    ]
    if any("load" in text for text in values):
        made.inputs.append("load")
    return made


def _structure(rng: random.Random, bonds: int) -> Drawn:
    """A graph of linear elements, with detectors and fields."""
    while True:
        graph = random_graph(rng, bonds, mesh=0.15, symbols=False)
        kinds = dict(graph.nodes(data="kind"))
        joined = [name for name, kind in kinds.items() if kind in ("Zero", "One")]
        # How an element is signed that is drawn into a two-port is tested elsewhere.
        if joined and not any(
            kinds[a] in "ICR" and kinds[b] in ("TF", "GY") for a, b in graph.edges
        ):
            break
    for _, told in graph.nodes(data=True):
        if told.pop("gives", None):
            told["value"] = 1
    made = Drawn(nx.DiGraph(graph), rng)
    _detect(made, joined)
    _join(made, "I")
    _join(made, "C")
    return made


def _tell_driving(made: Drawn, causal: bg.CausalGraph) -> None:
    """What drives dependent storages at once, and the integrals that nothing of them moves."""
    structure = bg.junction_structure(causal)
    ports = structure.ports
    dependent = {
        at for at, port in enumerate(ports) if port.element.kind.stores and not port.integral
    }
    for at in dependent:
        made.driving |= {_node(ports[k].element) for k in structure.rows[at]}
    for at, port in enumerate(ports):
        if port.element.integral is not None:
            read = structure.rows[at].keys()
            if all(ports[k].element.kind.stores and k not in dependent for k in read):
                made.free.add(str(port.element.integral))


def _node(element: Element) -> str:
    return str(element.name if element.owner is None else element.owner)


def _tell_signals(made: Drawn) -> None:
    """What may move values: integrals, states, an input and the time."""
    made.signals += OUTSIDE
    for name, told in made.graph.nodes(data=True):
        if told.get("integrate"):
            made.signals.append(told["integrate"])
        elif told["kind"] in "IC" and (name in made.integral or made.rng.random() > made.likely):
            # A law that drives a dependent storage is turned round: its state is what it gives.
            own = name in made.lawful and (
                name not in made.driving or made.rng.random() > made.likely
            )
            letter = {"I": "fp", "C": "eq"}[told["kind"]][own]
            made.signals += [f"{letter}_{name}{port}" for port in
                             [f"_{one}" for one in told.get("ports", ())] or [""]]  # fmt: skip


def _detect(made: Drawn, joined: list[str]) -> None:
    """One or two detectors with integrals."""
    for name in made.rng.sample(joined, min(len(joined), made.rng.randint(1, 2))):
        kind = "De" if made.graph.nodes[name]["kind"] == "Zero" else "Df"
        new = f"{kind}_{made.serial()}"
        made.graph.add_node(new, kind=kind, integrate=f"x_{new}")
        made.graph.add_edge(name, new)


def _join(made: Drawn, kind: str) -> None:
    """Now and then two storages of a kind at different junctions become one field."""
    graph, rng = made.graph, made.rng
    found = [name for name, one in graph.nodes(data="kind") if one == kind]
    ends = {name: next(iter({*graph.pred[name], *graph.succ[name]})) for name in found}
    if len(found) < 2 or rng.random() < 0.8:
        return
    pair = rng.sample(found, 2)
    if ends[pair[0]] == ends[pair[1]]:
        return
    field = f"{kind}f{made.serial()}"
    graph.add_node(field, kind=kind, ports=["a", "b"])
    for old, port in zip(pair, "ab", strict=True):
        edge = (field, ends[old]) if graph.has_edge(old, ends[old]) else (ends[old], field)
        graph.remove_node(old)
        graph.add_edge(*edge, port=port)
    graph.nodes[field]["value"] = [[2, 1], [1, 2]]


def _give(made: Drawn, name: str) -> None:
    """A node's value, law or energy."""
    told, rng = made.graph.nodes[name], made.rng
    kind, chance = told["kind"], rng.random()
    if kind in ("Se", "Sf"):
        if chance < 0.7:
            told["value"] = rng.choice(SOURCES).format(a=made.number(), b=made.number())
            if chance < 0.25:
                signals = made.outside if name in made.driving else made.signals
                told["value"] = f"({told['value']})*{made.factor(signals)}"
    elif "ports" in told:
        _give_field(made, name)
    elif kind in ("TF", "GY"):
        told["value"] = str(float(told["value"]))
        if chance < 0.4:
            signals = made.steady if made.driving else made.signals
            told["value"] = f"{told['value']}*{made.factor(signals)}"
    elif kind == "R":
        if chance < 0.5 and (name not in made.driving or rng.random() > made.likely):
            gives = (
                made.gives[name] if rng.random() < made.likely else rng.choice(["effort", "flow"])
            )
            told["gives"] = gives
            del told["value"]
            told["law"] = made.law(f"{'f' if gives == 'effort' else 'e'}_{name}")
        else:
            told["value"] = made.number() + (f"*{made.factor()}" if chance < 0.8 else "")
    elif kind in "IC":
        _give_storage(made, name, chance)


def _give_storage(made: Drawn, name: str, chance: float) -> None:
    told = made.graph.nodes[name]
    state = f"{'p' if told['kind'] == 'I' else 'q'}_{name}"
    if name in made.lawful:
        del told["value"]
        free = name in made.integral - made.driving or made.rng.random() > made.likely
        told["law"] = _own(made, state) if free else made.law(state, TURNING)
        made.turned |= set() if free else {name}
        return
    told["value"] = made.number() + (f"*{made.factor(made.steady)}" if chance < 0.5 else "")


def _own(made: Drawn, state: str) -> str:
    if made.rng.random() < 0.3:
        return made.table(state)
    return made.filled(made.rng.choice(RISING), state)


def _give_field(made: Drawn, name: str) -> None:
    told, rng = made.graph.nodes[name], made.rng
    if rng.random() < 0.5 or name not in made.integral - made.driving:
        first, second = made.number(), made.number()
        if rng.random() < 0.5:
            first += f"*{made.factor(made.steady)}"
        told["value"] = [[f"1 + {first}", "1/2"], ["1/2", f"{second} + 1"]]
        return
    a, b = (f"{'p' if told['kind'] == 'I' else 'q'}_{name}_{port}" for port in "ab")
    del told["value"]
    told["energy"] = (
        f"{a}**2/2 + ({a} + {b})**2/3 + {made.number()}*{b}**2 + {a}**4/8 + cosh({a} - {b})"
    )
