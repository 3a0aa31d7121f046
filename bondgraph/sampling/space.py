"""Sampled models in numbers: ``x_{k+1} = P x_k + Q u_k``; poles, responses, objects for scipy and control."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bondgraph.errors import ParameterError
from bondgraph.sampling.control import control_space

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True)
class SampledSpace:
    """``x_{k+1} = P x_k + Q u_k``, ``y_k = F x_k + D u_k`` in numbers, every ``period`` [s]; read-only.

    ``x_k`` is the state just before instant k, ``u_k`` the inputs from then on, held until the next,
    and ``y_k`` what there is just after it, when controllers have set what they set.

    Raises nothing by itself; `linearize` with a period makes what has one.

    >>> import bondgraph as bg
    >>> plant = bg.graph([bg.Se("F", "1*u"), bg.One("n"), bg.I("m", 1, flow="v"),
    ...                   bg.Controller("brake", every=0.1, gives={"u": "-v"})], "F > n > m")
    >>> space = bg.linearize(bg.derive(plant), period=0.1).numeric({})
    >>> space.states, space.poles().real.round(3).tolist()
    (('v', 'u'), [0.9, 0.0])
    """

    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    period: float
    P: Array
    Q: Array
    F: Array
    D: Array

    def __repr__(self) -> str:
        n, m, p = len(self.states), len(self.inputs), len(self.outputs)
        return f"<SampledSpace: {n} states, {m} inputs, {p} outputs, every {self.period:.6g} s>"

    def poles(self) -> ComplexArray:
        """The eigenvalues of P, farthest from 0 first, pairs together; inside the unit circle it settles."""
        found = np.linalg.eigvals(self.P).astype(complex)
        return np.array(
            sorted(found, key=lambda p: (-float(f"{abs(p):.9g}"), abs(p.imag), p.imag)),
            dtype=complex,
        )

    def transfer(self, z: complex) -> ComplexArray:
        """Outputs over inputs at one complex z: an array outputs x inputs.

        Raises `ParameterError` at a pole.
        """
        try:
            x = np.linalg.solve(z * np.eye(len(self.states)) - self.P, self.Q)
        except np.linalg.LinAlgError:
            raise ParameterError(f"z = {z} is a pole; take a value beside it") from None
        return np.asarray(self.F @ x + self.D, dtype=complex)

    def frequency_response(self, frequencies: ArrayLike) -> ComplexArray:
        """The transfer matrix at frequencies in Hz: an array frequencies x outputs x inputs."""
        if np.iscomplexobj(frequencies):
            raise ParameterError("frequencies are real numbers in Hz; transfer takes complex z")
        hertz = np.atleast_1d(np.asarray(frequencies, dtype=float))
        found = [self.transfer(np.exp(2j * np.pi * f * self.period)) for f in hertz]
        return np.array(found).reshape(len(hertz), len(self.outputs), len(self.inputs))

    def step_response(self, count: int) -> Array:
        """Outputs just after the first instants as each input becomes 1: count x outputs x inputs."""
        x, found = np.zeros((len(self.states), len(self.inputs))), []
        for _ in range(count):
            found.append(self.F @ x + self.D)
            x = self.P @ x + self.Q
        return np.array(found).reshape(count, len(self.outputs), len(self.inputs))

    def to_scipy(self) -> Any:
        """A ``scipy.signal.StateSpace`` with ``dt``."""
        from scipy.signal import StateSpace as ScipyStateSpace

        return ScipyStateSpace(self.P, self.Q, self.F, self.D, dt=self.period)

    def to_control(self) -> Any:
        """A ``control.StateSpace`` with ``dt`` and the names of states, inputs and outputs.

        Raises `MissingExtraError` without python-control.
        """
        matrices = (self.P, self.Q, self.F, self.D, self.period)
        return control_space(matrices, self.states, self.inputs, self.outputs)


@dataclass(frozen=True)
class Tick:
    """What is set so long [s] into a period: these places of the state, as rows over state and inputs."""

    time: float
    places: tuple[int, ...]
    over_states: Array
    over_inputs: Array


def over_a_period(
    A: Array, B: Array, C: Array, D: Array, ticks: Sequence[Tick], period: float
) -> tuple[Array, Array, Array, Array]:
    """P, Q, F, D of ``x' = A x + B u``, ``y = C x + D u`` with what is set on the way, inputs held.

    Between two instants the exponential is exact (Van Loan 1978, eq. (1.4)); what one instant sets is told
    by what stood before it.
    """
    n, m = B.shape
    x, u, t = np.eye(n), np.zeros((n, m)), 0.0
    seen: tuple[Array, Array] | None = None
    for tick in sorted(ticks, key=lambda one: one.time):
        if tick.time > t:
            seen = seen or (C @ x, C @ u + D)
            x, u = _carried(A, B, x, u, tick.time - t)
            t = tick.time
        places = list(tick.places)
        set_x = tick.over_states @ x
        set_u = tick.over_states @ u + tick.over_inputs
        x, u = x.copy(), u.copy()
        x[places], u[places] = set_x, set_u
    seen = seen or (C @ x, C @ u + D)
    x, u = _carried(A, B, x, u, period - t)
    return x, u, *seen


def _carried(A: Array, B: Array, x: Array, u: Array, time: float) -> tuple[Array, Array]:
    """What the state and the inputs of the period's begin come to after a time without instants."""
    from scipy.linalg import expm

    n, m = B.shape
    whole = np.zeros((n + m, n + m))
    whole[:n, :n], whole[:n, n:] = A, B
    moved = expm(whole * time)
    return moved[:n, :n] @ x, moved[:n, :n] @ u + moved[:n, n:]
