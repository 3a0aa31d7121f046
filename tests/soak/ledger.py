"""What soaks have run: seeds that passed and seeds that failed, family by family, and the table of them."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from soak.families import FAMILIES, Family

HERE = Path(__file__).parent
SEEDS = HERE / "seeds.json"
TABLE = HERE / "README.md"

HEAD = """\
# Soaks

`make soak MINUTES=60` goes on with the random families of the tests where the last soak ended, those first
that are farthest from what is promised. Seeds that passed and seeds that failed are kept in `seeds.json`;
this table is made of it. A failing seed is run alone with `BONDGRAPH_SOAK_<FAMILY>=<seed>:<seed + 1>` set for
pytest; `make soak FAMILY=<family>` runs one family, and `AGAIN=1` runs the seeds that failed.

| family | test | every run | promised | passed | failed | failing seeds |
|---|---|---:|---:|---:|---:|---|
"""


@dataclass
class Record:
    """One family's seeds: ranges that passed, in order and apart, and single ones that failed."""

    passed: list[tuple[int, int]] = field(default_factory=list)
    failed: list[int] = field(default_factory=list)

    def note(self, seeds: range, failing: Sequence[int]) -> None:
        """All of these seeds were run; those of ``failing`` failed."""
        if not seeds:
            return
        known = set(self.failed) - set(seeds) | set(failing)
        spans = sorted([*self.passed, (seeds.start, seeds.stop)])
        bad = sorted(known)
        self.passed, self.failed = _without(_joined(spans), bad), bad

    @property
    def count(self) -> int:
        """How many passed."""
        return sum(stop - first for first, stop in self.passed)

    def next(self, first: int = 0) -> int:
        """The first seed that no soak has run, past all that one has."""
        return max([first, *(stop for _, stop in self.passed), *(seed + 1 for seed in self.failed)])


def _joined(spans: Sequence[tuple[int, int]]) -> list[tuple[int, int]]:
    joined: list[tuple[int, int]] = []
    for first, stop in spans:
        if joined and first <= joined[-1][1]:
            joined[-1] = joined[-1][0], max(stop, joined[-1][1])
        else:
            joined.append((first, stop))
    return joined


def _without(spans: Sequence[tuple[int, int]], seeds: Sequence[int]) -> list[tuple[int, int]]:
    for seed in seeds:
        cut = [(span, span[0] <= seed < span[1]) for span in spans]
        spans = [
            part for (first, stop), hit in cut
            for part in ([(first, seed), (seed + 1, stop)] if hit else [(first, stop)])
            if part[0] < part[1]
        ]  # fmt: skip
    return list(spans)


def read(path: Path = SEEDS) -> dict[str, Record]:
    """Every family's record; an empty one where there has been no soak."""
    kept = json.loads(path.read_text("utf-8")) if path.exists() else {}
    records = {
        name: Record([(first, stop) for first, stop in one["passed"]], list(one["failed"]))
        for name, one in kept.items()
    }
    return {one.name: records.get(one.name, Record()) for one in FAMILIES}


def write(records: Mapping[str, Record], seeds: Path = SEEDS, table: Path = TABLE) -> None:
    """Keep the records, and write their table; families without seeds are left out of the first."""
    rows = {
        name: {"passed": one.passed, "failed": one.failed}
        for name, one in records.items() if one.passed or one.failed
    }  # fmt: skip
    lines = [f'"{name}": {json.dumps(row)}' for name, row in sorted(rows.items())]
    seeds.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")
    table.write_text(text(records), encoding="utf-8")


def text(records: Mapping[str, Record]) -> str:
    """The table in Markdown."""
    return HEAD + "".join(_row(one, records[one.name]) for one in FAMILIES)


def _row(one: Family, record: Record) -> str:
    failing = ", ".join(map(str, record.failed[:8])) + (" .." if len(record.failed) > 8 else "")
    numbers = one.slice, one.promised, record.count, len(record.failed)
    counts = " | ".join(f"{number:,}" for number in numbers)
    return f"| {one.name} | `{one.test.split('::')[0]}` | {counts} | {failing or '-'} |\n"
