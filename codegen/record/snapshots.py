"""Everything at the samples of a run, as tables with a row for each of them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from codegen.inputs.signal import Signal
from codegen.model.snapshot import Mode
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.program.affine import AffineMap
from codegen.program.layout import (
    CAPS,
    EXTERNAL,
    NAMES,
    RECORDED,
)
from codegen.runs.track import Track
from codegen.standalone.levels import without_rounding


@dataclass(frozen=True)
class Snapshots:
    """The parts of a `Snapshot`, for all samples."""

    x: Array
    z: Array
    u: Array
    du: Array
    y: Array
    rate: Array
    external: Array


def snapshots(
    model: ClosedModel, times: Array, signals: Sequence[Signal], track: Track
) -> Snapshots:
    """Everything at the samples: of a mode all at once where that goes, else one by one."""
    by_modes = _by_modes if model.program.affine else _straight
    found = by_modes(model, times, signals, track)
    if found is not None:
        return found
    shots = [
        model.at(t, s, [signal.piece(t) for signal in signals], mode)
        for t, s, mode in zip(times.tolist(), track.vectors, track.modes, strict=True)
    ]
    names = [NAMES[part] for part in RECORDED]
    return Snapshots(*(np.array([getattr(shot, name) for shot in shots]) for name in names))


def _straight(
    model: ClosedModel, times: Array, signals: Sequence[Signal], track: Track
) -> Snapshots | None:
    """By the straight-line functions of modes; None where one has none, or no value somewhere."""
    modes, which = _modes(track)
    w, dw = _sampled(model, times, signals)
    tables: dict[str, Array] = {}
    for number, mode in enumerate(modes):
        fast, own = model.straight.of(mode), which == number
        if fast is None:
            return None
        found = fast.over(times[own], track.vectors[own].T, w[:, own], dw[:, own])
        if found is None:
            return None
        for name, table in found.items():
            tables.setdefault(name, np.zeros((len(times), table.shape[1])))[own] = table
    kept = {NAMES[part]: tables[NAMES[part]] for part in RECORDED if part != EXTERNAL}
    return Snapshots(**kept, external=w.T)


def _modes(track: Track) -> tuple[list[Mode], Array]:
    """The modes of the samples, and the number of each sample's among these."""
    modes = list(dict.fromkeys(track.modes))
    number = {mode: at for at, mode in enumerate(modes)}
    return modes, np.array([number[mode] for mode in track.modes])


def _sampled(model: ClosedModel, times: Array, signals: Sequence[Signal]) -> tuple[Array, Array]:
    """The external inputs, and their rates where anything asks for them, in rows over time."""
    w = np.array([signal.sampled(times) for signal in signals]).reshape(-1, len(times))
    dw = np.zeros_like(w)
    if model.program.rated and len(signals):
        dw[:] = [signal.sampled(times, rates=True) for signal in signals]
    return w, dw


def _by_modes(
    model: ClosedModel, times: Array, signals: Sequence[Signal], track: Track
) -> Snapshots | None:
    """None where a mode is not affine or a friction level is below zero."""
    modes, which = _modes(track)
    w, dw = _sampled(model, times, signals)
    vectors = np.column_stack([track.vectors, w.T, dw.T, np.ones(len(times))])
    tables: Array | None = None
    for number, mode in enumerate(modes):
        affine = model.affine_map(mode, len(signals))
        if affine is None:
            return None
        if tables is None:
            tables = np.zeros((len(times), len(affine.matrix)))
        tables[which == number] = vectors[which == number] @ affine.matrix.T
    if affine is None or tables is None or (mode and _refused(affine, tables, vectors, track)):
        return None
    kept = {NAMES[part]: tables[:, affine.parts[part]] for part in RECORDED if part != EXTERNAL}
    return Snapshots(**kept, external=w.T)


def _refused(affine: AffineMap, tables: Array, vectors: Array, track: Track) -> bool:
    """Whether a friction level is below zero, by more than the rounding of its terms."""
    caps = tables[:, affine.parts[CAPS]]
    if caps.min() >= 0:
        return False
    sizes, n = np.abs(vectors), len(track.largest)
    sizes[:, :n] = np.maximum(sizes[:, :n], track.largest)
    terms = sizes @ np.abs(affine.rows(CAPS)).T
    return bool(without_rounding(caps, terms).min() < 0)
