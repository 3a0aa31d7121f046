"""Ends a test that would never end by itself."""

import signal
from collections.abc import Iterator

import pytest

LONGEST = 180
"""Seconds after which a test counts as hanging: many times what the longest one takes."""


@pytest.fixture(autouse=True)
def _no_endless_run() -> Iterator[None]:
    if not hasattr(signal, "SIGALRM"):
        yield
        return

    def end(*_: object) -> None:
        raise TimeoutError(f"no end after {LONGEST} s: the run makes no progress")

    before = signal.signal(signal.SIGALRM, end)
    signal.alarm(LONGEST)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)
