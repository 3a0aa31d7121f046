"""``--update-slow``: which tests are slow, by what each used of a processor, with all that it started."""

import resource
from collections import defaultdict
from collections.abc import Iterator

import pytest

from rig.needs import SLOW, function

LONGEST = 0.12
"""Seconds of a processor, on average over what a test is parametrized with."""


BOTH = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)


def pytest_addoption(parser: pytest.Parser) -> None:
    """Run all tests in one process with it, on a machine that does nothing else."""
    parser.addoption("--update-slow", action="store_true", help="write which tests are slow")


def pytest_configure(config: pytest.Config) -> None:
    """Nothing is measured unless it is asked for."""
    if config.getoption("--update-slow"):
        config.pluginmanager.register(Used(), "used")


class Used:
    """Seconds of each test."""

    def __init__(self) -> None:
        self.seconds = defaultdict[str, list[float]](list)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        """One test with its fixtures."""
        before = used(*BOTH)
        try:
            return (yield)
        finally:
            self.seconds[function(item.nodeid)].append(used(*BOTH) - before)

    def pytest_sessionfinish(self) -> None:
        """Write the list."""
        means = {name: sum(row) / len(row) for name, row in self.seconds.items()}
        slow = sorted(name for name, mean in means.items() if mean > LONGEST)
        SLOW.write_text("".join(f"{name}\n" for name in slow), encoding="utf-8")


def used(*whose: int) -> float:
    """Seconds of a processor so far: of this process, or of its children that have ended."""
    both = [resource.getrusage(one) for one in whose]
    return sum(one.ru_utime + one.ru_stime for one in both)
