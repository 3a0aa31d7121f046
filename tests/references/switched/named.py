"""Circuits of power electronics, by name, as networks that switch."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import pi

import numpy as np

from references.switched.network import Branch, Network, Wave, joined


def pulses(period: float, duty: float, end: float, begin: float = 0.0) -> tuple[float, ...]:
    """When a switch changes over that turns on at ``begin`` and after every period, for a part of it."""
    starts = begin + period * np.arange(int(np.ceil((end - begin) / period)))
    return tuple(float(t) for start in starts for t in (start, start + duty * period) if t < end)


def buck(
    V: float, L: float, C: float, R: float, instants: Sequence[float], current: float = 0.0,
    voltage: float = 0.0,
) -> Network:  # fmt: skip
    """A switch from V into a coil, a capacitor and a resistance; a diode from the ground."""
    return joined(
        Branch("V", "V0", 0, 1, wave=Wave(V)), Branch("K", "K0", 1, 2, instants=tuple(instants)),
        Branch("D", "D0", 0, 2), Branch("L", "L0", 2, 3, L, start=current),
        Branch("C", "C0", 3, 0, C, start=voltage), Branch("R", "R0", 3, 0, R),
    )  # fmt: skip


def boost(
    V: float, L: float, C: float, R: float, instants: Sequence[float], voltage: float
) -> Network:
    """A coil from V to a switch to ground, and by a diode to a capacitor and a resistance."""
    return joined(
        Branch("V", "V0", 0, 1, wave=Wave(V)), Branch("L", "L0", 1, 2, L),
        Branch("K", "K0", 2, 0, instants=tuple(instants)), Branch("D", "D0", 2, 3),
        Branch("C", "C0", 3, 0, C, start=voltage), Branch("R", "R0", 3, 0, R),
    )  # fmt: skip


def half_bridge(
    V: float, L: float, R: float, on: float, upper: Sequence[float], lower: Sequence[float]
) -> Network:
    """Two sources of V, two switches behind ``on`` with diodes across them, a coil and a resistance."""
    return joined(
        Branch("V", "V0", 0, 1, wave=Wave(V)), Branch("V", "V1", 2, 0, wave=Wave(V)),
        *_leg(0, 1, 3, 2, 4, on, upper, lower),
        Branch("L", "L0", 3, 6, L), Branch("R", "R0", 6, 0, R),
    )  # fmt: skip


def full_bridge(
    V: float, L: float, R: float, on: float, first: Sequence[float], second: Sequence[float],
    pause: float, current: float,
) -> Network:  # fmt: skip
    """Two legs of two switches with diodes; ``first`` and ``second``: when each leg's upper one turns.

    ``pause``: how long both of a leg are off before one turns on. ``current``: of the load at first, when
    all switches are off; without it nothing tells where between its rails the load is.
    """
    legs = []
    for at, instants in enumerate((first, second)):
        upper = [t + pause * (k % 2 == 0) for k, t in enumerate(instants)]
        lower = [0.5 * pause] + [t + pause * (k % 2) for k, t in enumerate(instants)]
        legs += _leg(2 * at, 1, 2 + 3 * at, 0, 3 + 3 * at, on, upper, lower)
    return joined(
        Branch("V", "V0", 0, 1, wave=Wave(V)), *legs,
        Branch("L", "L0", 2, 8, L, start=current), Branch("R", "R0", 8, 5, R),
    )  # fmt: skip


def _leg(
    at: int, plus: int, out: int, minus: int, inner: int, on: float, upper: Sequence[float],
    lower: Sequence[float],
) -> list[Branch]:  # fmt: skip
    """Without ``on`` a switch and the diode across it would share what nothing determines."""
    return [
        Branch("K", f"K{at}", plus, inner, instants=tuple(upper)),
        Branch("R", f"Ron{at}", inner, out, on), Branch("D", f"D{at}", out, plus),
        Branch("K", f"K{at + 1}", inner + 1, minus, instants=tuple(lower)),
        Branch("R", f"Ron{at + 1}", out, inner + 1, on), Branch("D", f"D{at + 1}", minus, out),
    ]  # fmt: skip


def _mains(V: float, f: float, phase: float, at: int) -> Wave:
    return Wave(amplitude=V, frequency=f, phase=phase - 2 * pi * at / 3)


def six_pulse(
    V: float, f: float, phase: float, L: float, R: float, Ls: float = 0.0, more: float = 0.0
) -> Network:
    """Three phases, each behind Ls where there is one, six diodes, a choke L and a resistance R."""
    made, plus, minus = [], 7, 8
    for k in range(3):
        made.append(Branch("V", f"V{k}", 0, k + 1, wave=_mains(V, f, phase, k)))
        if Ls:
            made.append(Branch("L", f"Ls{k}", k + 1, k + 4, Ls))
        a = k + 4 if Ls else k + 1
        made.append(Branch("D", f"D{k}", a, plus, more=more))
        made.append(Branch("D", f"D{k + 3}", minus, a, more=more))
    made += [Branch("L", "L0", plus, 9, L), Branch("R", "R0", 9, minus, R)]
    return joined(*(made if Ls else [_moved(b, 3) for b in made]))


def _moved(b: Branch, by: int) -> Branch:
    """The nodes from 7 on renumbered where those of the source inductances are left out."""
    return replace(b, tail=b.tail - by * (b.tail >= 7), head=b.head - by * (b.head >= 7))


def vienna(
    V: float, f: float, phase: float, L: float, C: float, R: float,
    instants: Sequence[Sequence[float]], charged: float, neutral: float,
) -> Network:  # fmt: skip
    """Three phases behind coils, six diodes to two capacitors, a switch from each phase to between them.

    A resistance ``neutral`` ties that place to the ground: without it nothing tells whether the last diode
    to conduct does once no other does.
    """
    made, plus, middle, minus = [], 7, 8, 9
    for k in range(3):
        made += [
            Branch("V", f"V{k}", 0, k + 1, wave=_mains(V, f, phase, k)),
            Branch("L", f"L{k}", k + 1, k + 4, L),
            Branch("D", f"D{k}", k + 4, plus), Branch("D", f"D{k + 3}", minus, k + 4),
            Branch("K", f"K{k}", k + 4, middle, instants=tuple(instants[k])),
        ]  # fmt: skip
    return joined(
        *made, Branch("C", "C0", plus, middle, C, start=charged),
        Branch("C", "C1", middle, minus, C, start=charged), Branch("R", "R0", plus, minus, R),
        Branch("R", "R1", middle, 0, neutral),
    )  # fmt: skip


def bridge_chain(
    count: int, V: float, f: float, Rs: float, more: float, L: float, R: float
) -> Network:
    """Bridges of four diodes, each with a source of its own phase, in series on a coil and a resistance."""
    made, minus = [], 0
    for k in range(count):
        a, b, plus = 3 * k + 1, 3 * k + 2, 3 * k + 3
        wave = Wave(amplitude=V * (1 + 0.1 * k), frequency=f, phase=0.4 + 0.7 * k)
        made.append(Branch("S", f"S{k}", b, a, more=Rs, wave=wave))
        ways = ((a, plus), (b, plus), (minus, a), (minus, b))
        made += [Branch("D", f"D{4 * k + j}", *way, more=more) for j, way in enumerate(ways)]
        minus = plus
    last = 3 * count + 1
    return joined(
        *made, Branch("L", "L0", minus, last, L), Branch("R", "R0", last, 0, R),
    )  # fmt: skip


def opened_inductor(V: float, L: float, R: float, Rd: float, opens: float) -> Network:
    """A switch that opens a coil's current into a diode and a resistance."""
    return joined(
        Branch("V", "V0", 0, 1, wave=Wave(V)), Branch("K", "K0", 1, 2, on=True, instants=(opens,)),
        Branch("L", "L0", 2, 3, L), Branch("R", "R0", 3, 0, R), Branch("D", "D0", 4, 2),
        Branch("R", "R1", 0, 4, Rd),
    )  # fmt: skip
