"""A recording of the evaluation of a mode: the same steps, on names instead of numbers.

`evaluated` and what it calls run once on arrays of `Sum`; what they come to is noted line by line: laws as
they stand, matrices as the numbers that they are in the mode, nothing that is zero. So there is one
evaluation, and its fast form is a copy that a machine made.
"""

from collections.abc import Callable, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from codegen.model.instant import BoundBlock
from codegen.standalone.arrays import Array, Mode, Places
from codegen.standalone.evaluation import Correction, Form, Laws, Point, evaluated
from codegen.standalone.friction import Friction
from codegen.standalone.instant import Formula, Instant
from codegen.standalone.loops import Loop
from codegen.standalone.matrices import Numbers
from codegen.straight.matrices import Calls, solving
from codegen.straight.sums import PARTS, Line, Lines, Recording, Sum, Value


class Changing(NamedTuple):
    """Matrices that change: their entries, and what makes matrices of these, given what solves."""

    coefficients: BoundBlock
    assembled: Callable[[Array, Callable[[Array, Array], Array]], Numbers]


@dataclass(frozen=True)
class Solving:
    """A loop of laws: from the values of a pool that it reads, at ``places``, to what its laws give."""

    loop: Loop
    places: Places
    like: Instant

    def __call__(self, *values: float) -> list[float]:
        """What the laws give together; `EvaluationError` where no solution is found."""
        like = self.like
        pool = self.loop.formula.pool(like)
        pool[self.places] = values
        sizes = [len(part) for part in (like.x, like.z, like.y, like.u, like.w, like.dw)]
        x, z, y, u, w, dw, _ = np.split(pool[1:], np.cumsum(sizes))
        now = Instant(float(pool[0]), x, z, u, np.zeros(len(u)), y, w, dw, like.caps, like.numbers)
        self.loop.close(now)
        found: list[float] = now.u[self.loop.inputs].tolist()
        return found


class _Noted(Formula):
    """A formula that notes what it would evaluate."""

    def __init__(self, block: BoundBlock, lines: Lines) -> None:
        super().__init__(block.constants)
        self._block, self._lines = block, lines

    def of_pool(self, pool: Array, like: Instant) -> Array:
        """Names of what the laws give, of a pool of sums."""
        code = self._block.code
        read = [_plain(value) for value in pool[self._block.read(pool)]]
        read = [self._lines.named(value) for value in read]
        found: Array = _row(self._lines.new(code, read, len(code.results)))
        return found


class _Checked(_Noted):
    """The same of friction: its values are checked, by the laws ``judged`` as they are."""

    def __init__(self, block: BoundBlock, lines: Lines, judged: BoundBlock) -> None:
        super().__init__(block, lines)
        self._judge = self if judged is block else _Noted(judged, lines)

    def of_pool(self, pool: Array, like: Instant) -> Array:
        """See `Formula.of_pool`."""
        values = super().of_pool(pool, like)
        judged = values if self._judge is self else self._judge.of_pool(pool, like)
        for port in judged.reshape(-1, 4).tolist():
            self._lines.new("!", port, 0)
        return values


class _Closing(Laws):
    """A loop of laws that is noted as a call."""

    def __init__(self, loop: Loop, lines: Lines, kept: Calls) -> None:
        super().__init__(loop.formula, loop.inputs, loop.readings, loop.names)
        self._loop, self._lines, self._kept = loop, lines, kept

    def close(self, now: Instant) -> None:
        """See `Laws.close`."""
        pool, first = self.formula.pool(now), 1 + len(now.x) + len(now.z)
        moving = range(len(pool) - len(self.formula.constants))
        read = {*self.formula.read(pool), *(first + self.readings).tolist()}
        places = np.array(sorted(read & {*moving}), dtype=int)
        x, z, u, y, w, dw = (
            np.zeros(len(part)) for part in (now.x, now.z, now.u, now.y, now.w, now.dw)
        )
        like = Instant(0.0, x, z, u, u, y, w, dw, y[:0], now.numbers)
        self._kept.append(Solving(self._loop, places, like))
        read_values = [self._lines.named(_plain(value)) for value in pool[places]]
        now.give(
            self.inputs,
            _row(self._lines.new(len(self._kept) - 1, read_values, len(self.inputs))),
        )


def recorded(
    form: Form, contact: Friction | None, mode: Mode, matrices: Numbers | Changing, inputs: int,
    looks: Mapping[str, BoundBlock],
) -> Recording:  # fmt: skip
    """What an evaluation in a mode comes to, of so many external inputs.

    ``looks``: formulas of the instant, by the names of parts.
    """
    lines, loops = Lines(), Calls()
    size = max(form.states + len(form.law_rates), 1)
    noted = _noted(form, lines, loops, matrices)
    s, w, dw = (
        _row(lines.given(letter, n))
        for letter, n in zip("swd", (size, inputs, inputs), strict=True)
    )
    point = Point(lines.one("t"), s, w, dw)  # type: ignore[arg-type]
    friction = None if contact is None else _friction(contact, lines, noted)
    now = evaluated(noted, friction, point, mode, checked=False)
    parts = {name: tuple(map(_plain, getattr(now, name))) for name in PARTS}
    if contact is not None:
        ports = contact.ports
        parts["efforts"] = tuple(map(_plain, now.u[ports.inputs]))
        parts["slips"] = tuple(map(_plain, now.y[ports.readings]))
    own, more = tuple(lines.listed), dict[str, tuple[Line, ...]]()
    for name, block in looks.items():
        aside = lines.copied()
        parts[name] = tuple(map(_plain, _Noted(block, aside)(now)))
        more[name] = tuple(aside.listed[len(own) :])
    return Recording(own, MappingProxyType(parts), tuple(loops), MappingProxyType(more))


def _noted(form: Form, lines: Lines, loops: Calls, matrices: Numbers | Changing) -> Form:
    def numbers(now: Instant) -> Numbers:
        if isinstance(matrices, Numbers):
            return matrices
        values = _Noted(matrices.coefficients, lines)(now)
        return matrices.assembled(values, solving(lines, loops))

    def laws(one: Laws) -> Laws:
        if isinstance(one, Loop):
            return _Closing(one, lines, loops)
        return Laws(_of(one.formula, lines), one.inputs, one.readings, one.names)

    rates = None if form.known_rates is None else _of(form.known_rates, lines)
    return replace(
        form, known=laws(form.known), known_rates=rates, matrices=numbers,
        laws=[laws(one) for one in form.laws],
    )  # fmt: skip


def _of(formula: Formula, lines: Lines) -> Formula:
    assert isinstance(formula, BoundBlock)
    return _Noted(formula, lines)


def _friction(contact: Friction, lines: Lines, form: Form) -> Any:
    made, own, judged = copy(contact), contact.ports.values, contact.judge.ports.values
    assert isinstance(own, BoundBlock)
    assert isinstance(judged, BoundBlock)
    made.ports = replace(contact.ports, values=_Checked(own, lines, judged))

    def completed(now: Instant, mode: Mode, checked: bool) -> Correction:
        correction = made(now, mode, False)
        if correction is None:
            return None

        def corrected(rate: Array, du: Array) -> Array:
            rate[:] = _row([lines.named(_plain(value)) for value in rate])
            return correction(rate, du)

        return corrected

    return completed


def _row(values: Sequence[Value]) -> Any:
    """An array of them: of objects, so that sums may stand in it."""
    found = np.empty(len(values), dtype=object)
    found[:] = values
    return found


def _plain(value: Any) -> Value:
    return value if isinstance(value, Sum) else float(value)
