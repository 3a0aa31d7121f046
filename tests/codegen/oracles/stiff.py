"""Models whose longest stable step is known from elsewhere: a closed form, or matrices typed by hand.

A fixed step h multiplies what belongs to a rate l of the linearised model by R(h l), R(z) = 1 + z + z^2/2 +
z^3/6 + z^4/24; it is stable while no |R| is above 1.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.optimize
from references.build import bond_graph

import bondgraph as bg
from differentials import magic_formula_tire
from oracles.units import Case


def amplification(z: np.ndarray) -> np.ndarray:
    return sum(z**k / factor for k, factor in enumerate((1, 1, 2, 6, 24)))


def first_unstable(J: np.ndarray) -> float:
    """The step at which the first |R(h l)| rises above 1, by a walk along each ray from zero."""
    radii = np.linspace(2.5, 3.1, 600_001)
    steps = []
    for rate in np.linalg.eigvals(J):
        if abs(rate) > 1e-9 * np.abs(J).max():
            beyond = np.abs(amplification(radii * rate / abs(rate))) > 1 + 1e-9
            steps.append(radii[np.argmax(beyond)] / abs(rate))
    return float(min(steps))


@dataclass(frozen=True)
class Stiff:
    """A model, its longest stable step, and the states after a number of steps of h from the start.

    ``near``: how close the states come to these, of their largest.
    """

    case: Case
    longest: float
    expected: Callable[[float, int], dict[str, float]]
    near: float


def wheel() -> Stiff:
    """A wheel on a magic formula tire, at the speed of its centre: tau_t' = r k_t/omega_0 there."""
    nodes = [bg.Se("engine", "tau"), bg.One("hub"), bg.I("wheel", "J", flow="omega_t1"),
             bg.R("tire", law=magic_formula_tire(1))]  # fmt: skip
    numbers = {
        "J": 0.8,
        "r": 0.3,
        "k_t": 1e5,
        "C_t": 1.65,
        "D_t": 4000.0,
        "E_t": -1.0,
        "omega_t1_0": 5.0,
    }
    equations = bg.derive(bond_graph(nodes, "engine>hub>wheel hub>tire"))
    case = Case(equations, numbers, None, {"omega_t1": 5.0}, {"tau": 30.0}, 1.0)

    def torque(omega: float) -> float:
        turned = 1e5 / (1.65 * 4000) * (omega - 5) / 5
        return 0.3 * 4000 * np.sin(1.65 * np.arctan(turned + (turned - np.arctan(turned))))

    steady = scipy.optimize.brentq(lambda omega: torque(omega) - 30, 5, 5.1, xtol=1e-14)
    longest = 2.785293563405282 * 0.8 / (0.3 * 1e5 / 5)
    return Stiff(case, longest, lambda h, count: {"omega_t1": steady}, 1e-9)


def chain(masses: int = 6) -> Stiff:
    """Masses in a row, between them springs with a little damping; pushed at one end."""
    nodes, bonds = [bg.Se("push", "F")], ["push>n0"]
    for i in range(masses):
        nodes += [bg.One(f"n{i}"), bg.I(f"m{i}", "m", flow=f"v{i}")]
        bonds += [f"n{i}>m{i}"]
    for i in range(masses - 1):
        nodes += [bg.Zero(f"z{i}"), bg.One(f"s{i}"), bg.R(f"d{i}", "b"),
                  bg.C(f"k{i}", "1/k", effort=f"f{i}")]  # fmt: skip
        bonds += [f"n{i}>z{i}>n{i + 1}", f"z{i}>s{i}>k{i}", f"s{i}>d{i}"]
    numbers = {"m": 2.0, "k": 5000.0, "b": 3.0}
    equations = bg.derive(bond_graph(nodes, " ".join(bonds)))
    apart = np.eye(masses)[:-1] - np.eye(masses)[1:]
    J = np.block([
        [-3.0 / 2.0 * apart.T @ apart, -apart.T / 2.0],
        [5000.0 * apart, np.zeros((masses - 1, masses - 1))],
    ])  # fmt: skip
    names = [*(f"v{i}" for i in range(masses)), *(f"f{i}" for i in range(masses - 1))]
    pushed = np.zeros((len(J) + 1, len(J) + 1))
    pushed[:-1, :-1], pushed[0, -1] = J, 7.0 / 2.0

    def expected(h: float, count: int) -> dict[str, float]:
        step = sum(
            np.linalg.matrix_power(h * pushed, k) / f for k, f in enumerate((1, 1, 2, 6, 24))
        )
        start = np.append(np.zeros(len(J)), 1.0)
        return dict(zip(names, np.linalg.matrix_power(step, count) @ start, strict=False))

    case = Case(equations, numbers, None, {}, {"F": 7.0}, 1.0)
    return Stiff(case, first_unstable(J), expected, 1e-9)


def clutch() -> Stiff:
    """Two inertias with a dry clutch between, one on a shaft to ground: it locks, and all comes to rest."""
    nodes = [bg.Se("engine", "tau"), bg.One("front"), bg.I("J1", "J_1", flow="w_1"), bg.Zero("z"),
             bg.R("clutch", law=bg.DryFriction("L"), effort="tau_c", flow="slip"), bg.One("rear"),
             bg.I("J2", "J_2", flow="w_2"), bg.C("shaft", "1/k", effort="tau_s"),
             bg.R("loss", "b")]  # fmt: skip
    equations = bg.derive(
        bond_graph(nodes, "engine>front>J1 front>z>clutch z>rear>J2 rear>shaft rear>loss")
    )
    numbers = {"J_1": 0.4, "J_2": 0.05, "k": 2000.0, "b": 6.0, "L": 90.0}
    case = Case(equations, numbers, None, {"w_1": 30.0, "w_2": -5.0}, {"tau": 20.0}, 1.0)
    slipping = np.array([[-6.0 / 0.05, -1.0 / 0.05], [2000.0, 0.0]])
    rest = {"w_1": 0.0, "w_2": 0.0, "tau_s": 20.0}
    return Stiff(case, first_unstable(slipping), lambda h, count: rest, 1e-6)


STIFF = {"wheel": wheel, "chain": chain, "clutch": clutch}
