"""`trim`: a steady state, with friction ports that stick or slip as they would."""

from collections.abc import Mapping, Sequence
from itertools import product

import numpy as np

from bondgraph.errors import SimulationError
from codegen.inputs.pieces import Piece
from codegen.model.snapshot import Mode, Snapshot
from codegen.modes.closed import ClosedModel
from codegen.modes.trials import evaluated
from codegen.numbers.arrays import Array
from codegen.simulate import Simulator
from codegen.tuning import TUNING

ITERATIONS = 50


def trim(
    simulator: Simulator,
    inputs: Mapping[str, float] | None = None,
    initial: Mapping[str, float] | None = None,
) -> dict[str, float]:
    """A point at which all states rest under constant inputs: every signal's value by name.

    ``initial``: states to start the search from. Sticking is preferred where both would do. The result
    is what `linearize` takes as ``at``.

    Raises `SignalError` for unusable arguments, `SimulationError` if no steady state was found.

    >>> import bondgraph as bg, networkx as nx
    >>> from codegen import simulator
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("pump", "p"), bg.One("pipe"), bg.I("fluid", "I_f", flow="q"),
    ...                   bg.R("orifice", law="c*q*abs(q)")])
    >>> g.add_edges_from([("pump", "pipe"), ("pipe", "fluid"), ("pipe", "orifice")])
    >>> point = trim(simulator(bg.derive(g), {"I_f": 1, "c": 2}), {"p": 18}, {"q": 1})
    >>> round(point["q"], 9)
    3.0
    """
    model = simulator.closed
    pieces, start = simulator.steady(inputs or {}, initial or {})
    with np.errstate(all="ignore"):
        for mode in _modes(model, pieces, start):
            try:
                found = _rest(model, pieces, mode, start)
            except SimulationError:
                # Laws without a solution in a mode: it is none.
                found = None
            if found is not None and _consistent(model, mode, model.at(0.0, found, pieces, mode)):
                return _named(model, model.at(0.0, found, pieces, mode))
    raise SimulationError(
        "no steady state was found: a state may drift without end (a free rotation, an integrator), or "
        "the search needs a closer start in initial"
    )


def _modes(model: ClosedModel, pieces: Sequence[Piece], start: Array) -> list[Mode]:
    """All modes, those with the start's slips first."""
    ports = len(model.friction_inputs)
    if not ports:
        return [()]
    _, now = evaluated(model, 0.0, start, pieces, (1,) * ports)
    slips = now.y[model.friction_readings]
    signs = np.sign(np.round(slips, 12)).astype(int)
    every = product((0, 1, -1), repeat=ports)
    return sorted(
        every, key=lambda mode: sum(int(s) != m for s, m in zip(signs, mode, strict=True))
    )


def _rest(model: ClosedModel, pieces: Sequence[Piece], mode: Mode, start: Array) -> Array | None:
    """Newton's iteration for rates, and slips of sticking ports, that vanish; None if it fails."""
    s = start.copy()
    left, size = _residual(model, pieces, mode, s)
    for _ in range(ITERATIONS):
        if not np.isfinite(left).all():
            return None
        if (np.abs(left) <= TUNING.close * size).all():
            return s
        step = np.linalg.lstsq(
            _slopes(model, pieces, mode, s, left), -left, rcond=TUNING.independent
        )[0]
        for shorter in 0.5 ** np.arange(30):
            tried, tried_size = _residual(model, pieces, mode, s + shorter * step)
            # Terms that vanish at the start say nothing about what is small: the largest seen do.
            largest = np.maximum(size, tried_size)
            if np.linalg.norm(tried / largest) < np.linalg.norm(left / largest):
                break
        else:
            return None
        s, left, size = s + shorter * step, tried, largest
    return None


def _residual(
    model: ClosedModel, pieces: Sequence[Piece], mode: Mode, s: Array
) -> tuple[Array, Array]:
    """Rates and held slips, and what they are small against."""
    now = model.at(0.0, s, pieces, mode)
    stuck = [model.friction_readings[i] for i, sign in enumerate(mode) if sign == 0]
    numbers, n = now.numbers, len(now.x)
    terms = np.abs(numbers.P) @ np.abs(now.x) + np.abs(numbers.Q) @ np.abs(now.u)
    rates = np.concatenate([terms, np.ones(len(now.rate) - n)])
    held = np.abs(numbers.F[stuck]) @ np.abs(now.x) + np.abs(numbers.D[stuck]) @ np.abs(now.u)
    return np.concatenate([now.rate, now.y[stuck]]), np.concatenate(
        [rates, held]
    ) + TUNING.trim_floor


def _slopes(
    model: ClosedModel, pieces: Sequence[Piece], mode: Mode, s: Array, left: Array
) -> Array:
    slopes = np.empty((len(left), len(s)))
    for j in range(len(s)):
        step = TUNING.difference * (abs(s[j]) + TUNING.residual_floor)
        ahead, behind = s.copy(), s.copy()
        ahead[j], behind[j] = s[j] + step, s[j] - step
        over, under = (_residual(model, pieces, mode, at)[0] for at in (ahead, behind))
        slopes[:, j] = (over - under) / (2 * step)
    return np.nan_to_num(slopes)


def _consistent(model: ClosedModel, mode: Mode, now: Snapshot) -> bool:
    """Whether slips have the mode's signs and holding efforts stay within what ports can hold."""
    slips, efforts = now.y[model.friction_readings], now.u[model.friction_inputs]
    held = [
        abs(efforts[i]) <= now.caps[i] * (1 + TUNING.consistent)
        for i, m in enumerate(mode)
        if m == 0
    ]
    slipping = [slips[i] * m > 0 for i, m in enumerate(mode) if m]
    return all(held) and all(slipping)


def _named(model: ClosedModel, now: Snapshot) -> dict[str, float]:
    program = model.program
    groups = (
        (program.states, now.x), (program.law_states, now.z), (program.inputs, now.u),
        (program.asked, now.external), (program.readings, now.y),
    )  # fmt: skip
    values: dict[str, float] = {}
    for names, row in groups:
        for name, value in zip(names, row.tolist(), strict=False):
            values.setdefault(name.name, value)
    return values
