"""A unit's library: unpacked, loaded, and freed again whatever happens."""

import os
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from bondgraph.errors import UnitError
from codegen.cosimulation.described import UnitDescription, fmpy_module
from codegen.cosimulation.listening import callbacks2

LATEST = 5
"""So many lines of a unit's log does a message show."""

LEVELS = ("ok", "warning", "discard", "error", "fatal", "pending")
DISCARD, FATAL = 2, 4


class Library:
    """An instance of a unit, and what it logged. ``dead``: after a fatal error nothing may be called."""

    def __init__(self, about: UnitDescription, name: str, loaded: Any) -> None:
        self.about, self.name, self.loaded = about, name, loaded
        self.log: deque[tuple[int, str]] = deque(maxlen=64)
        self.failed = self.dead = False

    def call(self, method: str, *arguments: Any) -> Any:
        """Call a function of the unit; `UnitError` with its log where it returns an error."""
        try:
            return getattr(self.loaded, method)(*arguments)
        except Exception as error:  # noqa: BLE001 - whatever fmpy makes of a status
            status = getattr(error, "status", None)
            self.failed, self.dead = True, status == FATAL
            why = (
                f"{getattr(error, 'function', method)} returned {_level(status)}"
                if status is not None
                else str(error)
            )
            hint = ""
            if status == DISCARD and method == "doStep":
                hint = "; it does not take this communication step: try another interval every="
            raise UnitError(f"participant {self.name!r}: {why}{self.logged}{hint}") from None

    def note(self, status: int, message: bytes | None) -> None:
        """A line of the unit's log."""
        self.log.append((status, (message or b"").decode("utf-8", "replace").strip()))

    @property
    def logged(self) -> str:
        """The latest of what the unit logged, complaints if there are any."""
        lines = [text for status, text in self.log if 0 < status < 5] or [
            text for _, text in self.log
        ]
        return f"; its log: {' | '.join(lines[-LATEST:])}" if lines else "; it logged nothing"


@contextmanager
def opened(about: UnitDescription, name: str) -> Iterator[Library]:
    """An instance of a unit; it is ended, freed, and its files are removed, on every way out.

    Raises `UnitError` where it cannot be unpacked, loaded or made.
    """
    fmpy = fmpy_module()
    with TemporaryDirectory(prefix="bondgraph-unit-", ignore_cleanup_errors=True) as folder:
        where = f"participant {name!r}: unit {str(about.path)!r}"
        try:
            fmpy.extract(str(about.path), unzipdir=folder)
        except Exception as error:  # noqa: BLE001 - whatever a broken archive leads to
            raise UnitError(f"{where} cannot be unpacked: {error}") from None
        (Path(folder) / "resources").mkdir(exist_ok=True)
        library = Library(about, name, _loaded(about, name, folder, where))
        try:
            _make(library, where)
        except BaseException:
            library.loaded.freeLibrary()
            raise
        try:
            yield library
        finally:
            _free(library)


def _loaded(about: UnitDescription, name: str, folder: str, where: str) -> Any:
    from fmpy.fmi2 import FMU2Slave
    from fmpy.fmi3 import FMU3Slave

    kind = FMU2Slave if about.second else FMU3Slave
    # fmpy goes to the library's folder, and stays there where it cannot be loaded.
    before = os.getcwd()
    try:
        return kind(
            guid=about.token,
            modelIdentifier=about.identifier,
            unzipDirectory=folder,
            instanceName=name,
        )
    except Exception as error:  # noqa: BLE001 - whatever the loader says
        raise UnitError(f"{where}: its library cannot be loaded: {error}") from None
    finally:
        os.chdir(before)


def _make(library: Library, where: str) -> None:
    """An instance, whose log is listened to."""
    try:
        if library.about.second:
            library.loaded.instantiate(callbacks=callbacks2(library.note), loggingOn=True)
        else:

            def heard(_: Any, status: int, __: bytes, message: bytes) -> None:
                library.note(status, message)

            library.loaded.instantiate(loggingOn=True, logMessage=heard)
    except Exception as error:  # noqa: BLE001 - whatever fmpy says
        raise UnitError(f"{where} makes no instance: {error}{library.logged}") from None


def _free(library: Library) -> None:
    loaded = library.loaded
    try:
        if not library.failed:
            loaded.terminate()
    except Exception as error:  # noqa: BLE001 - the run is over, or its own error is on the way
        library.dead = getattr(error, "status", None) == FATAL
    finally:
        if library.dead:
            loaded.freeLibrary()
        else:
            loaded.freeInstance()


def _level(status: object) -> str:
    if isinstance(status, int) and 0 <= status < len(LEVELS):
        return repr(LEVELS[status])
    return f"the status {status}"
