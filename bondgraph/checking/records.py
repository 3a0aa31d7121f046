"""`Check`, `Finding` and `StrokeVerdict`: what a graph's judge says, each with the way out."""

from collections.abc import Hashable, Iterator
from dataclasses import dataclass
from typing import Literal

from bondgraph.nodes.elements import Bond

Rule = Literal[
    "parameter", "one bond", "arrow", "source", "supply", "pass-through",
    "same kind", "causality", "stroke", "mode",
]  # fmt: skip
"""What a finding is about."""

Verdict = Literal["right", "not preferred", "wrong", "missing"]

MARKS = {"right": "ok", "not preferred": "so-so", "wrong": "WRONG", "missing": "open"}
"""What stands before a stroke in a list."""


@dataclass(frozen=True)
class Finding:
    """Something in a graph that a teacher would ask about, and what to do.

    ``kind``: a "doubt" most likely is not what was meant; a "hint" says what could be simpler, at
    the same equations, or what is not drawn yet. ``node`` or ``bond``, as declared, is where it is.
    """

    kind: Literal["doubt", "hint"]
    rule: Rule
    text: str
    way_out: str
    node: Hashable | None = None
    bond: Bond | None = None

    def __str__(self) -> str:
        return f"{self.kind} ({self.rule}): {self.text}; {self.way_out}"


@dataclass(frozen=True)
class StrokeVerdict:
    """What is to be said of one bond's drawn stroke.

    ``end``: the node at whose end it was drawn, None where it is missing. "right": it agrees with all
    rules, and no storage lost its integral causality by it without need. "not preferred": possible, but a
    storage has derivative causality that could have integral, or the other way round where that is asked.
    "wrong": ``node``'s rule is broken.
    """

    bond: Bond
    end: Hashable | None
    verdict: Verdict
    text: str
    node: Hashable | None = None

    def __str__(self) -> str:
        tail, head = self.bond
        where = "" if self.end is None else f", stroke at {self.end}"
        return f"[{MARKS[self.verdict]}] {tail} -> {head}{where}: {self.text}"


@dataclass(frozen=True)
class Check:
    """What `check` found: as many findings as its length says, none where all is well.

    ``strokes``: of a graph with drawn strokes, every bond's verdict. Shown as text by ``print``, as a
    list in a notebook.
    """

    findings: tuple[Finding, ...]
    strokes: tuple[StrokeVerdict, ...] = ()

    def __len__(self) -> int:
        return len(self.findings)

    def __iter__(self) -> Iterator[Finding]:
        return iter(self.findings)

    @property
    def doubts(self) -> tuple[Finding, ...]:
        """The findings that most likely are mistakes."""
        return tuple(one for one in self.findings if one.kind == "doubt")

    def __str__(self) -> str:
        lines = [str(one) for one in self.findings] or ["nothing found"]
        if self.strokes:
            lines += ["", "strokes:", *map(str, self.strokes)]
        return "\n".join(lines)

    def __repr__(self) -> str:
        return f"<Check: {len(self.findings)} findings, {len(self.strokes)} strokes>"

    def _repr_markdown_(self) -> str:
        found = [
            f"- **{one.kind}** ({one.rule}): {_plain(one.text)}. *{_plain(one.way_out)}*"
            for one in self.findings
        ]
        lines = found or ["Nothing found."]
        if self.strokes:
            lines += ["", "Strokes:", "", *(f"- {_plain(str(one))}" for one in self.strokes)]
        return "\n".join(lines)


def _plain(text: str) -> str:
    """The text with what Markdown would read as its own marks escaped."""
    return "".join(f"\\{c}" if c in r"\`*_[]<>$|" else c for c in text)
