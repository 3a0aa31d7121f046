"""What units of FMI 2 call back: they log with C's variadic arguments, which a proxy of fmpy fills in.

That proxy knows one listener in all the process, and keeps it for ever. So there is one, made when it is
first needed, which passes on what it hears to whoever made the unit; the rest is fmpy's to print.
"""

from collections.abc import Callable
from ctypes import byref
from functools import cache
from itertools import count
from typing import Any
from weakref import WeakValueDictionary

Heard = Callable[[int, bytes | None], None]
"""What a line of a log goes to: its status, and its text."""


class Listener:
    """One instance's: alive as long as its callbacks are."""

    def __init__(self, heard: Heard) -> None:
        self.heard = heard


class Switchboard:
    """The one listener of a process, and who is behind each number that units call it by."""

    def __init__(self) -> None:
        from fmpy import fmi1, fmi2

        self.listeners: WeakValueDictionary[int, Listener] = WeakValueDictionary()
        self.numbers = count(1)

        def told(at: Any, name: bytes, status: int, category: bytes, message: bytes) -> None:
            listener = self.listeners.get(at) if at else None
            if listener is None:
                fmi1.printLogMessage(None, name, status, category, message)
            else:
                listener.heard(status, message)

        self.told = fmi2.fmi2CallbackLoggerTYPE(told)


@cache
def _switchboard() -> Switchboard:
    return Switchboard()


def callbacks2(heard: Heard) -> Any:
    """The callbacks of an instance of FMI 2; whoever holds them is told what it logs."""
    from fmpy import calloc, fmi2, free

    board, listener = _switchboard(), Listener(heard)
    number = next(board.numbers)
    board.listeners[number] = listener
    made = fmi2.fmi2CallbackFunctions()
    made.logger = board.told
    made.allocateMemory = fmi2.fmi2CallbackAllocateMemoryTYPE(calloc)
    made.freeMemory = fmi2.fmi2CallbackFreeMemoryTYPE(free)
    made.componentEnvironment = number
    made.listener = listener
    # Where fmpy has no proxy for a platform, what C would fill in stays as it is written.
    proxy = getattr(fmi2, "addLoggerProxy", None)
    if proxy is not None:
        proxy(byref(made))
    return made
