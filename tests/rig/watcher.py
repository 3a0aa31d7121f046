"""A process beside the one that runs tests, which ends a test that would never end by itself.

It counts the processor's time of the test and of all processes below it, never the clock's: on a busy machine
a test takes long and is right. A test that does nothing is told from one that is kept waiting for a processor
by the time it was ready to run. Standard input has a line for each test: ``begin SECONDS``, ``end``.

Run as a script, by bare Python: PID IDLE.
"""

import contextlib
import os
import select
import signal
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass

POLL = 5.0
"""Seconds between looks, at most."""

DOZING, STARVED = 0.02, 0.1
"""Of the clock's time: what runs for less, and is kept waiting for a processor for less, does nothing."""

TICKS = os.sysconf("SC_CLK_TCK")


@dataclass(frozen=True)
class Used:
    """Seconds that a family of processes ran, and that it was ready to run; whether one waits for a disk."""

    ran: float
    ready: float
    disk: bool


def used(pid: int) -> Used:
    """By a process, those below it, and those of both that have ended."""
    ran, ready, disk = 0.0, 0.0, False
    for member in family(pid):
        try:
            with open(f"/proc/{member}/stat", encoding="utf-8", errors="replace") as file:
                fields = file.read().rpartition(")")[2].split()
            with open(f"/proc/{member}/schedstat", encoding="utf-8") as file:
                ready += int(file.read().split()[1]) * 1e-9
        except (OSError, IndexError):
            continue
        ran += sum(map(int, fields[11:15])) / TICKS
        disk |= fields[0] == "D"
    return Used(ran, ready, disk)


def family(pid: int) -> Iterator[int]:
    """The process and all below it, but this one."""
    below: dict[int, list[int]] = {}
    for name in os.listdir("/proc"):
        if name.isdigit():
            try:
                with open(f"/proc/{name}/stat", encoding="utf-8", errors="replace") as file:
                    parent = int(file.read().rpartition(")")[2].split()[1])
            except OSError:
                continue
            below.setdefault(parent, []).append(int(name))
    waiting = [pid]
    while waiting:
        one = waiting.pop()
        if one != os.getpid():
            yield one
            waiting += below.get(one, ())


class Watch:
    """One test: what it had used at the first look, since when it rests, how often it was told to end."""

    def __init__(self, pid: int, limit: float, idle: float) -> None:
        self.pid, self.limit, self.idle = pid, limit, idle
        self.first: Used | None = None
        self.told = 0

    def look(self) -> None:
        """Tell the test to end if it must; end its process if it has been told."""
        now, at = used(self.pid), time.monotonic()
        if self.first is None:
            # Not before: most tests end before anyone looks, and need not be counted.
            self.first, self.last, self.at, self.since = now, now, at, at
        if self._does_something(now, at - self.at):
            self.since = at
        self.last, self.at = now, at
        if at - self.since >= self.idle * (1 + self.told):
            self._tell(signal.SIGALRM)
        elif now.ran - self.first.ran > self.limit * (1 + self.told):
            self._tell(signal.SIGXCPU)

    def _does_something(self, now: Used, lasted: float) -> bool:
        return (
            now.disk
            or now.ran - self.last.ran > DOZING * lasted
            or now.ready - self.last.ready > STARVED * lasted
        )

    def _tell(self, what: signal.Signals) -> None:
        """The first time as an exception; then by a signal that shows where it was and ends the process."""
        self.told += 1
        if self.told == 1:
            os.kill(self.pid, what)
            return
        for member in list(family(self.pid)):
            if member != self.pid:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(member, signal.SIGKILL)
        os.kill(self.pid, signal.SIGABRT if self.told == 2 else signal.SIGKILL)


def main(pid: int, idle: float) -> None:
    """Until the process that runs tests has gone."""
    watch, poll = None, min(POLL, idle / 4)
    while os.getppid() == pid:
        if select.select([sys.stdin.fileno()], [], [], poll)[0]:
            said = os.read(sys.stdin.fileno(), 1 << 16).decode()
            if not said:
                return
            word, _, limit = said.splitlines()[-1].partition(" ")
            watch = Watch(pid, float(limit), idle) if word == "begin" else None
        elif watch:
            try:
                watch.look()
            except ProcessLookupError:
                continue


if __name__ == "__main__":
    main(int(sys.argv[1]), float(sys.argv[2]))
