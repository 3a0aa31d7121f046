"""`bode`: how a linear model passes oscillations on, over their frequency."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bondgraph.analyse.state_space import ComplexArray, StateSpace
from bondgraph.errors import SignalError
from codegen.numbers.arrays import Array
from codegen.pictures.canvas import name_curves, rule, stack
from codegen.pictures.flags import Flag, raise_flags
from codegen.pictures.labels import pretty
from codegen.pictures.style import FAINT, TEXT, curve
from codegen.plots.poles import oscillations

POINTS = 600
"""Frequencies from end to end; two thirds as many again around each corner."""

NEAR = 1e-7
"""How close to a corner, as a part of it: resonances of that damping ratio are still seen in full."""

RINGING = 0.7
"""Modes of a lower damping ratio are marked as oscillations."""

ROUNDING = 1e-11
"""What is left of larger terms that cancel, as a part of them, and counts as nothing."""


def bode(
    model: StateSpace, input: str, *outputs: str, frequencies: ArrayLike | None = None,
    title: str = "",
) -> Any:  # fmt: skip
    """A `matplotlib.figure.Figure` of magnitudes [dB of output over input] and phases [degrees].

    ``outputs``: all of the model's, if none are named. ``frequencies`` [Hz]: else from a tenth of the slowest
    oscillation to ten times the fastest. Their frequencies are marked.

    Raises `SignalError` for unknown names or frequencies that are not positive, `ParameterError` where a
    frequency is that of an undamped oscillation, `MissingExtraError` without matplotlib.
    """
    shown = outputs or model.outputs
    column = _place(input, model.inputs, "input")
    rows = [_place(name, model.outputs, "output") for name in shown]
    hertz = _swept(model) if frequencies is None else _checked(frequencies)
    values = _response(model, hertz, rows, column)
    figure, (upper, lower) = stack(2, 2.2)
    for number, name in enumerate(shown):
        gain, phase = _gain_and_phase(values[:, number])
        silent = "" if np.isfinite(gain).any() else " (no response)"
        look = {"linewidth": 1.2, "label": pretty(name) + silent, **curve(number)}
        upper.semilogx(hertz, gain, **look)
        lower.semilogx(hertz, phase, **look)
    _mark((upper, lower), model, hertz)
    upper.set_ylabel("Magnitude [dB]", fontsize=TEXT)
    lower.set_ylabel("Phase [°]", fontsize=TEXT)
    lower.set_xlabel("Frequency [Hz]", fontsize=TEXT)
    for axis in (upper, lower):
        axis.margins(x=0)
        rule(axis)
    lower.yaxis.get_major_locator().set_params(steps=[1, 1.5, 3, 4.5, 9, 10])
    name_curves(upper)
    figure.align_ylabels([upper, lower])
    figure.suptitle(title or f"Response to {pretty(input)}", fontsize=TEXT + 1)
    return figure


def _place(name: str, known: tuple[str, ...], what: str) -> int:
    if name not in known:
        raise SignalError(f"{name!r} is not an {what}; there are {', '.join(known)}")
    return known.index(name)


def _checked(frequencies: ArrayLike) -> Array:
    hertz = np.atleast_1d(np.asarray(frequencies, dtype=float))
    if hertz.ndim != 1 or not len(hertz) or not (np.isfinite(hertz) & (hertz > 0)).all():
        raise SignalError("frequencies must be positive numbers [Hz]: the axis is logarithmic")
    return np.unique(hertz)


def _corners(model: StateSpace) -> Array:
    """The natural frequencies [Hz] of poles that are not at 0."""
    sizes = np.array([mode.frequency for mode in model.modes()])
    return np.asarray(sizes[sizes > 1e-9 * sizes.max(initial=0.0)], dtype=float)


def _swept(model: StateSpace) -> Array:
    """Frequencies that show every corner and every resonance, however sharp."""
    corners = _corners(model)
    if not len(corners):
        return np.geomspace(0.01, 100, POINTS)
    first, last = np.log10(corners.min() / 10), np.log10(corners.max() * 10)
    around = np.geomspace(NEAR, 0.3, POINTS // 3)
    close = [corner * np.concatenate([1 - around, 1 + around]) for corner in corners]
    return np.unique(np.concatenate([np.logspace(first, last, POINTS), *close]))


def _response(model: StateSpace, hertz: Array, rows: list[int], column: int) -> ComplexArray:
    """Outputs over an input, frequencies x outputs; nan where what is left is rounding of what cancels."""
    n = len(model.states)
    inner = replace(
        model, outputs=model.states, F=np.eye(n), D=0 * model.Q, G=0 * model.R
    ).frequency_response(hertz)[:, :, column]
    s = 2j * np.pi * hertz[:, None]
    F, D, G = model.F[rows], model.D[rows, column], model.G[rows, column]
    values = inner @ F.T + D + s * G
    sizes = np.abs(inner) @ np.abs(F).T + np.abs(D) + np.abs(s * G)
    return np.where(np.abs(values) > ROUNDING * sizes, values, np.nan)


def _gain_and_phase(values: ComplexArray) -> tuple[Array, Array]:
    """In dB and degrees, with gaps; the phase is continuous, and begins within 180."""
    passed = np.isfinite(values)
    gain, phase = np.full(len(values), np.nan), np.full(len(values), np.nan)
    gain[passed] = 20 * np.log10(np.abs(values[passed]))
    phase[passed] = np.degrees(np.unwrap(np.angle(values[passed])))
    return gain, phase


def _mark(axes: tuple[Any, Any], model: StateSpace, hertz: Array) -> None:
    """Hairlines at oscillations, with their frequencies above."""
    found = sorted({m.damped_frequency for m in oscillations(model) if m.damping < RINGING})
    shown = [frequency for frequency in found if hertz[0] <= frequency <= hertz[-1]]
    for frequency in shown:
        for axis in axes:
            axis.axvline(frequency, linewidth=0.6, color=FAINT, zorder=1, gid="oscillation")
    whole = np.log(hertz[-1] / hertz[0]) or 1.0
    raise_flags(
        axes[0], [Flag(f, float(np.log(f / hertz[0]) / whole), f"{f:.4g} Hz") for f in shown]
    )
