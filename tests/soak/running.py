"""A soak: parts of families as runs of pytest, as many at once as there are processors, until time is up.

Time decides how much is run, never what passes.
"""

import os
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass

from soak.families import Family
from soak.ledger import HERE, Record, write

LASTS = 60.0
"""Seconds that a part aims at: many times what starting pytest takes, and soon over."""

MANY = 8
"""Seeds that fail in one part, after which the rest of it is left: the family is broken."""


@dataclass(frozen=True)
class Part:
    """Some seeds of a family and which of them failed, or what pytest said if it could not run them."""

    family: Family
    seeds: range
    failing: tuple[int, ...] = ()
    seconds: float = 0.0
    trouble: str = ""


def ran(family: Family, seeds: range) -> Part:
    """Run some seeds, and those that fail again in halves until each is told."""
    begin = time.monotonic()
    failing: list[int] = []
    done = seeds.start
    waiting = [seeds]
    while waiting and len(failing) < MANY:
        one = waiting.pop()
        status, said = _status(family, one)
        if status not in (0, 1):
            return Part(family, range(seeds.start, done), tuple(failing), trouble=said)
        if status == 1 and len(one) > 1:
            middle = one.start + len(one) // 2
            waiting += [range(middle, one.stop), range(one.start, middle)]
            continue
        failing += [one.start] * status
        done = one.stop
    return Part(family, range(seeds.start, done), tuple(failing), time.monotonic() - begin)


def _status(family: Family, seeds: range) -> tuple[int, str]:
    """Pytest's status and last words."""
    command = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider"]
    done = subprocess.run(
        [*command, f"tests/{family.test}"], cwd=HERE.parents[1], text=True, capture_output=True,
        env={**os.environ, family.variable: f"{seeds.start}:{seeds.stop}"}, check=False,
    )  # fmt: skip
    return done.returncode, "\n".join((done.stdout + done.stderr).splitlines()[-15:])


class Soak:
    """Chooses parts and keeps what they gave."""

    def __init__(self, families: Sequence[Family], records: Mapping[str, Record]) -> None:
        self.families, self.records = tuple(families), dict(records)
        self.upto = {one.name: records[one.name].next(one.first) for one in families}
        self.pace: dict[str, float] = {}
        self.busy: list[str] = []
        self.broken: set[str] = set()

    def next(self) -> Part | None:
        """The family that is farthest from its promise and not running; None if there is no other."""
        free = [
            one
            for one in self.families
            if one.name not in self.busy
            and one.name not in self.broken
            # A whole set is run once: other seeds are the same cases.
            and (one.slice or self._run(one) < one.promised)
        ]
        if not free:
            return None
        one = min(free, key=lambda one: self._run(one) / one.promised)
        first, left = self.upto[one.name], one.promised - self._run(one)
        count = max(1, min(self._count(one), left if left > 0 else one.promised))
        self.upto[one.name] += count
        self.busy.append(one.name)
        return Part(one, range(first, first + count))

    def _run(self, one: Family) -> int:
        """How many seeds have been run or are being run."""
        return self.upto[one.name] - one.first

    def _count(self, one: Family) -> int:
        """As many seeds as last for about `LASTS`; at first the slice of every run."""
        pace = self.pace.get(one.name)
        return int(LASTS / max(pace, 1e-6)) if pace else max(one.slice, 1)

    def keep(self, part: Part) -> None:
        """Note what a part gave, in the files, too."""
        name = part.family.name
        self.busy.remove(name)
        self.records[name].note(part.seeds, part.failing)
        write(self.records)
        if part.trouble or len(part.failing) >= MANY:
            self.broken.add(name)
        elif part.seeds:
            self.pace[name] = part.seconds / len(part.seeds)


def soak(
    families: Sequence[Family], records: Mapping[str, Record], minutes: float, jobs: int
) -> list[Part]:
    """Run parts until the minutes are over, and let those that run end; what failed."""
    plan, ends, bad = Soak(families, records), time.monotonic() + 60 * minutes, []
    with ThreadPoolExecutor(jobs) as pool:
        running: set[Future[Part]] = set()
        while True:
            while len(running) < jobs and time.monotonic() < ends and (part := plan.next()):
                running.add(pool.submit(ran, part.family, part.seeds))
            if not running:
                return bad
            done, running = wait(running, return_when=FIRST_COMPLETED)
            for one in done:
                part = one.result()
                plan.keep(part)
                _tell(part)
                bad += [part] if part.failing or part.trouble else []


def _tell(part: Part) -> None:
    said = f"{part.family.name}: seeds {part.seeds.start} to {part.seeds.stop - 1} ran"
    if part.failing:
        said += f", {', '.join(map(str, part.failing))} failed"
    print(said + (f"\n{part.trouble}" if part.trouble else ""), flush=True)  # noqa: T201
