"""Sums of named numbers, and the lines in which names are given: what an evaluation is recorded as."""

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Union

from codegen.program.records import Block

PARTS = ("x", "z", "u", "du", "y", "rate", "caps")
"""What is recorded of an instant."""

Number = int | float

Value = Union["Sum", Number]
"""What stands where a number stands in an evaluation that is recorded."""


@dataclass(frozen=True)
class Line:
    """One assignment: ``names`` of its results, ``read``: the sums that it reads.

    ``code``: a block that is evaluated; a number: what is called, such as a loop of laws to be solved;
    "+": the one sum that is read, "*": the product of two, "/": the first over the second; "!": the four
    values of friction at a port, which are checked.
    """

    names: tuple[str, ...]
    code: Block | int | str
    read: tuple[Value, ...]

    @property
    def free(self) -> bool:
        """Whether it is there for its results alone, and cannot fail."""
        return self.code in ("+", "*")


@dataclass
class Lines:
    """The lines of a recording, in order."""

    listed: list[Line] = field(default_factory=list)
    _known: dict[Hashable, "Sum"] = field(default_factory=dict)

    def copied(self) -> "Lines":
        """The same, to go on with apart."""
        return Lines([*self.listed], dict(self._known))

    def given(self, letter: str, count: int) -> list["Sum"]:
        """What is given from outside, ``letter`` with a number."""
        return [self.one(f"{letter}{at}") for at in range(count)]

    def one(self, name: str) -> "Sum":
        """What has a name."""
        return Sum(self, {name: 1.0})

    def new(self, code: Block | int | str, read: Iterable[Value], count: int = 1) -> list["Sum"]:
        """The results of a new line."""
        first = sum(len(line.names) for line in self.listed)
        names = tuple(f"a{first + at}" for at in range(count))
        self.listed.append(Line(names, code, tuple(read)))
        return [self.one(name) for name in names]

    def named(self, value: Value) -> Value:
        """The same under a name of its own, once; a number as it is."""
        if not isinstance(value, Sum) or value.name:
            return value
        return self._once("+", value)

    def product(self, one: "Sum", other: "Sum") -> "Sum":
        """The product of two."""
        return self._once("*", *sorted((one, other), key=lambda part: [*part.terms]))

    def quotient(self, one: Value, other: "Sum") -> "Sum":
        """One over another."""
        return self._once("/", one, other)

    def _once(self, code: str, *read: Value) -> "Sum":
        key = (code, *(part.key if isinstance(part, Sum) else part for part in read))
        if key not in self._known:
            self._known[key] = self.new(code, read)[0]
        return self._known[key]


class Sum:
    """A constant and names times factors, of which none is zero; it stands where a number stands.

    >>> x, y = Lines().given("x", 2)
    >>> (2*x - y + 1 - x - x).terms, 0*x, (x + 3).constant
    ({'x1': -1.0}, 0.0, 3.0)
    """

    __slots__ = ("constant", "lines", "terms")

    def __init__(self, lines: Lines, terms: Mapping[str, float], constant: float = 0.0) -> None:
        self.lines, self.terms, self.constant = lines, terms, constant

    @property
    def name(self) -> str:
        """The name that it is, or none."""
        if len(self.terms) == 1 and not self.constant:
            ((name, factor),) = self.terms.items()
            return name if factor == 1 else ""
        return ""

    @property
    def key(self) -> Hashable:
        """Equal of equal sums."""
        return tuple(self.terms.items()), self.constant

    def __add__(self, other: Any) -> Value:
        if not isinstance(other, Sum):
            return Sum(self.lines, self.terms, self.constant + other) if other else self
        terms = dict(self.terms)
        for name, factor in other.terms.items():
            terms[name] = terms.get(name, 0.0) + factor
        terms = {name: factor for name, factor in terms.items() if factor}
        constant = self.constant + other.constant
        return Sum(self.lines, terms, constant) if terms else constant

    __radd__ = __add__

    def __neg__(self) -> "Sum":
        return Sum(self.lines, {name: -f for name, f in self.terms.items()}, -self.constant)

    def __sub__(self, other: Any) -> Value:
        return self.__add__(-other)

    def __rsub__(self, other: Any) -> Value:
        return (-self).__add__(other)

    def __mul__(self, other: Any) -> Value:
        if isinstance(other, Sum):
            return self.lines.product(self, other)
        factor = float(other)
        if not factor:
            return 0.0
        terms = {name: factor * own for name, own in self.terms.items()}
        return Sum(self.lines, terms, factor * self.constant)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Value:
        return self.lines.quotient(self, other) if isinstance(other, Sum) else self * (1 / other)

    def __rtruediv__(self, other: Any) -> Value:
        return self.lines.quotient(float(other), self) if other else 0.0


Solve = Callable[..., list[float]]
"""A loop of laws, from what it reads to what its laws give."""


@dataclass(frozen=True)
class Recording:
    """The lines of an evaluation, from t, s, w and w'; ``parts``: its results by name, rows of sums.

    ``loops``: what lines with a number call. ``looks``: for parts that are looked at, one
    at a time, lines of their own.
    """

    lines: tuple[Line, ...]
    parts: Mapping[str, tuple[Value, ...]]
    loops: tuple[Solve, ...]
    looks: Mapping[str, tuple[Line, ...]]


def names_in(values: Iterable[Value]) -> set[str]:
    """The names that are read."""
    return {name for value in values if isinstance(value, Sum) for name in value.terms}


def needed(lines: Sequence[Line], results: Iterable[Value]) -> list[Line]:
    """The lines that results need, and those that can fail, with what these need."""
    used, kept = names_in(results), list[Line]()
    for line in reversed(lines):
        if not line.free or used & {*line.names}:
            used |= names_in(line.read)
            kept.append(line)
    return kept[::-1]
