"""How redundant ports share a load: the largest fraction of a breakaway effort is the least.

Where efforts may change along the rows of ``share``, a weighted sum of efforts that no row
changes is a load that its ports carry, whatever they share: a circuit, if no port can be left
out. Its ports carry at least the fraction ``|load| / sum of |weight| cap``, and the circuit of
the highest such fraction reaches it. Once its ports are settled the others share along what
directions are left.

That circuit is found by Stiefel's exchange (Numer. Math. 1, 1959; Cheney, Introduction to
Approximation Theory, ch. 2), the simplex method on the dual of that linear program: a reference
is one port more than there are directions, and the fraction of its load rises as one of its ports
is exchanged for one that would carry more. Where the port that goes has no weight the fraction
stays; which of several goes is told by their order, so that no reference comes twice (Dantzig,
Orden, Wolfe, Pacific J. Math. 5, 1955).
"""

from dataclasses import dataclass

import numpy as np

from codegen.standalone.arrays import Array, EvaluationError, Places
from codegen.tuning import TUNING


def fair_share(efforts: Array, share: Array, caps: Array) -> Array:
    """Efforts moved along ``share``: the largest fraction of a port's cap is the least possible.

    Then the next largest of the ports that remain, and so on: there is one answer. So redundant
    ports hold whenever any way of sharing the load would hold. A port with no cap carries nothing,
    if the others can carry its part. Raises `EvaluationError` where exchanges find no end.

    >>> fair_share(np.array([30.0, 0.0]), np.array([[1.0, -1.0]]), np.array([100.0, 200.0]))
    array([10., 20.])
    """
    caps = np.maximum(caps, TUNING.least_cap * np.abs(efforts).max(initial=0.0) + TUNING.tiny)
    efforts, rows = np.array(efforts, dtype=float), np.array(share, dtype=float)
    left = np.arange(len(efforts))
    while len(rows) and len(left):
        rows, pivots = _reduced(rows, left)
        left = left[np.abs(rows[:, left]).max(axis=0, initial=0.0) > TUNING.nothing]
        found = Sharing(efforts, caps, left).settled(rows, pivots)
        moves = found.weights[found.pivots] != 0.0
        efforts = efforts + found.ways[moves] @ found.rows[moves]
        left, rows = left[found.weights[left] == 0.0], found.rows[~moves]
    return efforts


def _reduced(rows: Array, ports: Places) -> tuple[Array, Places]:
    """Gauss-Jordan elimination on the columns of these ports, each time by the largest pivot."""
    rows, pivots = rows.copy(), []
    least = TUNING.nothing * np.abs(rows).max()
    for k in range(min(len(rows), len(ports))):
        sizes = np.abs(rows[k:, ports])
        at, place = divmod(int(sizes.argmax()), len(ports))
        if not sizes[at, place] > least:
            break
        port = int(ports[place])
        pivot = rows[k + at] / rows[k + at, port]
        rows[k + at] = rows[k]
        rows -= rows[:, port, None] * pivot
        rows[k] = pivot
        pivots.append(port)
    return rows[: len(pivots)], np.array(pivots, dtype=np.intp)


@dataclass(frozen=True)
class Reference:
    """Directions by rows, of which each has one of ``pivots`` to itself, and one port more.

    ``weights``: of each port's effort in their load. ``ways``: how far to go along each direction
    for these ports to carry the ``fraction`` of their caps, each on its side.
    """

    rows: Array
    pivots: Places
    last: int
    weights: Array
    fraction: float
    sides: Array
    ways: Array


@dataclass(frozen=True)
class Sharing:
    """Efforts, what each port can hold, and the ports that are left to share and that move."""

    efforts: Array
    caps: Array
    left: Places

    def settled(self, rows: Array, pivots: Places) -> Reference:
        """The reference with the highest fraction; ports that each move alone carry none."""
        last = self._first(rows, pivots)
        if last is None:
            free = np.zeros(len(self.caps))
            free[pivots] = 1.0
            return Reference(rows, pivots, -1, free, 0.0, free, -self.efforts[pivots])
        first = found = self._reference(rows, pivots, last, np.ones(len(self.caps)))
        for _ in range(TUNING.exchanges):
            port, side = self._entering(found)
            if port is None:
                return found
            leaving = _leaving(found, port, side, first)
            after = self._exchanged(rows, found, leaving, port, side)
            stays = found.weights[leaving] == 0.0
            if after is None or not (stays or after.fraction > found.fraction):
                return found  # by rounding alone that port would carry more
            found = after
        raise EvaluationError(
            f"how {len(self.left)} ports that hold share a load was not found in "
            f"{TUNING.exchanges} exchanges"
        )

    def _first(self, rows: Array, pivots: Places) -> int | None:
        """The port that has with pivots the load of the highest fraction; none if all are."""
        beside = np.ones(len(self.caps), dtype=bool)
        beside[pivots] = False
        others = self.left[beside[self.left]]
        if not len(others):
            return None
        loads = self.efforts[others] - self.efforts[pivots] @ rows[:, others]
        most = self.caps[others] + self.caps[pivots] @ np.abs(rows[:, others])
        return int(others[np.argmax(np.abs(loads) / most)])

    def _reference(self, rows: Array, pivots: Places, last: int, sides: Array) -> Reference:
        """Of pivots and one port more; ``sides``: those of ports without weight."""
        weights = np.zeros(len(sides))
        weights[pivots] = -_cleaned(rows[:, last])
        weights[last] = 1.0
        load = weights @ self.efforts
        fraction = float(abs(load) / (np.abs(weights) @ self.caps))
        sides = np.where(weights != 0.0, np.copysign(1.0, load) * np.sign(weights), sides)
        ways = fraction * sides[pivots] * self.caps[pivots] - self.efforts[pivots]
        return Reference(rows, pivots, last, weights, fraction, sides, ways)

    def _entering(self, at: Reference) -> tuple[int | None, float]:
        """The port that would carry the largest fraction above the reference's, and its side."""
        sums = self.efforts + at.ways @ at.rows
        terms = np.abs(self.efforts) + np.abs(at.ways) @ np.abs(at.rows)
        above = np.abs(sums) - at.fraction * self.caps > TUNING.exchanged * terms
        above[at.pivots] = above[at.last] = False
        ports = self.left[above[self.left]]
        if not len(ports):
            return None, 0.0
        port = int(ports[np.argmax(np.abs(sums[ports]) / self.caps[ports])])
        return port, float(np.sign(sums[port]))

    def _exchanged(
        self, rows: Array, at: Reference, leaving: int, port: int, side: float
    ) -> Reference | None:
        """One port for another on this side; None where those move in fewer directions."""
        ports = np.sort([port, *(one for one in (*at.pivots, at.last) if one != leaving)])
        table, pivots = _reduced(rows, ports)
        if len(pivots) < len(rows):
            return None
        sides = at.sides.copy()
        sides[port] = side
        last = next(one for one in ports.tolist() if one not in pivots)
        return self._reference(table, pivots, last, sides)


def _cleaned(columns: Array) -> Array:
    """Entries, less what is rounding beside one and the largest of their column."""
    sizes = np.abs(columns)
    least = TUNING.nothing * np.maximum(1.0, sizes.max(axis=0))
    return np.where(sizes > least, columns, 0.0)


def _leaving(at: Reference, port: int, side: float, first: Reference) -> int:
    """The pivot that a port on this side turns first; where it turns none, the port beside them."""
    against = side * _cleaned(at.rows[:, port]) * at.sides[at.pivots]
    sizes = np.abs(at.weights[at.pivots])
    turned = np.flatnonzero(against > 0.0)
    if len(turned):
        turned = turned[_least(sizes[turned] / against[turned])]
        return int(at.pivots[_in_turn(at, turned, against[turned], first)])
    kept = np.flatnonzero((against == 0.0) & (sizes > 0.0))
    found = _in_turn(at, np.append(kept, -1), np.append(sizes[kept], np.inf), first)
    return at.last if found < 0 else int(at.pivots[found])


def _in_turn(at: Reference, rows: Places, by: Array, first: Reference) -> int:
    """Of these rows, where -1 is none, that whose port is the first to turn, if the ports of the
    first reference had loads of their own, on their sides and each far smaller than the one before.
    """
    if len(rows) == 1:
        return int(rows[0])
    scales = at.sides[at.pivots[rows]] / by
    for port in np.sort([*first.pivots, first.last]):
        near = _least(scales * _cleaned(at.rows[:, port])[rows] * first.sides[port])
        rows, scales = rows[near], scales[near]
        if len(rows) == 1:
            break
    return int(rows[0])


def _least(values: Array) -> Array:
    """Which are the least, but for rounding."""
    least = float(values.min())
    return np.asarray(values <= least + TUNING.nothing * abs(least))
