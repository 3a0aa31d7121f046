"""Variables of MAT files, by the names of signals where the file tells them."""

from pathlib import Path
from typing import Any

import numpy as np

from bondgraph.errors import SignalError

SIGNALS = "signals"
"""The table of variables, signals and units that a run's file has."""


def read_matlab(path: Path) -> dict[str, Any]:
    """The variables in one row of a MAT file up to version 7; `SignalError` for what is none."""
    from scipy.io import loadmat
    from scipy.io.matlab import MatReadError

    try:
        found = loadmat(path, squeeze_me=True)
    except NotImplementedError:
        raise SignalError(
            f"{path} is of MATLAB's version 7.3; save it by save(..., '-v7')"
        ) from None
    except (MatReadError, ValueError, TypeError, IndexError, EOFError) as error:
        raise SignalError(f"{path} is no MAT file: {error}") from None
    table = found.get(SIGNALS)
    named = {}
    if isinstance(table, np.ndarray) and table.dtype.kind in "OU" and table.shape[-1:] == (3,):
        named = {str(row[0]): str(row[1]) for row in table.reshape(-1, 3)}
    return {
        named.get(name, name): np.atleast_1d(value)
        for name, value in found.items()
        if isinstance(value, np.ndarray | int | float) and name not in (SIGNALS,)
    }
