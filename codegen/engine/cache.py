"""Libraries that are kept: found by what they were made of, checked by what they are.

A library's name has a digest of its sources and one of its own bytes. What does not agree with the
second, because a write was cut short or somebody else wrote it, is none of ours and is made anew.
"""

import hashlib
import os
import shutil
import socket
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path

from bondgraph.writing import telling

PACKAGE = "bondgraph-toolkit"
"""The folder in the user's cache."""

MAKING = "bondgraph-making"
"""How folders begin in which something is being compiled."""


def cache_folder() -> Path:
    """Where libraries are kept: below ``XDG_CACHE_HOME``, or ``~/.cache``."""
    home = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    return Path(home) / PACKAGE


def kept(folder: Path, fingerprint: str) -> Path | None:
    """The library of these sources; one whose bytes are not those it was kept with is thrown away."""
    for path in sorted(folder.glob(f"{fingerprint}-*.so")):
        with suppress(OSError):
            if path.stem == f"{fingerprint}-{_digest(path.read_bytes())}":
                return path
        with suppress(OSError):
            path.unlink()
    return None


def keep(library: Path, folder: Path, fingerprint: str) -> Path:
    """Move a library from a `workshop` in this folder to where `kept` finds it; its place.

    It appears whole or not at all. It need not be on the disk by then: one that a loss of power cuts
    short is known by its digest. Raises `WriteError` where it cannot be moved.
    """
    place = folder / f"{fingerprint}-{_digest(library.read_bytes())}.so"
    with telling(place):
        os.replace(library, place)
    return place


def temporary() -> Path:
    """A folder for what no cache takes, which ends with this process.

    Raises `WriteError` where there is no room for that either.
    """
    return Path(_temporary().name)


@cache
def _temporary() -> "tempfile.TemporaryDirectory[str]":
    home = Path(tempfile.gettempdir())
    _tidy(home, f"{PACKAGE}-")
    with telling(home):
        return tempfile.TemporaryDirectory(prefix=_own(f"{PACKAGE}-"), dir=home)


@contextmanager
def workshop(folder: Path) -> Iterator[Path]:
    """A folder to compile in, inside this one; what processes that were killed have left is removed.

    Raises `WriteError` where it cannot be made.
    """
    _tidy(folder, f"{MAKING}-")
    with telling(folder):
        made = tempfile.TemporaryDirectory(
            prefix=_own(f"{MAKING}-"), dir=folder, ignore_cleanup_errors=True
        )
    with made as name:
        yield Path(name)


def _digest(raw: bytes) -> str:
    return hashlib.sha256(raw).hexdigest()[:32]


def _own(kind: str) -> str:
    """How names of this process's folders begin: it is told from others by machine and number."""
    return f"{kind}{socket.gethostname()}-{os.getpid()}-"


def _tidy(folder: Path, kind: str) -> None:
    """Remove the folders of processes of this machine that are no more."""
    mine = f"{kind}{socket.gethostname()}-"
    for path in folder.glob(f"{kind}*"):
        number = path.name.removeprefix(mine).partition("-")[0]
        if path.name.startswith(mine) and number.isdigit() and not _lives(int(number)):
            shutil.rmtree(path, ignore_errors=True)


def _lives(process: int) -> bool:
    """Whether a process of this number is there; on Windows nobody can ask without ending it."""
    if os.name == "nt":
        return True
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return True
