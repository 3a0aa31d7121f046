"""A sweep in a few lines: how many runs, and the range of every column."""

from collections.abc import Mapping

import numpy as np

from bondgraph.show.display import counted
from codegen.numbers.arrays import Array


def sweep_rows(
    columns: Mapping[str, Array], runs: int, done: int, failed: int
) -> tuple[str, list[tuple[str, ...]]]:
    """How many runs there are, and a table with a head: of each column the least, mean and most.

    Runs that gave nothing are left out; of columns without a number there are dashes.
    """
    head = f"{counted(runs, 'run')}, {done} done, {failed} failed"
    rows: list[tuple[str, ...]] = [("", "least", "mean", "most")]
    for name, values in columns.items():
        known = values[~np.isnan(values)]
        shown = (known.min(), known.mean(), known.max()) if known.size else ()
        rows.append((name, *(f"{value:.5g}" for value in shown)) if shown else (name, *"---"))
    return head, rows
