"""The table of what to change for what names files that there are, and few of them."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]

ROWS = [
    [cell.strip() for cell in line.strip("|\n").split("|")]
    for line in (ROOT / "CONTRIBUTING.md").read_text("utf-8").splitlines()
    if line.startswith("| a")
]


def _files(cell: str) -> list[str]:
    return [name for name in re.findall(r"`([^`]+)`", cell) if "." in name]


def test_the_files_to_change_are_there_and_at_most_three() -> None:
    assert len(ROWS) == 15
    for what, _, change in ROWS:
        found = [name for name in _files(change) if not name.startswith("docs/")]
        python, _, c = change.partition("; in C ")
        assert 1 <= len(_files(python)) <= 3, what
        assert len(_files(c)) <= 3, what
        for name in found:
            assert any(ROOT.rglob(name) if "/" not in name else [(ROOT / name).exists()]), name
            assert "/" not in name or (ROOT / name).exists(), name


def test_folders_of_new_files_are_there() -> None:
    for _, new, _ in ROWS:
        for name in _files(new):
            folder = (ROOT / name).parent
            assert folder.exists() or folder.name == "NAME", name
