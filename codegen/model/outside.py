"""Whose line a warning is told of: the nearest that is no part of the toolkit."""

import sys
from types import FrameType

INSIDE = ("codegen", "differentials", "functools")
"""Packages whose lines are none of the user's; the last calls what is made when it is first asked for."""


def outside() -> int:
    """How far above whoever calls this the line stands that is no part of the toolkit."""
    frame, level = sys._getframe(1), 1
    while frame.f_back is not None and _package(frame) in INSIDE:
        frame, level = frame.f_back, level + 1
    return level


def _package(frame: FrameType) -> str:
    return str(frame.f_globals.get("__name__", "")).partition(".")[0]
