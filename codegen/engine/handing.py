"""What C calls to hand over what a run has recorded, while it goes on."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

Take = Callable[[int, int], bool]
"""Takes the first so many samples, and events, that there are; whether it could."""


def asked_by_c(
    ffi: Any, kind: str, function: Callable[..., int], keep: Callable[[BaseException], None]
) -> Any:
    """A function of a kind that C calls; what is raised in it goes to ``keep``, and C is told 1.

    So does Ctrl-C, which Python may raise before the function's first line.
    """

    def kept(_: Any, error: BaseException, __: Any) -> None:
        keep(error)

    return ffi.callback(kind, function, error=1, onerror=kept)


class Handing:
    """A function for C, which passes on to whoever takes at the time.

    ``call``: the function; None on machines that let no code be made.
    """

    def __init__(self, ffi: Any) -> None:
        self.call: Any = None
        self._take: Take | None = None
        #: What was raised as something was taken.
        self.failed: BaseException | None = None
        with suppress(MemoryError):
            self.call = asked_by_c(ffi, "int(void *, int, int)", self._asked, self._keep)

    @contextmanager
    def to(self, take: Take) -> Iterator[None]:
        """What is handed over inside goes there; what was raised as it was taken is raised at the end."""
        self._take, self.failed = take, None
        try:
            yield
        finally:
            self._take = None
        if self.failed is not None:
            failed, self.failed = self.failed, None
            raise failed

    def _asked(self, _: Any, samples: int, events: int) -> int:
        """0 if these have been taken."""
        return 0 if self._take is not None and self._take(samples, events) else 1

    def _keep(self, error: BaseException) -> None:
        self.failed = error
