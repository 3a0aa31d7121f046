"""A ladder of coils with resistance and capacitors, on a voltage that is there from the first instant.

Equations: ``L i_k' = v_(k-1) - v_k - R i_k``, ``C v_k' = i_k - i_(k+1)``, a load at the end.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from .modelica_text import CIRCUIT_PARTS, lines, model

Array = NDArray[np.float64]

END, SAMPLES = 2e-3, 1001
"""A run [s], and its samples with both ends."""


@dataclass(frozen=True)
class Ladder:
    """Sections, each of R [Ohm], L [H] and C [F]; the load [Ohm] and the voltage [V]."""

    sections: int = 10
    R: float = 1.0
    L: float = 1e-3
    C: float = 1e-6
    load: float = 50.0
    V: float = 1.0


def spec(one: Ladder) -> dict[str, Any]:
    """The ladder as every tool's script reads it."""
    return {
        "sections": one.sections, "R": one.R, "L": one.L, "C": one.C, "load": one.load, "V": one.V,
        "end": END, "samples": SAMPLES, "modelica": text(one), "netlist": netlist(one),
    }  # fmt: skip


def read(spec: dict[str, Any]) -> Ladder:
    """The ladder of a `spec`."""
    return Ladder(*(spec[name] for name in ("sections", "R", "L", "C", "load", "V")))


def text(one: Ladder) -> str:
    """The ladder in Modelica."""
    parts = [
        "Ground ground;",
        f"Source source(V = {one.V!r});",
        f"Resistor load(R = {one.load!r});",
    ]
    joined, before = ["connect(source.n, ground.p);"], "source.p"
    for k in range(1, one.sections + 1):
        parts += [f"Resistor R_{k}(R = {one.R!r});", f"Inductor L_{k}(L = {one.L!r});",
                  f"Capacitor C_{k}(C = {one.C!r});"]  # fmt: skip
        joined += [f"connect({before}, R_{k}.p);", f"connect(R_{k}.n, L_{k}.p);",
                   f"connect(L_{k}.n, C_{k}.p);", f"connect(C_{k}.n, ground.p);"]  # fmt: skip
        before = f"C_{k}.p"
    joined += [f"connect({before}, load.p);", "connect(load.n, ground.p);"]
    return lines(CIRCUIT_PARTS, model("Ladder", parts, joined))


def netlist(one: Ladder, tolerance: float = 1e-9) -> str:
    """The ladder for ngspice, which writes its own steps, none longer than from sample to sample."""
    deck = ["ladder", f"V0 n0 0 DC {one.V!r}"]
    for k in range(1, one.sections + 1):
        deck += [f"R{k} n{k - 1} a{k} {one.R!r}", f"L{k} a{k} n{k} {one.L!r} IC=0",
                 f"C{k} n{k} 0 {one.C!r} IC=0"]  # fmt: skip
    step = END / (SAMPLES - 1)
    deck += [
        f"RL n{one.sections} 0 {one.load!r}",
        f".options reltol={tolerance:g} abstol=1e-15 vntol=1e-12 chgtol=1e-20",
        f".tran {step:g} {END:g} 0 {step:g} uic",
        ".end",
    ]
    return lines(*deck)


def matrices(one: Ladder) -> tuple[Array, Array]:
    """``A`` and ``b`` of ``x' = A x + b``, x the currents and then the voltages."""
    n = one.sections
    A, b = np.zeros((2 * n, 2 * n)), np.zeros(2 * n)
    for k in range(n):
        A[k, k] = -one.R / one.L
        A[k, n + k], A[n + k, k] = -1 / one.L, 1 / one.C
        if k:
            A[k, n + k - 1], A[n + k - 1, k] = 1 / one.L, -1 / one.C
    A[-1, -1], b[0] = -1 / (one.load * one.C), one.V / one.L
    return A, b


def voltages(one: Ladder, times: Array) -> Array:
    """The exact voltages of the capacitors, one row for each time, by matrix exponentials."""
    A, b = matrices(one)
    M = np.block([[A, b[:, None]], [np.zeros((1, len(b) + 1))]])
    return np.array([scipy.linalg.expm(M * time)[one.sections : -1, -1] for time in times])
