"""The modes in which a steady state is looked for: from the one that the start shows to those farther off."""

from collections.abc import Generator, Hashable, Mapping, Sequence
from contextlib import suppress
from itertools import combinations, product

import numpy as np

from bondgraph.errors import SimulationError, StructureError
from codegen.inputs.pieces import Piece
from codegen.model.snapshot import Mode
from codegen.modes.choices import Occasion
from codegen.modes.choose import decide
from codegen.modes.closed import ClosedModel
from codegen.modes.trials import Sight
from codegen.numbers.arrays import Array
from codegen.program.records import FrictionPort
from codegen.standalone.switchings import ALL_WAYS, FEW, Broken, flipped
from codegen.tuning import TUNING

Choices = tuple[tuple[int, ...], ...]
"""For each port the signs that it may have, those to be preferred first."""


def choices(model: ClosedModel, told: Mapping[Hashable, str] | None) -> Choices:
    """What each port may do, of some told in the words of events: "on", "off", "stick" or "slip".

    A node may have several jumps, and a jump several nodes: on which side it is, or whether it slides, no
    word tells.
    Raises `StructureError` for a word or a node that there is not.
    """
    asked = {} if told is None else told
    if not isinstance(asked, Mapping):
        raise StructureError(
            f"mode must map nodes to 'on', 'off', 'stick' or 'slip', not be {asked!r}"
        )
    ports = model.program.friction
    names = [port.name for port in ports if not (port.jumps or port.transition)]
    for name in asked:
        if name not in names:
            listed = ", ".join(map(repr, names)) or "none"
            raise StructureError(
                f"mode: {name!r} is no switch and has no dry friction; there are {listed}"
            )
    found: list[tuple[int, ...]] = []
    for port in ports:
        if port.transition is not None and port.switch is not None:
            # What leads to another mode does not rest.
            stays = port.transition.source == port.transition.target
            found.append((0, 1) if stays else (port.switch.sign(False),))
            continue
        words = _words(port)
        word = None if port.jumps else asked.get(port.name)
        if port.name in asked and word not in words and not port.jumps:
            one, other = words
            raise StructureError(f"mode: {port.name!r} can be {one!r} or {other!r}, not {word!r}")
        both = (0, 1) if port.switch is not None else (0, 1, -1)
        found.append(words[word] if word is not None else both)
    return tuple(found)


def _words(port: FrictionPort) -> dict[str, tuple[int, ...]]:
    """The signs that a port may have, by the words of events, what it prefers first."""
    if port.switch is None:
        return {"stick": (0,), "slip": (1, -1)}
    if port.slides:
        # Told to slip, it does either way: which, what it receives tells.
        return {"stick": (1,), "slip": (1, 0)}
    on, off = port.switch.words
    return {on: (port.switch.sign(True),), off: (port.switch.sign(False),)}


def steady_modes(
    model: ClosedModel, pieces: Sequence[Piece], start: Array, allowed: Choices
) -> Generator[Mode, Broken, None]:
    """Modes to try, each once; after each the switches that contradict it are sent, and change over.

    First what the start shows; of many ports then only few changes.
    """
    if not allowed:
        yield ()
        return
    mode = first = _as_allowed(_shown(model, pieces, start), allowed)
    seen: set[Mode] = set()
    while mode not in seen:
        seen.add(mode)
        broken = yield mode
        mode = _as_allowed(flipped(mode, broken), allowed)
    free = [i for i, signs in enumerate(allowed) if len(signs) > 1]
    for count in range(1, (len(free) if len(free) <= ALL_WAYS else FEW) + 1):
        for mode in _changed(first, allowed, free, count):
            if mode not in seen:
                seen.add(mode)
                yield mode


def _changed(first: Mode, allowed: Choices, free: Sequence[int], count: int) -> list[Mode]:
    """The modes in which so many ports do something else, in the order of what they may do."""
    found = []
    for ports in combinations(free, count):
        others = ([sign for sign in allowed[i] if sign != first[i]] for i in ports)
        for signs in product(*others):
            mode = list(first)
            for i, sign in zip(ports, signs, strict=True):
                mode[i] = sign
            found.append(tuple(mode))
    return sorted(found, key=lambda m: [allowed[i].index(m[i]) for i in range(len(m))])


def _as_allowed(mode: Mode, allowed: Choices) -> Mode:
    return tuple(
        sign if sign in signs else signs[0] for sign, signs in zip(mode, allowed, strict=True)
    )


def _shown(model: ClosedModel, pieces: Sequence[Piece], start: Array) -> Mode:
    """How switches are at the start, and which way its slips go."""
    loose = tuple(1 for _ in model.switching)
    seen = Sight(model, 0.0, start, pieces)
    _, now = seen.evaluated(loose)
    slips = np.sign(np.round(model.hangs_on(0.0, now), 12)).astype(int).tolist()
    if not model.program.switched:
        return tuple(slips)
    off = tuple(1 if one is None else one.sign(False) for one in model.switching)
    ahead = TUNING.look_ahead * TUNING.standing
    # Where the start has no consistent mode, another point may.
    with suppress(SimulationError):
        off, *_ = decide(Occasion(model, 0.0, pieces, off, ahead), seen)
    return tuple(
        slip if switch is None else sign
        for slip, switch, sign in zip(slips, model.switching, off, strict=True)
    )
