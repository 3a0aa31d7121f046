"""Ends a test that would never end by itself, however busy the machine is."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

MOST = 180.0
"""Seconds of a processor that a test may use with all that it starts: many times what the longest one does.
A test that needs more says so: ``pytest.mark.most(900)``."""

IDLE = 300.0
"""Seconds in which a test, though there are processors for it, does nothing."""

WATCHER = Path(__file__).with_name("watcher.py")


def pytest_addoption(parser: pytest.Parser) -> None:
    """Other limits, to test this by."""
    parser.addoption("--most", type=float, default=MOST, help="seconds of processor of a test")
    parser.addoption(
        "--idle", type=float, default=IDLE, help="seconds in which a test does nothing"
    )


def pytest_configure(config: pytest.Config) -> None:
    """Start to watch with the first test; where the system does not tell what processes use, nothing is."""
    if Path("/proc/self/schedstat").exists():
        config.pluginmanager.register(Guard(config), "guard")


class Guard:
    """Tells the watcher of tests, and raises what it says in them."""

    def __init__(self, config: pytest.Config) -> None:
        self.most = float(config.getoption("--most"))
        self.idle = float(config.getoption("--idle"))
        self.watcher: subprocess.Popen[bytes] | None = None

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        """One test with its fixtures."""
        marked = item.get_closest_marker("most")
        limit = float(marked.args[0]) if marked else self.most

        def spent(*_: object) -> None:
            raise TimeoutError(
                f"no end after {limit:g} s of a processor: the test makes no progress"
            )

        def rests(*_: object) -> None:
            raise TimeoutError(
                f"nothing done for {self.idle:g} s: the test waits for what never comes"
            )

        before = signal.signal(signal.SIGXCPU, spent), signal.signal(signal.SIGALRM, rests)
        self._say(f"begin {limit}\n")
        try:
            return (yield)
        finally:
            self._say("end\n")
            signal.signal(signal.SIGXCPU, before[0])
            signal.signal(signal.SIGALRM, before[1])

    def pytest_unconfigure(self) -> None:
        """The watcher ends with its input."""
        if self.watcher:
            self.watcher.communicate()

    def _say(self, line: str) -> None:
        if self.watcher is None:
            command = [sys.executable, "-I", "-S", str(WATCHER), str(os.getpid()), str(self.idle)]
            self.watcher = subprocess.Popen(command, stdin=subprocess.PIPE, bufsize=0)
        assert self.watcher.stdin
        self.watcher.stdin.write(line.encode())
