"""What cells of a notebook show: what is kept of it, and in what two runs differ."""

import math
import re
from collections.abc import Sequence
from typing import Any

from nbformat import NotebookNode

NOISE = 1e-5
"""Numbers below this are errors of rounding, of which every machine has others."""

NEAR = 1e-3
"""How far other numbers may be apart, over their size."""

_NUMBER = re.compile(r"(?<![\w.])\d+\.?\d*(?:e[+-]?\d+)?|(?<![\w.])\.\d+(?:e[+-]?\d+)?")
_UUID = re.compile(r"[0-9a-f]{8}(?:-[0-9a-f]{4}){3}-[0-9a-f]{12}")


def kept(outputs: Sequence[NotebookNode], count: int) -> list[NotebookNode]:
    """The outputs of a cell: prints as one, random identifiers numbered, results counted as their cell."""
    found: list[NotebookNode] = []
    for output in outputs:
        one = NotebookNode(output)
        last = found[-1] if found else {}
        if one.output_type == "stream" and last.get("name") == one.name:
            found[-1]["text"] += one.text
            continue
        if one.output_type == "execute_result":
            one["execution_count"] = count
        if "data" in one:
            one["data"] = NotebookNode({key: _numbered(one.data[key]) for key in sorted(one.data)})
            one["metadata"] = NotebookNode()
        found.append(one)
    return found


def _numbered(value: Any) -> Any:
    """A text with the identifiers that are drawn by chance in place of those of every run."""
    if not isinstance(value, str):
        return value
    seen: dict[str, str] = {}

    def number(match: re.Match[str]) -> str:
        return seen.setdefault(match.group(), f"00000000-0000-0000-0000-{len(seen):012}")

    return _UUID.sub(number, value)


def differences(found: Sequence[NotebookNode], want: Sequence[NotebookNode]) -> list[str]:
    """What two runs of a cell do not have in common; pictures of pixels are only counted."""
    if [_kinds(one) for one in found] != [_kinds(one) for one in want]:
        return [f"{[_kinds(one) for one in found]} instead of {[_kinds(one) for one in want]}"]
    pairs = zip(found, want, strict=True)
    texts = [pair for one, other in pairs for pair in zip(_texts(one), _texts(other), strict=True)]
    return [f"{a!r} instead of {b!r}" for a, b in texts if not alike(a, b)]


def _kinds(output: NotebookNode) -> tuple[str, ...]:
    return (output.output_type, output.get("name", ""), *sorted(output.get("data", {})))


def _texts(output: NotebookNode) -> list[str]:
    data = output.get("data", {})
    shown = [data[key] for key in sorted(data) if key.startswith("text/") or "svg" in key]
    return [output["text"], *shown] if "text" in output else shown


def alike(found: str, want: str) -> bool:
    """Whether two texts have the same words, and numbers that are near or noise."""
    if _NUMBER.split(found) != _NUMBER.split(want):
        return False
    pairs = zip(_NUMBER.findall(found), _NUMBER.findall(want), strict=True)
    return all(
        math.isclose(float(a), float(b), rel_tol=NEAR)
        or ("e-" in a and "e-" in b and max(float(a), float(b)) < NOISE)
        for a, b in pairs
    )
