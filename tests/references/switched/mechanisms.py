"""Bodies with dogs, springs and friction between them, by name, as networks that switch."""

from __future__ import annotations

from collections.abc import Sequence

from references.switched.network import Branch, Network, Wave, joined


def jenkins(
    springs: Sequence[float], levels: Sequence[float], wave: Wave, mass: float = 0.0
) -> Network:
    """Springs (as L), each in series with a slider, side by side from an imposed speed to the ground.

    With a mass the wave is a force on it.
    """
    drive = [Branch("C", "C0", 1, 0, mass), Branch("I", "I0", 0, 1, wave=wave)]
    made = drive if mass else [Branch("V", "V0", 0, 1, wave=wave)]
    for k, (spring, level) in enumerate(zip(springs, levels, strict=True)):
        made += [Branch("L", f"L{k}", 1, k + 2, spring), Branch("F", f"F{k}", k + 2, 0, level)]
    return joined(*made)


def dog_beside_clutch(
    masses: tuple[float, float, float], speeds: tuple[float, float, float], level: float,
    force: float, closes: float,
) -> Network:  # fmt: skip
    """Three bodies: friction between the first two, a dog that closes between the last two.

    A force pulls the first.
    """
    bodies = zip(masses, speeds, strict=True)
    made = [Branch("C", f"C{k}", k + 1, 0, m, start=v) for k, (m, v) in enumerate(bodies)]
    return joined(
        *made, Branch("F", "F0", 1, 2, level), Branch("K", "K0", 2, 3, instants=(closes,)),
        Branch("I", "I0", 0, 1, wave=Wave(force)),
    )  # fmt: skip


def two_dogs(
    masses: tuple[float, float], speeds: tuple[float, float], force: float,
    first: Sequence[float], second: Sequence[float],
) -> Network:  # fmt: skip
    """Two bodies with two dogs between them, a force on the first."""
    bodies = zip(masses, speeds, strict=True)
    made = [Branch("C", f"C{k}", k + 1, 0, m, start=v) for k, (m, v) in enumerate(bodies)]
    return joined(
        *made, Branch("K", "K0", 1, 2, instants=tuple(first)),
        Branch("K", "K1", 1, 2, instants=tuple(second)), Branch("I", "I0", 0, 1, wave=Wave(force)),
    )  # fmt: skip
