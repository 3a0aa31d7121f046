"""Ways of going on, of which one takes over where another gives up: exact in C, located in C, numpy."""

import warnings
from collections.abc import Callable, Sequence
from typing import TypeVar

from codegen.engine.fallback import BackendWarning, Stopped
from codegen.model.kept import Paused
from codegen.model.outside import outside
from codegen.model.snapshot import Mode
from codegen.numbers.arrays import Array
from codegen.runs.track import Event
from codegen.stepping.going import GaveUpError, Given, Going
from codegen.stepping.plan import Row

Made = TypeVar("Made")


class FallingGoing:
    """The first way that can go on, and from there on no earlier one; the last, numpy, never gives up."""

    def __init__(self, ways: Sequence[Callable[[], Going]]) -> None:
        self._ways, self._place, self._begun = tuple(ways), 0, False
        self._under: tuple[Sequence[Given], float] = (), 0.0
        self._going = self._first()

    @property
    def backend(self) -> str:
        """See `Going`."""
        return self._going.backend

    def under(self, given: Sequence[Given], t: float) -> None:
        """See `Going`."""
        self._under = given, t
        try:
            self._going.under(given, t)
        except GaveUpError as gave:
            self._fall(gave, self._begun, lambda _: None)

    def begin(self, t: float, s: Array, mode: Mode) -> Sequence[Event]:
        """See `Going`."""
        return self._do(lambda going: going.begin(t, s, mode))

    def advance(self, stop: float, anew: bool) -> Sequence[Event]:
        """See `Going`."""
        try:
            return self._going.advance(stop, anew)
        except GaveUpError as gave:
            return self._fall(gave, True, lambda going: going.advance(stop, anew))

    def row(self) -> Row:
        """See `Going`."""
        return self._going.row()

    def paused(self) -> Paused:
        """See `Going`."""
        return self._going.paused()

    def take_up(self, paused: Paused) -> None:
        """See `Going`."""
        self._do(lambda going: going.take_up(paused))

    def _do(self, action: Callable[[Going], Made]) -> Made:
        """What says where the run is, whatever was before."""
        try:
            made = action(self._going)
        except GaveUpError as gave:
            made = self._fall(gave, False, action)
        self._begun = True
        return made

    def _first(self) -> Going:
        while True:
            try:
                return self._ways[self._place]()
            except GaveUpError as gave:
                self._place += 1
                if self._place == len(self._ways) - 1:
                    _tell(gave.stopped)

    def _fall(self, gave: GaveUpError, carried: bool, action: Callable[[Going], Made]) -> Made:
        """Let the next way do what this one gives up, from where it is if that is ``carried``.

        What none can do leaves this one as it was.
        """
        paused = self._going.paused() if carried else None
        place, last = self._place, len(self._ways) - 1
        while True:
            place = last if gave.endless else place + 1
            if place == last and gave.stopped.limit:
                _tell(gave.stopped)
            try:
                going = self._ways[place]()
                going.under(*self._under)
                if paused is not None:
                    going.take_up(paused)
                found = action(going)
            except GaveUpError as again:
                gave = again
                continue
            break
        if place == last and not gave.stopped.limit:
            _tell(gave.stopped)
        self._going, self._place = going, place
        return found


def _tell(stopped: Stopped) -> None:
    text = f"numpy steps what backend 'c' was asked to: {stopped}"
    warnings.warn(text, BackendWarning, stacklevel=outside())
