"""Sparse elimination modulo a prime: exact ranks at the price of integer arithmetic."""

from collections.abc import Iterable

from bondgraph.algebra.residues import PRIME

Row = dict[int, int]
"""A sparse row of residues: column to entry, no zeros."""


class ResidueRows:
    """Sparse rows modulo the prime, eliminated column by column."""

    def __init__(self, rows: Iterable[Row]) -> None:
        self.rows = list(rows)
        self.columns: dict[int, set[int]] = {}
        self.pivots: dict[int, int] = {}
        for at, row in enumerate(self.rows):
            for column in row:
                self.columns.setdefault(column, set()).add(at)

    def pivot(self, column: int, jordan: bool = True) -> bool:
        """Eliminate a column with its shortest free row; False if it depends on earlier ones.

        With ``jordan`` the column also leaves the rows of earlier pivots; without, the pivot's row
        is done with and forgotten.
        """
        free = [at for at in self.columns.get(column, ()) if at not in self.pivots]
        if not free:
            return False
        best = min(free, key=lambda at: (len(self.rows[at]), at))
        scale = pow(self.rows[best][column], -1, PRIME)
        for at in list(self.columns[column] - {best}):
            self._subtract(at, best, self.rows[at][column] * scale % PRIME)
        if jordan:
            self.pivots[best] = column
        else:
            for other in self.rows[best]:
                self.columns[other].discard(best)
            self.rows[best] = {}
        return True

    def pivots_meeting(self, column: int) -> list[int]:
        """The pivot columns whose rows hold this column."""
        return [self.pivots[at] for at in self.columns.get(column, ()) if at in self.pivots]

    def _subtract(self, at: int, source: int, factor: int) -> None:
        row = self.rows[at]
        for column, entry in self.rows[source].items():
            left = (row.get(column, 0) - factor * entry) % PRIME
            if left:
                row[column] = left
                self.columns.setdefault(column, set()).add(at)
            elif column in row:
                del row[column]
                self.columns[column].discard(at)
