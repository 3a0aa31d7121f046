"""How redundant ports share a load: the largest fraction of a breakaway effort is the least.

Where efforts may change along the rows of ``share``, a weighted sum of efforts that no row
changes is a load that its ports carry, whatever they share: a circuit, if no port can be left
out. Its ports carry at least the fraction ``|load| / sum of |weight| cap``, and the circuit of
the highest such fraction reaches it. Once its ports are settled the others share along what
directions are left.
"""

import math
from itertools import combinations

import numpy as np

from codegen.standalone.arrays import Array, EvaluationError, Places
from codegen.tuning import TUNING

MOST_WAYS = 20_000
"""So many choices of ports that may carry a load together are looked at."""


def fair_share(efforts: Array, share: Array, caps: Array) -> Array:
    """Efforts moved along ``share``: the largest fraction of a port's cap is the least possible.

    Then the next largest of the ports that remain, and so on: there is one answer. So redundant
    ports hold whenever any way of sharing the load would hold. A port with no cap carries nothing,
    if the others can carry its part.

    >>> fair_share(np.array([30.0, 0.0]), np.array([[1.0, -1.0]]), np.array([100.0, 200.0]))
    array([10., 20.])
    """
    caps = np.maximum(caps, TUNING.least_cap * np.abs(efforts).max(initial=0.0) + TUNING.tiny)
    efforts = np.array(efforts, dtype=float)
    while len(share):
        least = TUNING.nothing * np.abs(share).max()
        moved = np.flatnonzero(np.abs(share).max(axis=0) > least)
        ports, fractions = _settled(efforts[moved], share[:, moved], caps[moved])
        ports = moved[ports]
        columns = share[:, ports].T
        way = np.linalg.lstsq(
            columns, fractions * caps[ports] - efforts[ports], rcond=TUNING.nothing
        )[0]
        efforts += way @ share
        share = _unmoved(columns) @ share
    return efforts


def _settled(efforts: Array, share: Array, caps: Array) -> tuple[Places, Array]:
    """The ports of the circuit of highest fraction, and that fraction with each port's sign."""
    free, count = share.shape
    if math.comb(count, free + 1) > MOST_WAYS:
        raise EvaluationError(
            f"{count} ports that hold would share loads in too many ways to look at"
        )
    chosen = np.array(list(combinations(range(count), free + 1)), dtype=int)
    if count == free:
        return np.arange(count), np.zeros(count)
    _, sizes, right = np.linalg.svd(share[:, chosen].transpose(1, 0, 2))
    weights = np.zeros((len(chosen), count))
    np.put_along_axis(weights, chosen, right[:, -1], axis=1)
    weights[np.abs(weights) <= TUNING.nothing] = 0.0
    loads = weights @ efforts
    fractions = np.abs(loads) / (np.abs(weights) @ caps)
    fractions[sizes[:, -1] <= TUNING.nothing * sizes[:, 0]] = -1.0
    worst = int(np.argmax(fractions))
    ports = np.flatnonzero(weights[worst])
    signed: Array = fractions[worst] * np.sign(loads[worst]) * np.sign(weights[worst, ports])
    return ports, signed


def _unmoved(columns: Array) -> Array:
    """Combinations of directions that move none of these ports."""
    _, sizes, right = np.linalg.svd(columns)
    rank = int((sizes > TUNING.nothing * sizes[0]).sum())
    found: Array = right[rank:]
    return found
