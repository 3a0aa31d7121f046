"""Ends a test that would never end by itself; the option that rewrites files of exported text."""

import os
import signal
from collections.abc import Iterator

import pytest

LONGEST = 180
"""Seconds after which a test counts as hanging: many times what the longest one takes."""


def pytest_configure() -> None:
    """Compiled code is tested here, not timed: compilers take half the time over it."""
    os.environ.setdefault("CFLAGS", "-O1")


def pytest_addoption(parser: pytest.Parser) -> None:
    """``--update-golden``: write the files that exports are compared with."""
    parser.addoption("--update-golden", action="store_true", help="rewrite files of exported text")


@pytest.fixture
def update_golden(request: pytest.FixtureRequest) -> bool:
    """Whether files that exports are compared with are to be written anew."""
    return bool(request.config.getoption("--update-golden"))


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
