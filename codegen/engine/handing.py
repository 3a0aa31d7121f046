"""What C calls to hand over what a run has recorded, while it goes on."""

from collections.abc import Callable
from contextlib import suppress
from typing import Any

Take = Callable[[int, int], bool]
"""Takes the first so many samples, and events, that there are; whether it could."""


class Handing:
    """A function for C, which passes on to whoever takes at the time.

    ``call``: the function; None on machines that let no code be made.
    """

    def __init__(self, ffi: Any) -> None:
        self.call: Any = None
        self.take: Take | None = None
        #: What was raised as something was taken.
        self.failed: BaseException | None = None
        with suppress(MemoryError):
            self.call = ffi.callback("int(void *, int, int)", self._asked)

    def _asked(self, _: Any, samples: int, events: int) -> int:
        """0 if these have been taken."""
        try:
            return 0 if self.take is not None and self.take(samples, events) else 1
        except BaseException as error:  # noqa: BLE001 - C comes between here and who is to be told
            self.failed = error
        return 1
