"""What equations state when they are shown, put beside what the simulator computes: both sides are equal.

Of random graphs with laws, moving values and tables: every statement beside the matrices, every row of the
matrices, and every equation with laws and sources put in; and nothing in them is left unexplained.
"""

import random
import warnings

import pytest
import sympy as sp
from references.nonlinear.drawn import Drawn, drawn
from soak.families import seeds

import bondgraph as bg
from bondgraph.algebra.expressions import TIME
from bondgraph.show.putting_in import closed
from bondgraph.show.statements import statements
from bondgraph.show.sums import rate
from codegen import Simulator, Sine, simulator
from codegen.numbers.lambdified import lambdified

CLOSE = 1e-9


class Instant:
    """Numbers of every name at one instant of a run."""

    def __init__(self, ready: Simulator, made: Drawn, rng: random.Random) -> None:
        t = rng.uniform(0, 2)
        self.ready, self.numbers = ready, {TIME: t}
        signals = {
            name: Sine(rng.uniform(0.5, 2), rng.uniform(0.3, 1), rng.uniform(0, 6))
            for name in ready.inputs
        }
        states = {name: rng.uniform(-1, 1) for name in ready.states}
        # Inputs that are held from here on: rates of what they drive are those of the simulator's.
        held = {name: signal(t) for name, signal in signals.items()}
        self.run = ready.run([t, t + 1e-9], states, held)
        rates = ready.rhs(t, list(states.values()), list(held.values()))
        for name, value in made.parameters.items():
            self.numbers[sp.Symbol(str(name))] = float(value)
        for name, value, slope in zip(states, states.values(), rates, strict=True):
            self.numbers[sp.Symbol(name)], self.numbers[rate(sp.Symbol(name))] = value, slope
        for name, value in held.items():
            self.numbers[sp.Symbol(name)], self.numbers[rate(sp.Symbol(name))] = value, 0.0

    def value(self, expr: sp.Expr) -> float:
        """An expression at the instant; raises `KeyError` for a name that nothing explains."""
        names = sorted(expr.free_symbols, key=str)
        return float(lambdified(names, expr)(*map(self._number, names)))

    def _number(self, name: sp.Symbol) -> float:
        if name not in self.numbers:
            self.numbers[name] = float(self.run[name.name][0])
        return self.numbers[name]


@pytest.mark.parametrize("seed", seeds("whole-equations"))
def test_what_is_stated_is_what_the_simulator_computes(seed: int) -> None:
    rng = random.Random(f"whole {seed}")
    made = drawn(rng, rng.randint(4, 12))
    try:
        equations = bg.derive(made.graph, outputs=[], inputs=made.inputs)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", bg.ModelWarning)
            instant = Instant(simulator(equations, made.parameters), made, rng)
    except bg.BondGraphError:
        return
    found = statements(equations)
    for one in (*found.given, *found.rates, *closed(equations, found)):
        left, right = instant.value(one.left), instant.value(one.value)
        size = max(1.0, *(abs(instant.value(factor * s)) for factor, s in one.right or [(0, 0)]))
        assert abs(left - right) < CLOSE * size, (one.left, one.value)
