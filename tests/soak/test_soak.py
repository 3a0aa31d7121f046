"""The ledger of soaks, and that every family is one of a test."""

import random
import re
from dataclasses import replace
from pathlib import Path

import pytest

from soak import ledger, running
from soak.families import FAMILIES, Family, family
from soak.ledger import Record

TESTS = Path(__file__).parents[1]
DRAWN = Family("drawn", "nowhere.py", 4, 20)


def test_families_have_names_of_their_own() -> None:
    assert len({one.name for one in FAMILIES}) == len(FAMILIES)
    assert all(one.slice < one.promised for one in FAMILIES)


@pytest.mark.parametrize("one", FAMILIES, ids=lambda one: one.name)
def test_a_familys_test_takes_its_seeds(one: Family) -> None:
    file, _, test = one.test.partition("::")
    text = (TESTS / file).read_text("utf-8")
    assert f'{"seeds" if one.slice else "whole"}("{one.name}")' in text
    assert not test or f"def {test}(" in text


def test_seeds_are_asked_for_here_alone() -> None:
    """So that a soak knows every family."""
    named = set()
    for path in sorted(set(TESTS.rglob("test_*.py")) - {Path(__file__)}):
        text = path.read_text("utf-8")
        named |= set(re.findall(r'\b(?:seeds|whole)\("([a-z-]+)"\)', text))
        assert not re.search(r"(environ|getenv).*BONDGRAPH_SOAK_", text), path
    assert named == {one.name for one in FAMILIES}


@pytest.mark.parametrize(
    ("said", "expected"), [(None, range(4)), ("7", range(7)), ("30:40", range(30, 40))]
)
def test_the_environment_chooses_seeds(said, expected, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("BONDGRAPH_SLICE", raising=False)
    if said is not None:
        monkeypatch.setenv("BONDGRAPH_SOAK_DRAWN", said)
    assert DRAWN.seeds == expected
    later = replace(DRAWN, first=100).seeds
    assert later == (expected if expected.start else range(100, 100 + len(expected)))
    assert Family("two-words", "", 1, 2).variable == "BONDGRAPH_SOAK_TWO_WORDS"
    with pytest.raises(KeyError, match="no-such"):
        family("no-such")


@pytest.mark.parametrize("seed", range(20))
def test_records_keep_what_passed_and_what_failed(seed: int) -> None:
    """Against sets of single seeds."""
    rng, record = random.Random(seed), Record()
    passed, failed = set(), set()
    for _ in range(12):
        first = rng.randrange(40)
        seeds = range(first, first + rng.randrange(0, 12))
        failing = [one for one in seeds if rng.random() < 0.15]
        record.note(seeds, failing)
        passed = (passed | set(seeds)) - set(failing)
        failed = (failed - set(seeds)) | set(failing)
        assert {one for span in record.passed for one in range(*span)} == passed
        assert set(record.failed) == failed
        assert record.count == len(passed)
        assert record.next() == max(passed | failed, default=-1) + 1


def test_records_come_back_from_their_file(tmp_path: Path) -> None:
    records = ledger.read(tmp_path / "none.json")
    records["graphs"].note(range(5, 9), [7])
    ledger.write(records, tmp_path / "seeds.json", tmp_path / "table.md")
    assert ledger.read(tmp_path / "seeds.json") == records
    assert "| 10,000 | 3 | 1 | 7 |" in (tmp_path / "table.md").read_text("utf-8")


def test_the_table_is_of_the_seeds() -> None:
    assert ledger.text(ledger.read()) == ledger.TABLE.read_text("utf-8")


@pytest.mark.parametrize("bad", [[], [3], [0, 19], [4, 5, 6]])
def test_failing_seeds_are_told_one_by_one(bad, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        running, "_status", lambda family, seeds: (int(any(one in seeds for one in bad)), "")
    )
    part = running.ran(DRAWN, range(20))
    assert (part.seeds, part.failing, part.trouble) == (range(20), tuple(bad), "")


def test_a_part_that_fails_everywhere_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(running, "_status", lambda family, seeds: (1, ""))
    part = running.ran(DRAWN, range(64))
    assert part.failing == tuple(range(running.MANY))
    assert part.seeds == range(running.MANY)
    monkeypatch.setattr(running, "_status", lambda family, seeds: (4, "not found"))
    assert running.ran(DRAWN, range(8)) == running.Part(DRAWN, range(0), trouble="not found")


def test_a_soak_goes_on_where_the_last_ended_and_keeps_promises_first(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    other = Family("other", "nowhere.py", 5, 10)
    kept: list = []
    monkeypatch.setattr(running, "write", lambda records: kept.append(dict(records)))
    records = {"drawn": Record([(0, 12)]), "other": Record()}
    plan = running.Soak([DRAWN, other], records)
    first, second = plan.next(), plan.next()
    assert (first.family, first.seeds) == (other, range(5))
    assert (second.family, second.seeds) == (DRAWN, range(12, 16))
    assert plan.next() is None
    plan.keep(running.Part(other, range(5), (2,), seconds=running.LASTS))
    assert (records["other"].count, records["other"].failed) == (4, [2])
    assert plan.next().seeds == range(5, 10)
    plan.keep(running.Part(DRAWN, range(12, 16), seconds=1e-3))
    assert plan.next().seeds == range(16, 20)
    assert len(kept) == 2
