"""The one way files are written: beside their place, and moved there whole.

Whatever fails, the file that was there stays as it was. Bytes are on the disk before the move, so that
not even a loss of power leaves a file that is empty.
"""

import os
import secrets
import shutil
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import BinaryIO

from bondgraph.errors import WriteError

Name = str | os.PathLike[str]


@contextmanager
def replacing(path: Name) -> Iterator[BinaryIO]:
    """A new file to write into, which takes the place of the one at ``path`` once all is written.

    The new file has the rights of the one before; a link stays a link. What is no file on a disk, such as
    a pipe or a terminal, is written to as it is. Raises `WriteError`, which names the path.
    """
    with telling(path):
        if _passes_on(path):
            with Path(path).open("wb") as file:
                yield file
            return
        target = Path(os.path.realpath(path))
        if target.is_dir():
            raise IsADirectoryError(21, "it is a folder")
        beside = target.with_name(f".bondgraph-{secrets.token_hex(8)}.tmp")
        try:
            with beside.open("xb") as file:
                yield file
                file.flush()
                os.fsync(file.fileno())
            if target.exists():
                shutil.copymode(target, beside)
            os.replace(beside, target)
        finally:
            beside.unlink(missing_ok=True)


def partial_of(path: Name) -> Path:
    """Where a file grows before it is whole: ``run.csv`` as ``run.partial.csv``.

    >>> partial_of("out/run.csv").as_posix()
    'out/run.partial.csv'
    """
    target = Path(path)
    return target.with_name(f"{target.stem}.partial{target.suffix}")


@contextmanager
def growing(path: Name) -> Iterator[BinaryIO]:
    """As `replacing`, for a file that is long in the making: it grows as `partial_of` calls it.

    That is what is left where the making ends halfway, unless nothing was written; the file that was there
    stays. An earlier one of that name is overwritten. Raises `WriteError` where there is no file on a disk,
    too.
    """
    with telling(path):
        target = Path(os.path.realpath(path))
        if target.is_dir():
            raise IsADirectoryError(21, "it is a folder")
        if _passes_on(path):
            raise OSError(22, "it is no file on a disk, which could grow beside its place")
        beside = partial_of(target)
        try:
            with beside.open("wb") as file:
                yield file
                file.flush()
                os.fsync(file.fileno())
            if target.exists():
                shutil.copymode(target, beside)
            os.replace(beside, target)
        except BaseException as error:
            if beside.exists() and beside.stat().st_size:
                error.add_note(f"what was written before that is in {beside}")
            else:
                beside.unlink(missing_ok=True)
            raise


def write_bytes(path: Name, raw: bytes) -> None:
    """Write a file, see `replacing`."""
    with replacing(path) as file:
        file.write(raw)


def write_text(path: Name, text: str) -> None:
    """Write a file of UTF-8 with the ends of lines that the text has, see `replacing`."""
    write_bytes(path, text.encode())


def write_all(texts: Mapping[Path, str]) -> None:
    """Write several files: none takes its place before every one is written. Makes their folders."""
    for folder in dict.fromkeys(path.parent for path in texts):
        made_folder(folder)
    with ExitStack() as files:
        for path, text in texts.items():
            files.enter_context(replacing(path)).write(text.encode())


def made_folder(path: Path) -> Path:
    """The folder itself, made if there is none; `WriteError` where that cannot be."""
    with telling(path):
        path.mkdir(parents=True, exist_ok=True)
    return path


@contextmanager
def telling(path: Name) -> Iterator[None]:
    """What the system refuses inside is told as a `WriteError` that names the path."""
    try:
        yield
    except WriteError:
        raise
    except OSError as error:
        reason = error.strerror or str(error)
        raise WriteError(f"{os.fspath(path)} cannot be written: {reason}") from error


def _passes_on(path: Name) -> bool:
    """Whether this is a device, a pipe or a stream of this process rather than a place on a disk."""
    if os.path.abspath(path).startswith(("/dev/", "/proc/")):
        return True
    target = Path(path)
    return target.exists() and not (target.is_file() or target.is_dir())
