"""A chain of inertias and springs, a damper at each inertia, the first driven by a torque from rest.

Equations: ``m_k w_k' = [k = 0] u - b_k w_k + tau_k - tau_(k+1)``, ``c_k tau_k' = w_(k-1) - w_k``.
"""

import random
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from .modelica_text import CHAIN_PARTS, lines, model

Array = NDArray[np.float64]

END, SAMPLES = 1.0, 1001
"""A run [s], and its samples with both ends."""


@dataclass(frozen=True)
class Chain:
    """Inertias [kg m^2], compliances [rad/(N m)] between them, dampers [N m s/rad], torque [N m]."""

    inertias: tuple[float, ...]
    compliances: tuple[float, ...]
    dampers: tuple[float, ...]
    torque: float = 1.0


def chain(count: int) -> Chain:
    """So many inertias, numbers drawn by the count: modes of some 10 to 1000 rad/s."""
    draw = random.Random(count)
    return Chain(
        tuple(draw.uniform(0.5, 2.0) for _ in range(count)),
        tuple(draw.uniform(1e-4, 4e-4) for _ in range(count - 1)),
        tuple(draw.uniform(0.5, 2.0) for _ in range(count)),
    )


def spec(one: Chain) -> dict[str, Any]:
    """The chain as every tool's script reads it."""
    return {
        "inertias": list(one.inertias), "compliances": list(one.compliances), "torque": one.torque,
        "dampers": list(one.dampers), "end": END, "samples": SAMPLES, "modelica": text(one),
    }  # fmt: skip


def read(spec: dict[str, Any]) -> Chain:
    """The chain of a `spec`."""
    numbers = (tuple(spec[name]) for name in ("inertias", "compliances", "dampers"))
    return Chain(*numbers, spec["torque"])


def text(one: Chain) -> str:
    """The chain in Modelica, of parts that are joined by flanges."""
    parts, joined = [f"Drive drive(u = {one.torque!r});"], ["connect(drive.a, m_0.a);"]
    for k, (inertia, damper) in enumerate(zip(one.inertias, one.dampers, strict=True)):
        parts += [f"Inertia m_{k}(m = {inertia!r});", f"Damper b_{k}(b = {damper!r});"]
        joined.append(f"connect(m_{k}.a, b_{k}.a);")
    for k, compliance in enumerate(one.compliances, 1):
        parts.append(f"Spring c_{k}(c = {compliance!r});")
        joined += [f"connect(m_{k - 1}.a, c_{k}.a);", f"connect(c_{k}.b, m_{k}.a);"]
    return lines(CHAIN_PARTS, model("Chain", parts, joined))


def matrices(one: Chain) -> tuple[Array, Array]:
    """``A`` and ``b`` of ``x' = A x + b``, x the speeds and then the springs' torques."""
    count = len(one.inertias)
    A, b = np.zeros((2 * count - 1, 2 * count - 1)), np.zeros(2 * count - 1)
    for k in range(count):
        A[k, k] = -one.dampers[k] / one.inertias[k]
    for k, compliance in enumerate(one.compliances, 1):
        at = count + k - 1
        A[k, at], A[k - 1, at] = 1 / one.inertias[k], -1 / one.inertias[k - 1]
        A[at, k - 1], A[at, k] = 1 / compliance, -1 / compliance
    b[0] = one.torque / one.inertias[0]
    return A, b


def speeds(one: Chain) -> Array:
    """The exact speeds at the samples, one row each: powers of one matrix exponential."""
    A, b = matrices(one)
    size = len(A)
    step = scipy.linalg.expm(
        np.block([[A, b[:, None]], [np.zeros((1, size + 1))]]) * END / (SAMPLES - 1)
    )
    rows = [np.append(np.zeros(size), 1.0)]
    for _ in range(SAMPLES - 1):
        rows.append(step @ rows[-1])
    return np.array(rows)[:, : len(one.inertias)]
