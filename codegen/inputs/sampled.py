"""Inputs over time from samples: polynomials between points, each made as it is asked for."""

import hashlib
from abc import abstractmethod
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bondgraph.errors import SignalError, nearest
from codegen.data.columns import read_columns
from codegen.inputs.pieces import Piece, constant_piece
from codegen.inputs.signal import Signal
from codegen.numbers.arrays import Array, read_only, real_array
from codegen.numbers.latest import Latest
from codegen.tuning import TUNING

KINDS = ("linear", "held", "pchip")
"""Between samples: a straight line; the value of the sample before; cubics that do not overshoot."""

SHOWN = 8
"""Samples that a signal shows when it is printed; of more a digest stands for them."""


class Points(Signal):
    """A row of polynomials, each from a point in time on, and before the first the value there.

    What is asked for at a time is found by halving, so an instant of a long run costs what one of a short
    run does, and pieces that no one asks for are not made.
    """

    @property
    @abstractmethod
    def powers(self) -> tuple[Array, Array]:
        """Where each piece is told from [s], and by rows its coefficients, lowest power first."""

    @property
    @abstractmethod
    def jumps(self) -> NDArray[np.bool_] | None:
        """Which breakpoints it jumps at; None where it jumps at none."""

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """All of them, made together."""
        starts, rows = (part.tolist() for part in self.powers)
        return tuple(map(_piece, starts, rows))

    def piece(self, t: float) -> Piece:
        """The piece that holds at t and just after."""
        at = bisect_right(self.breakpoints, t)
        return self._made.of(at, lambda: _piece(*(part[at].tolist() for part in self.powers)))

    def first_jump(self, begin: float, end: float) -> float | None:
        """The first time after ``begin``, up to ``end`` [s], at which it jumps; None if it never does."""
        if self.jumps is None:
            return None
        breaks = np.array(self.breakpoints, dtype=float)
        found = np.flatnonzero(self.jumps & (breaks > begin) & (breaks <= end))
        return float(breaks[found[0]]) if len(found) else None

    def sampled(self, times: Array, rates: bool = False) -> Array:
        """The values at many times, or how fast they change; at a breakpoint just after it."""
        which = np.searchsorted(np.array(self.breakpoints, dtype=float), times, side="right")
        starts, rows = self.powers
        if rates:
            # The row keeps its length, as a piece's derivative does.
            rows = np.pad(rows[:, 1:] * np.arange(1, rows.shape[1]), ((0, 0), (0, 1)))
        tau, own = times - starts[which], rows[which]
        total = np.zeros(len(times))
        for column in own.T[::-1]:
            total = total * tau + column
        # What may be rounding of terms that cancel is told as a piece tells it.
        near = np.abs(total) <= TUNING.cancelled * np.abs(own).max(axis=1)
        for at in np.flatnonzero(near & (total != 0)).tolist():
            k = int(which[at])
            piece = _piece(*(part[k].tolist() for part in (starts, rows)))
            total[at] = piece.values(times[at : at + 1])[0]
        return total

    @cached_property
    def _made(self) -> Latest[int, Piece]:
        """The pieces asked for last: a run looks at one again and again."""
        return Latest(2)


@dataclass(frozen=True, init=False, repr=False)
class Sampled(Points):
    """Samples over time: straight lines between them; the first and last values are held outside.

    ``times`` [s] must increase; both arrays have the same length, two or more. ``kind``: "linear"; "held",
    each value until the next; or "pchip", cubics of continuous slope that rise and fall only where the
    samples do (Fritsch and Butland 1984, as scipy's `PchipInterpolator`). All are exact in every run.

    Raises `SignalError` for other arrays, and for what is not finite.

    >>> [Sampled([0, 1, 3], [0, 10, 30], kind)(2) for kind in ("linear", "held")]
    [20.0, 10.0]
    """

    times: tuple[float, ...]
    values: tuple[float, ...]
    kind: str

    def __init__(self, times: ArrayLike, values: ArrayLike, kind: str = "linear") -> None:
        try:
            t, v = (real_array(array) for array in (times, values))
        except (TypeError, ValueError) as error:
            raise SignalError(f"samples: times and values must be numbers: {error}") from None
        if t.ndim != 1 or t.shape != v.shape or len(t) < 2:
            raise SignalError(
                f"samples need times and values of one length, two or more, not {t.shape} "
                f"and {v.shape}"
            )
        if not (np.isfinite(t).all() and np.isfinite(v).all()):
            raise SignalError("samples: a time or a value is not finite")
        if not (np.diff(t) > 0).all():
            raise SignalError("samples: the times must increase")
        if kind not in KINDS:
            raise SignalError(
                f"samples: kind={kind!r}{nearest(str(kind), KINDS)}; there are {', '.join(KINDS)}"
            )
        object.__setattr__(self, "times", tuple(t.tolist()))
        object.__setattr__(self, "values", tuple(v.tolist()))
        object.__setattr__(self, "kind", kind)

    @classmethod
    def read(
        cls, source: Any, time: str | int = "t", value: str | int = "v", kind: str = "linear"
    ) -> "Sampled":
        """Two columns of a file or of a frame as an input.

        ``source``: a path that ends in ``.csv``, ``.tsv``, ``.txt``, ``.parquet``, ``.mat`` or ``.nc``, or
        what gives a column by its name: a data frame of pandas, a data set of xarray, a table of pyarrow, a
        mapping.
        ``time`` and ``value``: the names of the columns, or in files of text their numbers, counted from 1.

        Raises `SignalError` naming file, line and column for what cannot be used, `MissingExtraError` without
        the package that reads the file.

        >>> Sampled.read({"t": [0, 1, 3], "speed": [0, 10, 30]}, value="speed")(2)
        20.0
        """
        found = read_columns(source, (time, value))
        t, v = found.arrays
        if len(t) < 2:
            raise SignalError(f"{found.source}: {len(t)} row(s); samples need two at least")
        back = np.flatnonzero(~(np.diff(t) > 0))
        if len(back):
            row = int(back[0]) + 1
            raise SignalError(
                f"{found.place(row)}, column {found.names[0]!r}: times must increase, but "
                f"{float(t[row])!r} follows {float(t[row - 1])!r}; sort the rows, and keep one of each"
            )
        return cls(t, v, kind)

    @cached_property
    def breakpoints(self) -> tuple[float, ...]:
        """The sample times; of held values all but the first, at which nothing changes."""
        return self.times[1:] if self.kind == "held" else self.times

    @cached_property
    def powers(self) -> tuple[Array, Array]:
        """A level, the polynomials, a level; of held values the values."""
        t, v = np.array(self.times), np.array(self.values)
        if self.kind == "held":
            return read_only(t), read_only(v[:, None])
        rows = _lines(t, v) if self.kind == "linear" else _cubics(t, v)
        levels = np.pad(v[[0, -1], None], ((0, 0), (0, rows.shape[1] - 1)))
        starts = np.concatenate([t[:1], t])
        return read_only(starts), read_only(np.concatenate([levels[:1], rows, levels[1:]]))

    @cached_property
    def jumps(self) -> NDArray[np.bool_] | None:
        """Those of held values."""
        return read_only(stepping(np.array(self.values))) if self.kind == "held" else None

    def __repr__(self) -> str:
        kind = "" if self.kind == "linear" else f", kind={self.kind!r}"
        return f"Sampled({shown(self.times, self.values)}{kind})"


def stepping(values: Array) -> NDArray[np.bool_]:
    """Between which of these values one after the other there is more than rounding."""
    sizes = np.abs(values[1:]) + np.abs(values[:-1])
    return np.asarray(np.abs(np.diff(values)) > TUNING.together * sizes, dtype=np.bool_)


def shown(times: Sequence[float], values: Sequence[float]) -> str:
    """Samples as a signal shows them: all of a few; of more how many, from when to when, and a digest."""
    if len(times) <= SHOWN:
        return f"times={times!r}, values={values!r}"
    digest = hashlib.sha256(np.array([times, values]).tobytes()).hexdigest()[:16]
    return f"<{len(times)} samples from {times[0]!r} to {times[-1]!r} s, sha256 {digest}>"


def _piece(start: float, row: Sequence[float]) -> Piece:
    """A polynomial told from a time; a level where no power has a factor."""
    return Piece(start, ((0, tuple(row)),)) if any(row[1:]) else constant_piece(start, row[0])


def _lines(t: Array, v: Array) -> Array:
    return np.stack([v[:-1], np.diff(v) / np.diff(t)], axis=1)


def _cubics(t: Array, v: Array) -> Array:
    # scipy's interpolators are loaded only where such samples are.
    from scipy.interpolate import PchipInterpolator

    return np.asarray(PchipInterpolator(t, v).c.T[:, ::-1], dtype=float)
