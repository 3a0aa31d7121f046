"""Models whose laws have corners, run branch by branch by scipy: each branch smooth, each corner an event.

Nothing of it is the code under test: rates are written out by hand, by the side of each corner.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy
import sympy as sp
from references.build import bond_graph

import bondgraph as bg

Array = np.ndarray
Rate = Callable[[float, Array, Array], Array]
Hung = Callable[[float, Array], Array]


def by_branches(
    rate: Rate, hung: Hung, start: Sequence[float], times: Array
) -> tuple[Array, list[float]]:
    """The states at some times, and when corners are crossed.

    ``rate``: of time, states and sides, 1 or -1; ``hung``: what corners hang on.
    """
    y, t, crossed = np.array(start, dtype=float), float(times[0]), list[float]()
    found = np.empty((len(times), len(y)))
    found[0], at = y, 1
    here = hung(t, y)
    ahead = hung(t + 1e-7, y + 1e-7 * rate(t, y, np.where(here >= 0, 1, -1))) - here
    sides = np.where(np.abs(here) > 1e-9, np.sign(here), np.where(ahead >= 0, 1, -1))
    while t < times[-1]:
        run = scipy.integrate.solve_ivp(
            rate, (t, times[-1]), y, "DOP853", dense_output=True, args=(sides.copy(),),
            events=[_falls(hung, k) for k in range(len(sides))], rtol=1e-12, atol=1e-14, max_step=0.1,
        )  # fmt: skip
        while at < len(times) and times[at] <= run.t[-1]:
            found[at], at = run.sol(times[at]), at + 1
        t, y = float(run.t[-1]), run.y[:, -1]
        for k, when in enumerate(run.t_events):
            sides[k] *= -1 if len(when) else 1
            crossed += when.tolist()
    return found, crossed


def _falls(hung: Hung, k: int) -> Callable[[float, Array, Array], float]:
    def above(t: float, y: Array, sides: Array) -> float:
        # A rounding beyond zero, so that the next branch does not begin with its own corner.
        return float(sides[k] * hung(t, y)[k] + 1e-13)

    above.terminal, above.direction = True, -1  # type: ignore[attr-defined]
    return above


@dataclass(frozen=True)
class Kink:
    """``slope * max(0, way * (z - place))``, more of what a spring or damper gives."""

    slope: float
    place: float
    way: int

    def law(self, z: sp.Symbol, form: int) -> sp.Expr:
        """The same in one of many ways to write it."""
        a, h = sp.Rational(str(self.slope)), sp.Rational(str(self.place))
        over = self.way * (z - h)
        forms = (
            a * sp.Max(0, over),
            -a * sp.Min(-over, 0),
            a * (sp.Abs(over) + over) / 2,
            sp.Piecewise((a * over, over > 0), (0, True)),
            sp.Piecewise((0, sp.Or(over <= 0, over < -1)), (a * over, True)),
            a * over * (1 + sp.sign(z - h) * self.way) / 2,
        )
        return forms[form % len(forms)]


@dataclass(frozen=True)
class Chain:
    """Masses one after the other, a spring and a damper before each; the first is shaken."""

    masses: tuple[float, ...]
    stiff: tuple[float, ...]
    damped: tuple[float, ...]
    springs: tuple[tuple[Kink, ...], ...]
    dampers: tuple[tuple[Kink, ...], ...]
    forms: tuple[int, ...]
    speeds: tuple[float, ...]
    shaken: tuple[float, float]

    @property
    def names(self) -> list[str]:
        """Speeds, then displacements of springs."""
        every = range(len(self.masses))
        return [*(f"v{i}" for i in every), *(f"q_s{i}" for i in every)]

    @property
    def initial(self) -> Mapping[str, float]:
        return dict(zip(self.names, self.speeds, strict=False))

    def equations(self) -> bg.StateEquations:
        """From a graph in which springs have displacements of their own, and dampers see their speeds."""
        nodes, bonds, forms = [bg.Se("shake", "F")], ["shake>n0"], iter(self.forms * 9)
        for i, mass in enumerate(self.masses):
            q, r = sp.Symbol(f"q_s{i}"), sp.Symbol(f"r{i}")
            spring = self.stiff[i] * q + sp.Add(*(k.law(q, next(forms)) for k in self.springs[i]))
            damper = self.damped[i] * r + sp.Add(*(k.law(r, next(forms)) for k in self.dampers[i]))
            nodes += [
                bg.One(f"n{i}"), bg.I(f"m{i}", mass, flow=f"v{i}"), bg.Zero(f"z{i}"), bg.One(f"g{i}"),
                bg.C(f"s{i}", law=spring), bg.R(f"d{i}", flow=f"r{i}", law=damper),
            ]  # fmt: skip
            bonds += [f"n{i}>m{i}", f"n{i}>z{i}>g{i}>s{i}", f"g{i}>d{i}"]
            bonds += [f"z{i}>n{i + 1}"] if i + 1 < len(self.masses) else []
        return bg.derive(bond_graph(nodes, " ".join(bonds)))

    def by_branches(self, times: Array) -> tuple[Array, list[float]]:
        """Every state at some times, and when corners are crossed."""
        n = len(self.masses)
        own = [(i, k) for i in range(n) for k in self.springs[i]]
        own += [(n + i, k) for i in range(n) for k in self.dampers[i]]

        def seen(y: Array) -> Array:
            v = y[:n]
            return np.concatenate([y[n:], v - np.append(v[1:], 0.0)])

        def hung(t: float, y: Array) -> Array:
            z = seen(y)
            return np.array([k.way * (z[i] - k.place) for i, k in own])

        def rate(t: float, y: Array, sides: Array) -> Array:
            z = seen(y)
            given = np.array([*self.stiff, *self.damped]) * z
            for side, (i, k) in zip(sides, own, strict=True):
                given[i] += k.slope * k.way * (z[i] - k.place) if side > 0 else 0.0
            force = given[:n] + given[n:]
            push = -force + np.append(0.0, force[:-1])
            push[0] += self.shaken[0] * np.sin(2 * np.pi * self.shaken[1] * t)
            return np.concatenate([push / np.array(self.masses), z[n:]])

        return by_branches(rate, hung, [*self.speeds, *[0.0] * n], times)


def random_chain(seed: int) -> Chain:
    """One to three masses; springs with up to two kinks, dampers with one or none."""
    draw = np.random.default_rng(seed)
    n = int(draw.integers(1, 4))

    def some(low: float, high: float, count: int = n) -> tuple[float, ...]:
        return tuple(np.round(draw.uniform(low, high, count), 3).tolist())

    def kinks(most: int, slope: float, place: float) -> tuple[Kink, ...]:
        return tuple(
            Kink(*some(0.1 * slope, slope, 1), *some(-place, place, 1), int(draw.choice([-1, 1])))
            for _ in range(int(draw.integers(0 if most < 2 else 1, most + 1)))
        )

    return Chain(
        some(0.5, 2.0), some(5.0, 30.0), some(0.0, 0.5),
        tuple(kinks(2, 200.0, 0.2) for _ in range(n)), tuple(kinks(1, 2.0, 0.5) for _ in range(n)),
        tuple(draw.integers(0, 6, 5).tolist()), some(-2.0, 2.0), (float(draw.uniform(0, 5)), 0.7),
    )  # fmt: skip
