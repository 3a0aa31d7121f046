"""What equations state when they are shown, at an instant of which the simulator tells every number."""

import random
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import sympy as sp

import bondgraph as bg
from bondgraph.algebra.expressions import TIME
from bondgraph.show.powers import without_functions
from bondgraph.show.putting_in import closed
from bondgraph.show.statements import Statement, statements
from codegen import Constant, Result, Signal, Simulator, Sine, simulator
from codegen.modes.rates import rates
from codegen.numbers.lambdified import lambdified
from oracles.ruled import ruled_misfit

CLOSE, BY_PIECES, BY_DIFFERENCES = 1e-9, 1e-6, 1e-4
"""How far both sides may be apart, of their largest term; where runs take known sources, and so their
slopes, as smooth pieces; where one side holds a rate that differences tell."""

STEP, SETTLED = 1e-3, 1e-2
"""Seconds: between samples that tell a rate by differences; until switches have turned that do at once."""

SLOPE = np.array([-25, 48, -36, 16, -3]) / (12 * STEP)
"""The slope at the first of five samples, right for polynomials up to the fourth degree."""

DRAWS = 40
"""How often numbers are drawn until a model is defined at them: logarithms and roots are not everywhere."""

Numbers = Mapping[str, float]


@dataclass
class Instant:
    """The first of the last five samples of a run; names are looked up there, rates behind a stroke."""

    run: Result
    numbers: dict[str, float]
    within: float
    #: Rates that are told by differences.
    differences: set[str] = field(default_factory=set)

    def value(self, expr: sp.Expr) -> float:
        """An expression at the instant; raises `KeyError` for a name that nothing explains."""
        names = sorted(expr.free_symbols, key=str)
        return float(lambdified(names, expr)(*(self._number(name.name) for name in names)))

    def _number(self, name: str) -> float:
        if name not in self.numbers:
            plain = name.removesuffix("'")
            values = self.run[plain][-len(SLOPE) :]
            if plain != name:
                self.differences.add(name)
            self.numbers[name] = float(values[0] if plain == name else SLOPE @ values)
        return self.numbers[name]

    def misfit(self, one: Statement) -> str:
        """Both sides of a statement that differ, else nothing."""
        if one.ruled is not None:
            self.value(one.left)
            names = {name.name for name in one.left.free_symbols | one.reads}
            slopes = names | {f"{name}'" for name in names}
            loose = bool(slopes & self.differences)
            return ruled_misfit(one, self.value, BY_DIFFERENCES if loose else self.within)
        left, right = self.value(one.left), self.value(one.value)
        size = max([1.0, *(abs(self.value(factor * part)) for factor, part in one.right)])
        names = {name.name for name in one.left.free_symbols | one.value.free_symbols}
        within = BY_DIFFERENCES if names & self.differences else self.within
        held = abs(left - right) <= within * size
        return "" if held else f"{one.left} = {one.value}: {left!r} is not {right!r}"


def misfits(equations: bg.StateEquations, at: Instant) -> list[str]:
    """What is stated, and does not hold: beside the matrices, in their rows, with laws and sources put in."""
    equations = without_functions(equations)
    found = statements(equations)
    told = (*found.given, *found.rates, *found.kept, *closed(equations, found))
    return [text for one in told if (text := at.misfit(one))]


def misfits_somewhere(equations: bg.StateEquations, seed: int = 0) -> list[str]:
    """The same at numbers that are drawn."""
    return misfits(equations, instant(equations, random.Random(f"stated {seed}")))


def instant(
    equations: bg.StateEquations, rng: random.Random, parameters: Numbers | None = None
) -> Instant:
    """Numbers for every parameter that is not given, every state and input, and what a run makes of them.

    Inputs move; what laws alone read is a constant. All is of the size of 1, states at first are positive.
    """
    for draw in range(DRAWS):
        least = 0.3 if draw < DRAWS // 2 else -1.5
        given = parameters
        if given is None:
            given = {name: rng.uniform(0.3, 1.5) for name in _parameters(equations)}
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", bg.ModelWarning)
                return _begun(equations, simulator(equations, given), given, rng, least)
        except (bg.SimulationError, bg.ParameterError):
            if draw == DRAWS - 1:
                raise
    raise AssertionError


def _begun(
    equations: bg.StateEquations, ready: Simulator, parameters: Numbers, rng: random.Random, least: float
) -> Instant:  # fmt: skip
    t = rng.uniform(0.1, 1)
    states = {name: rng.uniform(least, 1.5) for name in ready.states}
    moving = {*map(str, equations.inputs)}
    signals: dict[str, Signal] = {
        name: Sine(rng.uniform(0.1, 0.2), rng.uniform(0.1, 0.3), rng.uniform(0, 6), offset=1)
        if name in moving
        else Constant(rng.uniform(0.3, 1.5))
        for name in ready.inputs
    }
    end = t + SETTLED if equations.switches else t
    times = end + STEP * np.arange(len(SLOPE))
    run = ready.run(times if end == t else [t, *times], states, signals)
    if any(event.time > end for event in run.events):
        raise bg.SimulationError("no rate is told across an event")
    told = {str(name): float(value) for name, value in parameters.items()}
    numbers = {TIME.name: end, **told, **{f"{name}'": 0.0 for name in told}}
    for name, signal in signals.items():
        numbers[name], numbers[f"{name}'"] = signal(end), signal.piece(end).derivative(end)
    if not equations.switches:
        slopes = _rates(ready, t, states, signals)
        numbers |= {f"{name}'": slope for name, slope in zip(states, slopes, strict=True)}
    return Instant(run, numbers, BY_PIECES if ready.closed.program.sources else CLOSE)


def _rates(
    ready: Simulator, t: float, states: Numbers, signals: Mapping[str, Signal]
) -> list[float]:
    """What `Simulator.rhs` tells, while inputs move."""
    moving = [*signals.values(), *ready.sources(t, t)]
    given = np.array([signal(t) for signal in moving])
    s = ready.vector(t, np.array([*states.values()]), given)
    before = ready.closed.program.before(())
    return [*map(float, rates(ready.closed, t, s, [one.piece(t) for one in moving], before))]


def _parameters(equations: bg.StateEquations) -> list[str]:
    """Every name that no signal, state or input has."""
    used = {*equations.parameters}
    read = [law.free_symbols for law in equations.laws.values()]
    read += [part.free_symbols for switch in equations.switches for part in switch.read]
    read += [start.free_symbols for start in equations.starts.values()]
    read += [part.free_symbols for late in equations.delays for part in (late.time, late.start)]
    known = {*equations.signals, *equations.states, *equations.inputs, *equations.further_states}
    known |= {*equations.held, TIME}
    return sorted({str(name) for name in used.union(*read)} - {str(name) for name in known})
