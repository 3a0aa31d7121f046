"""Linear models in numbers: poles, natural frequencies, mode shapes, transfer and frequency response."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike, NDArray

from bondgraph.algebra.atoms import normal, number
from bondgraph.algebra.elimination import ResidueRows
from bondgraph.algebra.exact import rows_of
from bondgraph.algebra.residues import residues
from bondgraph.errors import ParameterError, SignalError
from bondgraph.sampling.control import control_space

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True)
class Mode:
    """One real pole or one pair: the pole with Im >= 0 [1/s] and its shape over the states.

    The largest component of ``shape`` is 1. ``participation``: how much each state takes part, whatever
    the units, by right and left eigenvector.
    """

    pole: complex
    shape: Mapping[str, complex]
    participation: Mapping[str, float]

    @property
    def frequency(self) -> float:
        """The undamped natural frequency ``|pole| / 2 pi`` [Hz]."""
        return abs(self.pole) / (2 * np.pi)

    @property
    def damped_frequency(self) -> float:
        """The frequency of the oscillation, ``Im pole / 2 pi`` [Hz]; 0 for a real pole."""
        return self.pole.imag / (2 * np.pi)

    @property
    def damping(self) -> float:
        """The damping ratio ``-Re pole / |pole|``; 1 or more of it does not oscillate, nan at 0."""
        return -self.pole.real / abs(self.pole) if self.pole else float("nan")

    def share(self, pattern: Mapping[str, float]) -> float:
        """How much of the shape lies along a pattern of states, from 0 to 1 among those states."""
        own = np.array([self.shape[name] for name in pattern])
        weights = np.array(list(pattern.values()), dtype=float)
        size = float(np.linalg.norm(own) * np.linalg.norm(weights))
        return float(abs(weights @ own)) / size if size else 0.0


@dataclass(frozen=True)
class StateSpace:
    """``x' = P x + Q u + R u'``, ``y = F x + D u + G u'`` in numbers; arrays are read-only."""

    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    P: Array
    Q: Array
    R: Array
    F: Array
    D: Array
    G: Array
    #: Whether a pole is exactly 0, so that constant inputs have no steady state.
    drifts: bool = False

    def __str__(self) -> str:
        """Sizes, and every pole and pair with its frequency and damping."""
        from bondgraph.show.poles import space_text

        return space_text(self)

    def _repr_html_(self) -> str:
        from bondgraph.show.poles import space_html

        return space_html(self)

    def poles(self) -> ComplexArray:
        """The eigenvalues of P [1/s], slowest first, pairs together."""
        found = np.linalg.eigvals(self.P).astype(complex)
        return np.array(
            sorted(found, key=lambda p: (float(f"{abs(p):.9g}"), abs(p.imag), p.imag)),
            dtype=complex,
        )

    def modes(self) -> tuple[Mode, ...]:
        """Every real pole and every pair of poles once, with its shape, slowest first."""
        values, vectors = np.linalg.eig(self.P)
        part = np.abs(vectors * np.linalg.pinv(vectors).T)
        modes = []
        for at, value in enumerate(values.astype(complex)):
            if value.imag >= 0:
                vector = vectors[:, at].astype(complex)
                scaled = vector / vector[int(np.argmax(np.abs(vector)))]
                shape = dict(zip(self.states, map(complex, scaled), strict=True))
                taken = dict(zip(self.states, map(float, part[:, at]), strict=True))
                modes.append(Mode(complex(value), MappingProxyType(shape), MappingProxyType(taken)))
        return tuple(sorted(modes, key=lambda mode: (mode.frequency, -mode.pole.real)))

    def mode(self, pattern: Mapping[str, float]) -> Mode:
        """The oscillation whose shape lies most along a pattern, such as ``{"omega_1": 1, "omega_2": -1}``.

        Of the oscillations that do so equally well the one in which these states take part most.

        Raises `SignalError` for unknown states, or if nothing oscillates.
        """
        for name in pattern:
            if name not in self.states:
                raise SignalError(f"{name!r} is not a state; there are {', '.join(self.states)}")
        modes = self.modes()
        # Poles at 0 come with imaginary parts of rounding, relative to the fastest.
        least = 1e-9 * max((abs(mode.pole) for mode in modes), default=0.0)
        swinging = [mode for mode in modes if mode.pole.imag > least]
        if not swinging:
            raise SignalError("nothing oscillates: all poles are real")
        return max(
            swinging,
            key=lambda mode: (
                round(mode.share(pattern), 6),
                sum(mode.participation[name] for name in pattern),
            ),
        )

    def transfer(self, s: complex) -> ComplexArray:
        """Outputs over inputs at one complex frequency [1/s]: an array outputs x inputs.

        Raises `ParameterError` at a pole.
        """
        pencil = s * np.eye(len(self.states)) - self.P
        try:
            x = np.linalg.solve(pencil, self.Q + s * self.R)
        except np.linalg.LinAlgError:
            raise ParameterError(f"s = {s} is a pole; take a value beside it") from None
        return np.asarray(self.F @ x + self.D + s * self.G, dtype=complex)

    def frequency_response(self, frequencies: ArrayLike) -> ComplexArray:
        """The transfer matrix at frequencies in Hz: an array frequencies x outputs x inputs."""
        if np.iscomplexobj(frequencies):
            raise ParameterError(
                "frequencies are real numbers in Hz; transfer takes complex ones in 1/s"
            )
        hertz = np.atleast_1d(np.asarray(frequencies, dtype=float))
        return np.array([self.transfer(2j * np.pi * f) for f in hertz]).reshape(
            len(hertz), len(self.outputs), len(self.inputs)
        )

    def dc_gain(self) -> Array:
        """Outputs over inputs at rest, outputs x inputs.

        Raises `ParameterError` if a pole at 0 leaves no steady state.
        """
        if self.drifts:
            raise ParameterError(
                "the model has a pole at 0, so a constant input has no steady state; "
                "close the ports that hold it, or look at transfer(s) for a small s"
            )
        return np.asarray(self.transfer(0).real, dtype=float)

    def proper(self) -> tuple[Array, Array, Array, Array]:
        """A, B, C, D of ``xi' = A xi + B u``, ``y = C xi + D u``, with ``xi = x - R u``.

        Raises `ParameterError` if an output shows the rate of an input.
        """
        if self.G.any():
            i, j = (int(at[0]) for at in np.nonzero(self.G))
            raise ParameterError(
                f"{self.outputs[i]} shows the rate of {self.inputs[j]}: no proper state space has that; "
                "leave the output out"
            )
        return self.P, self.Q + self.P @ self.R, self.F, self.D + self.F @ self.R

    def to_scipy(self) -> Any:
        """A ``scipy.signal.StateSpace``."""
        from scipy.signal import StateSpace as ScipyStateSpace

        return ScipyStateSpace(*self.proper())

    def to_control(self) -> Any:
        """A ``control.StateSpace`` with the names of states, inputs and outputs.

        Raises `MissingExtraError` without python-control.
        """
        return control_space(self.proper(), self.states, self.inputs, self.outputs)


def state_space(
    names: tuple[Sequence[sp.Symbol], Sequence[sp.Symbol], Sequence[sp.Symbol]],
    matrices: Sequence[Any],
    parameters: Mapping[str, object],
) -> StateSpace:
    """Symbolic matrices A, J, B, E, F, D, G with numbers for their names, solved for the rates."""
    values = _exact(parameters)
    used = sorted({name for matrix in matrices for name in matrix.free_symbols}, key=str)
    missing = [str(name) for name in used if name.name not in values]
    if missing:
        raise ParameterError(f"missing parameter(s) {', '.join(missing)}; give each a number")
    A, J, B, E, F, D, G = (_array(matrix, used, values) for matrix in matrices)
    if not _is_regular(matrices[0], values):
        raise ParameterError("A is singular at these parameters")
    scale = 1 / np.sqrt(np.where(np.diag(A) != 0, np.abs(np.diag(A)), 1.0))
    right = scale[:, None] * np.hstack([J, B, E])
    solved = scale[:, None] * np.linalg.solve(A * np.outer(scale, scale), right)
    n, m = len(names[0]), len(names[1])
    arrays = (solved[:, :n], solved[:, n : n + m], solved[:, n + m :], F, D, G)
    for array in (*arrays, solved):
        array.setflags(write=False)
    states, inputs, outputs = (tuple(map(str, group)) for group in names)
    return StateSpace(states, inputs, outputs, *arrays, drifts=not _is_regular(matrices[1], values))


def _is_regular(matrix: Any, values: Mapping[str, sp.Rational]) -> bool:
    """Whether a square matrix has an inverse at these numbers, decided exactly."""
    value = residues()
    exact = {name: values[name.name] for name in matrix.free_symbols}
    rows = ResidueRows(
        {j: v for j, entry in row.items() if (v := value(entry.xreplace(exact)))}
        for row in rows_of(matrix)
    )
    return all(rows.pivot(i, jordan=False) for i in range(matrix.rows))


def _exact(parameters: Mapping[str, object]) -> dict[str, sp.Rational]:
    if not isinstance(parameters, Mapping):
        raise ParameterError(f"parameters must map names to numbers, not be {parameters!r}")
    try:
        return {
            str(normal(str(name))): number(value, f"parameter {name!r}")
            for name, value in parameters.items()
        }
    except ValueError as error:
        raise ParameterError(str(error)) from None


def _array(matrix: Any, names: Iterable[sp.Symbol], values: Mapping[str, sp.Rational]) -> Array:
    """A symbolic matrix at these numbers; `ParameterError` for an entry that is not finite."""
    result = np.zeros(matrix.shape)
    exact = {name: values[name.name] for name in names}
    for (i, j), entry in matrix.todok().items():
        value = sp.N(entry.xreplace(exact))
        if not (value.is_real and value.is_finite):
            raise ParameterError(f"{entry} has no finite real value at these parameters")
        result[i, j] = float(value)
    return result
