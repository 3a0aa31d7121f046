"""Polynomials over segments in turn: what is between those that meet a function, and where it goes on."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from bondgraph.errors import SignalError
from codegen.inputs.segments import DEGREE
from codegen.numbers.arrays import Array, Flags

MOST = 100_000
"""Segments beyond which a function is noise, or data."""

SINGULAR = 16.0
"""So many of the narrowest segments side by side may have no polynomial: at a jump, where a root begins."""

Called = Callable[[Array], Array]
"""A function of many times [s], in turn."""


@dataclass(frozen=True)
class Fits:
    """Segments in turn: where they begin, centres, half-widths, and coefficients in ``(t - centre)/half``.

    ``smooth``: whether it goes on where the one before it ends.
    """

    begins: Array
    centres: Array
    halves: Array
    powers: Array
    smooth: Flags


class Kept(NamedTuple):
    """Segments that meet the function, and what they may miss it by."""

    centres: Array
    halves: Array
    powers: Array
    allowed: Array


def in_turn(
    kept: Sequence[Kept], called: Called, samples: Array, ends: Sequence[float], narrowest: float
) -> Fits:
    """Segments from the first to the last of ``ends`` [s], each from where the one before it ends.

    ``narrowest`` [s]: what was not halved any more, and has levels where no polynomial met the function.
    """
    centres, halves, powers, allowed = _with_levels(_sorted(kept), called, samples, ends, narrowest)
    begins = centres - halves
    first, last = _at_ends(powers)
    apart = np.abs(first[1:] - last[:-1])
    smooth = np.append(False, apart <= SINGULAR * (allowed[1:] + allowed[:-1]))
    for end in ends[:-1]:
        own = np.searchsorted(centres, end)
        begins[own], smooth[own] = end, False
    return Fits(begins, centres, halves, powers, np.asarray(smooth, dtype=np.bool_))


def _sorted(kept: Sequence[Kept]) -> Kept:
    every = Kept(*map(np.concatenate, zip(*kept, strict=True)))
    order = np.argsort(every.centres, kind="stable")
    return Kept(*(part[order] for part in every))


def _with_levels(
    kept: Kept, called: Called, samples: Array, ends: Sequence[float], narrowest: float
) -> Kept:
    """The same with levels where none meets it: the value at such a moment's begin, and at samples within."""
    begins = np.append(kept.centres - kept.halves, ends[-1])
    afters = np.append(ends[0], kept.centres + kept.halves)
    gaps = begins - afters
    if not len(kept.centres) or gaps.max() > SINGULAR * narrowest:
        raise SignalError(refusal(float(afters[np.argmax(gaps)]), ends))
    found = [kept]
    before, after = _at_ends(kept.powers)
    gained = np.append(np.append(0.0, np.abs(after - before) / (2 * kept.halves)), 0.0)
    for k in np.flatnonzero(gaps > narrowest / 2).tolist():
        a, b = float(afters[k]), float(begins[k])
        parts = np.array([a, *samples[(samples > a) & (samples < b)], b])
        levels = np.pad(called(parts[:-1])[:, None], ((0, 0), (0, DEGREE)))
        # A level misses what the function gains over it, by what it gains before and after.
        room = np.full(len(levels), 2 * (b - a) * gained[k : k + 2].max())
        found.append(Kept((parts[:-1] + parts[1:]) / 2, np.diff(parts) / 2, levels, room))
    return _sorted(found)


def _at_ends(powers: Array) -> tuple[Array, Array]:
    """What polynomials are where their segments begin and end."""
    signs = (-1.0) ** np.arange(powers.shape[1])
    return powers @ signs, powers.sum(axis=1)


def refusal(near: float, ends: Sequence[float]) -> str:
    """Why a function has no polynomials, and the ways out."""
    return (
        f"does more than {MOST} polynomials can tell between t = {ends[0]:g} and {ends[-1]:g}, first near "
        f"t = {near:.9g}; tell corners and jumps as breakpoints, give a larger tolerance, or, of noise and "
        "data, codegen.Sampled(times, values)"
    )
