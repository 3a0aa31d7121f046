"""Conditions that fall below zero and rise again inside one step, of a motion known in closed form.

An oscillator runs free, x = a sin(w t + p); a switch of a circuit of its own, which is on while a condition
over x is above zero, turns off and on where x passes the condition's two zeros.
"""

import shutil
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest
from references.build import bond_graph
from scipy.optimize import brentq
from soak.families import seeds

import bondgraph as bg
from codegen import simulator

END = 4.0

BACKENDS = [
    "numpy",
    pytest.param("c", marks=pytest.mark.skipif(shutil.which("cc") is None, reason="needs cc")),
]

KINDS = {
    "corner": "Abs(y) - d",
    "skew corner": "Max(y, -r*y) - d",
    "bent corner": "Abs(y*(1 + y/4)) - d",
    "flat": "Max(Abs(y) - d, -d/2)",
    "skew": "exp(r*y) - 1 - r*y - d",
    "steep": "y**4 - d*Abs(d)",
}
"""Conditions over y = x - c, above zero but for a stretch about y = 0 whose width is that of d."""


@dataclass(frozen=True)
class Dips:
    """A condition ``kind`` with its numbers; the motion's size, rate [rad/s] and phase."""

    kind: str
    c: float
    d: float
    r: float
    a: float
    w: float
    p: float

    def zeros(self) -> tuple[float, float]:
        """The two values of y between which the condition is below zero."""
        d, r = self.d, self.r
        if self.kind == "skew corner":
            return -d / r, d
        if self.kind == "bent corner":
            # y + y^2/4 = d and -d: (y/2 + 1)^2 = 1 +- d
            return tuple(2 * (np.sqrt(1 + way * d) - 1) for way in (-1, 1))
        if self.kind == "steep":
            return -np.sqrt(d), np.sqrt(d)
        if self.kind == "skew":
            return self._skew(-3 * np.sqrt(d) / r), self._skew(3 * np.sqrt(d) / r)
        return -d, d

    def _skew(self, far: float) -> float:
        return brentq(
            lambda y: np.expm1(self.r * y) - self.r * y - self.d, far, 0.0, xtol=1e-16, rtol=1e-14
        )

    def events(self) -> list[tuple[float, str]]:
        """Where x comes in between the zeros the switch turns off, where it goes out on."""
        low, high = (self.c + y for y in self.zeros())
        found = []
        for turn in range(-1, int((self.w * END + self.p) / (2 * np.pi)) + 2):
            # Upwards through x at angle, downwards at pi - angle.
            for x, up, down in ((low, "off", "on"), (high, "on", "off")):
                angle = np.arcsin(x / self.a)
                for phase, kind in ((angle, up), (np.pi - angle, down)):
                    found.append(((2 * np.pi * turn + phase - self.p) / self.w, kind))
        return sorted(one for one in found if 0 < one[0] < END)


def drawn(seed: int) -> Dips:
    """Stretches of a part of 1e-1 to 1e-4 of the motion: steps pass over most."""
    rng = np.random.default_rng(seed)
    kind = list(KINDS)[seed % len(KINDS)]
    size = 10 ** rng.uniform(-4, -1)
    d = size**2 if kind in ("skew", "steep") else size
    a, w = rng.uniform(1.0, 2.0), rng.uniform(1.0, 3.0)
    p = rng.uniform(-np.pi, np.pi)
    r = 10 ** rng.uniform(-0.5, 0.5)
    while True:
        # Neither at the start nor where the motion turns.
        c = rng.uniform(-0.9, 0.9) * a
        if abs(a * np.sin(p) - c) > 0.3 and abs(c) + 0.35 < a:
            return Dips(kind, c, d, r, a, w, p)


@cache
def _equations(condition: str) -> bg.StateEquations:
    """The oscillator's spring has the effort x."""
    nodes = [bg.One("m"), bg.I("M", "1/w", flow="v"), bg.C("K", "1/w", effort="x"), bg.Se("u", 1),
             bg.One("j"), bg.R("r_u", 1), bg.Sw("k", on=condition.replace("y", "(x - c)"))]  # fmt: skip
    return bg.derive(bond_graph(nodes, "m>M m>K u>j j>k j>r_u"))


def _run(dips: Dips, backend: str, method: str) -> list[tuple[float, str]]:
    """The switch's events; steps as long as 1e-7 s of them allow pass over more than shorter ones."""
    condition = KINDS[dips.kind]
    numbers = {name: getattr(dips, name) for name in ("cdrw" if "r*y" in condition else "cdw")}
    start = {"x": dips.a * np.sin(dips.p), "v": dips.a * np.cos(dips.p)}
    ready = simulator(_equations(condition), numbers, backend=backend)
    result = ready.run([0.0, END], start, {}, method, 1e-8, 1e-9, initially_on=["k"])
    assert result.backend == backend
    return [(event.time, event.kind) for event in result.events]


def _method(seed: int) -> str:
    return ("DOP853", "Radau")[seed // len(KINDS) % 2]


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("seed", seeds("dips"))
def test_what_dips_below_zero_inside_a_step_is_found(seed: int, backend: str) -> None:
    dips = drawn(seed)
    found, expected = _run(dips, backend, _method(seed)), dips.events()
    assert [kind for _, kind in found] == [kind for _, kind in expected]
    assert [t for t, _ in found] == pytest.approx([t for t, _ in expected], abs=1e-7)


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("seed", seeds("dips"))
def test_what_stays_above_zero_makes_no_event(seed: int, backend: str) -> None:
    """The same conditions raised, so that their lowest value is above zero by as much."""
    dips = drawn(seed)
    assert _run(replace(dips, d=-dips.d), backend, _method(seed)) == []
