"""Linear models as python-control has them."""

from collections.abc import Sequence
from typing import Any

from bondgraph.errors import MissingExtraError


def control_space(
    matrices: Sequence[object],
    states: Sequence[str],
    inputs: Sequence[str],
    outputs: Sequence[str],
) -> Any:
    """A ``control.StateSpace`` of four matrices, and a period [s] behind them if it is sampled.

    Raises `MissingExtraError` without python-control.
    """
    try:
        import control
    except ImportError:
        raise MissingExtraError(
            "to_control needs python-control; install the optional extra: "
            "pip install bondgraph-toolkit[control]"
        ) from None
    return control.ss(*matrices, states=list(states), inputs=list(inputs), outputs=list(outputs))
