"""What the delays of a model give in a whole run: it is stepped, part by part."""

from collections.abc import Sequence

from codegen.delays.course import Course, Make
from codegen.delays.history import Past, begun
from codegen.delays.readings import Reading
from codegen.inputs.signal import Pieced, Signal
from codegen.program.records import Program


def found(
    program: Program, delays: Sequence[Reading], make: Make, signals: Sequence[Signal],
    begin: float, end: float,
) -> dict[str, Pieced]:  # fmt: skip
    """A signal of what each delay gives from ``begin`` to ``end`` [s], to rounding of what it reads."""
    course = Course(delays, program.clocks, lambda t, stop: signals, begin, end - begin)
    stepper, whole = make(course.told()), [_Whole(begun(one.lag, begin)) for one in delays]
    while course.at.t < end:
        course.go_on(stepper, end)
        for one, past in zip(whole, course.at.pasts, strict=True):
            one.take(past)
    return {one.name: all_of.signal() for one, all_of in zip(delays, whole, strict=True)}


class _Whole:
    """Everything that a delay gives, of pasts that forget."""

    def __init__(self, past: Past) -> None:
        self._points, self._parts = [*past.points], [*past.parts]
        self._smooth = set(past.smooth)

    def take(self, past: Past) -> None:
        """Its last part, where that is another."""
        self._smooth |= past.smooth
        if past.points[-1] != self._points[-1]:
            self._points.append(past.points[-1])
            self._parts.append(past.parts[-1])

    def signal(self) -> Pieced:
        """What it gives; the last piece goes on beyond."""
        return Pieced(tuple(self._points[:-1]), tuple(self._parts), frozenset(self._smooth))
