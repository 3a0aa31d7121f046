"""Friction ports in blocks that do not touch one another at an instant, and ways to stick and slip."""

from collections.abc import Generator, Mapping, Sequence
from itertools import product

import numpy as np
import scipy

from bondgraph.errors import BondGraphError
from codegen.model.snapshot import Mode, Snapshot
from codegen.modes.closed import ClosedModel
from codegen.standalone.matrices import Numbers

ENUMERATED = 8
"""Of a block of so many ports all ways are tried; in a larger one ports turn one after the other."""

TURNS = 20
"""So often for each port of a large block one turns, before it is given up."""


def slipping_as(model: ClosedModel, shot: Snapshot, mode: Mode, sides: Mapping[int, int]) -> Mode:
    """The mode with friction slipping the way it moves, or on these ``sides``; switches as they are."""
    slips = shot.y[model.friction_readings]
    return tuple(
        sign if switch is not None else sides.get(i, 1 if slip > 0 else -1)
        for i, (sign, switch, slip) in enumerate(zip(mode, model.switching, slips, strict=True))
    )


def blocks_of(model: ClosedModel, numbers: Numbers, ports: list[int]) -> list[list[int]]:
    """The ports by what each one's effort moves at once or accelerates; one block where laws join them."""
    if len(ports) < 2 or model.program.joint:
        return [ports]
    rows = np.array(model.friction_readings)[ports]
    columns = np.array(model.friction_inputs)[ports]
    moved = numbers.F[rows] @ numbers.Q[:, columns]
    touch = (moved != 0) | (numbers.D[np.ix_(rows, columns)] != 0)
    together = tuple(0 if i in ports else 1 for i in range(len(model.switching)))
    try:
        shared = model.hold(together, numbers).share
    except BondGraphError:
        return [ports]
    # What none of them rules alone, held together, joins them as well.
    touch |= (shared.T != 0).astype(int) @ (shared != 0).astype(int) > 0
    count, label = scipy.sparse.csgraph.connected_components(
        scipy.sparse.csr_array(touch), directed=False
    )
    return [[ports[k] for k in np.flatnonzero(label == block)] for block in range(count)]


Way = Mapping[int, int]
"""How the ports of a block stick and slip, by port."""


def ways_to_rub(
    previous: Mode, block: Sequence[int], touched: frozenset[int]
) -> Generator[Way, Way, None]:
    """The ways of a block to try, those that stick most first, then those that change least.

    After each is sent where ports that contradict it would go: a large block follows that.
    """
    if len(block) <= ENUMERATED:
        for choice in _choices(previous, block, touched):
            yield dict(zip(block, choice, strict=True))
        return
    seen: set[tuple[int, ...]] = set()
    way = dict.fromkeys(block, 0)
    for _ in range(TURNS * len(block)):
        seen.add(tuple(way.values()))
        turned = {i: sign for i, sign in (yield way).items() if i in way}
        if not turned:
            return
        all_at_once = way | turned
        again = tuple(all_at_once.values()) in seen
        way = way | dict([min(turned.items())]) if again else all_at_once
        if tuple(way.values()) in seen:
            return


def _choices(
    previous: Mode, block: Sequence[int], touched: frozenset[int]
) -> list[tuple[int, ...]]:
    kept = [k for k, i in enumerate(block) if i not in touched]

    def rank(choice: tuple[int, ...]) -> tuple[int, int]:
        return -choice.count(0), sum(choice[k] != previous[block[k]] for k in kept)

    return sorted(product(*((0, previous[i] or 1, -(previous[i] or 1)) for i in block)), key=rank)


def turned_to(mode: Mode, *ways: Way) -> Mode:
    """The mode with ports going these ways."""
    changed = list(mode)
    for way in ways:
        for i, sign in way.items():
            changed[i] = sign
    return tuple(changed)
