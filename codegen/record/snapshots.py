"""Everything at the samples of a run, as tables with a row for each of them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from codegen.inputs.signal import Signal
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
    """Everything at the samples: of affine modes in one product each, else one by one."""
    found = _by_modes(model, times, signals, track)
    if found is not None:
        return found
    shots = [
        model.at(t, s, [signal.piece(t) for signal in signals], mode)
        for t, s, mode in zip(times.tolist(), track.vectors, track.modes, strict=True)
    ]
    names = [NAMES[part] for part in RECORDED]
    return Snapshots(*(np.array([getattr(shot, name) for shot in shots]) for name in names))


def _by_modes(
    model: ClosedModel, times: Array, signals: Sequence[Signal], track: Track
) -> Snapshots | None:
    """None where a mode is not affine or a friction level is below zero."""
    if not model.program.affine:
        return None
    modes = list(dict.fromkeys(track.modes))
    number = {mode: at for at, mode in enumerate(modes)}
    which = np.array([number[mode] for mode in track.modes])
    w = np.array([signal.sampled(times) for signal in signals]).reshape(-1, len(times))
    dw = np.zeros_like(w)
    if model.program.rated and len(signals):
        dw[:] = [signal.sampled(times, rates=True) for signal in signals]
    vectors = np.column_stack([track.vectors, w.T, dw.T, np.ones(len(times))])
    tables: Array | None = None
    for mode in modes:
        affine = model.affine_map(mode, len(signals))
        if affine is None:
            return None
        if tables is None:
            tables = np.zeros((len(times), len(affine.matrix)))
        tables[which == number[mode]] = vectors[which == number[mode]] @ affine.matrix.T
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
