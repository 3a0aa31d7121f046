"""A mass that pushes a ladder of resistances with laws that rise: loops of one solution, and what it is."""

from __future__ import annotations

import random
import re
from collections.abc import Callable
from dataclasses import dataclass

import networkx as nx
from scipy.optimize import brentq

import bondgraph as bg

from ..build import bond_graph
from .jets import FUNCTIONS

LAWS = (
    "{a}*x + {b}*x**3", "{a}*tanh({b}*x) + x/50", "{a}*tanh({b}*x)", "{a}*sinh({b}*x)",
    "{a}*(exp({b}*x) - 1)", "{a}*x + {b}*abs(x)*x", "{a}*atan({b}*x) + x/100", "{a}*x + {b}*x**5",
)  # fmt: skip
Function = Callable[[float], float]


@dataclass(frozen=True)
class Ladder:
    """Rungs from the mass on: whether the one across gives its effort, its law, and that of the one along."""

    push: float
    load: float
    rungs: tuple[tuple[bool, str, str], ...]

    def graph(self) -> nx.DiGraph[str]:
        """As a bond graph whose one state is the mass's speed ``f_m``."""
        nodes = [bg.Se("push", self.push), bg.One("o"), bg.I("m", 1), bg.Zero("z0")]
        bonds = "push>o>m o>z0"
        for k, (first, across, along) in enumerate(self.rungs):
            given = ("effort", "flow") if first else ("flow", "effort")
            for name, law, gives in ((f"p{k}", across, given[0]), (f"r{k}", along, given[1])):
                x = ("f_" if gives == "effort" else "e_") + name
                nodes.append(bg.R(name, law=re.sub(r"\bx\b", x, law), gives=gives))
            nodes += [bg.One(f"s{k}"), bg.Zero(f"z{k + 1}")]
            bonds += f" z{k}>p{k} z{k}>s{k}>r{k} s{k}>z{k + 1}"
        nodes.append(bg.R("load", self.load))
        return bond_graph(nodes, f"{bonds} z{len(self.rungs)}>load")

    def rate(self, speed: float) -> float:
        """How fast the mass gains speed: the push less the effort of the whole ladder."""
        return self.push - self._effort(0, speed)

    def _effort(self, k: int, flow: float) -> float:
        """The effort at a node of the ladder into which this flows: rung by rung, by bisection."""
        if k == len(self.rungs):
            return self.load * flow
        first, *texts = self.rungs[k]
        across, along = (_function(text) for text in texts)
        if first:
            on = _root(lambda f: f - along(across(flow - f) - self._effort(k + 1, f)))
            return across(flow - on)
        on = _root(lambda f: f + across(along(f) + self._effort(k + 1, f)) - flow)
        return along(on) + self._effort(k + 1, on)


def random_ladder(rng: random.Random) -> Ladder:
    """One to three rungs; slopes and loads over some powers of ten."""

    def law() -> str:
        return rng.choice(LAWS).format(a=rng.choice([0.1, 1, 10]), b=rng.choice([0.1, 0.5, 1, 3]))

    rungs = tuple((rng.random() < 0.5, law(), law()) for _ in range(rng.randint(1, 3)))
    return Ladder(rng.uniform(-500, 500), rng.choice([0.01, 1, 100]), rungs)


def _function(text: str) -> Function:
    code = compile(text, text, "eval")

    def called(x: float) -> float:
        try:
            return float(eval(code, {**FUNCTIONS, "x": x}))
        except OverflowError:
            return 1e250 if x > 0 or "sinh" not in text else -1e250

    return called


def _root(f: Function) -> float:
    """Of a function that rises."""
    wide = 1.0
    while f(-wide) > 0 or f(wide) < 0:
        wide *= 4
    return float(brentq(f, -wide, wide, xtol=1e-300, rtol=1e-15, maxiter=500))
