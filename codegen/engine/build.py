"""C sources as shared libraries: compiled once, kept in the user's cache, loaded through cffi."""

import hashlib
import os
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from pathlib import Path
from typing import Any

from bondgraph.errors import MissingExtraError, SimulationError, WriteError
from bondgraph.writing import made_folder, telling
from codegen.engine.cache import cache_folder, keep, kept, temporary, workshop
from codegen.engine.compiler import call, compiler, machine, version, words

FLAGS = ("-O3", "-std=c99", "-ffp-contract=fast", "-march=native")
"""For code that runs on this machine: all its instructions, fused multiplications among them."""

PARTS = 4
"""So many compilers may run side by side."""


def check_tools() -> None:
    """Refuse to go on without a C compiler or cffi; `MissingExtraError`."""
    compiler()
    _interface()


def compiled(sources: Mapping[str, str], flags: Sequence[str] = FLAGS) -> Path:
    """The shared library of these sources, file name to text; compiled unless the cache has it.

    ``CFLAGS`` of the environment come after ``flags``, and override them. A cache that cannot be used,
    or has no room, gives way to a folder that ends with this process.

    Several processes may do so at once: a library appears whole or not at all. Raises
    `MissingExtraError` without a compiler, `SimulationError` with its message if it refuses, `WriteError`
    where there is no room anywhere.
    """
    command = compiler()
    flags = [*flags, *words("CFLAGS")]
    fingerprint = _fingerprint(sources, flags, command)
    command = (*command, *flags)
    try:
        return _found(sources, command, cache_folder(), fingerprint)
    except WriteError:
        return _found(sources, command, temporary(), fingerprint)


def _found(
    sources: Mapping[str, str], command: Sequence[str], folder: Path, fingerprint: str
) -> Path:
    """The library in a folder, compiled unless it is there; `WriteError` where it cannot be."""
    found = kept(folder, fingerprint)
    if found is not None:
        return found
    made_folder(folder)
    return _made(sources, command, folder, fingerprint)


def _made(
    sources: Mapping[str, str], command: Sequence[str], folder: Path, fingerprint: str
) -> Path:
    """Compile into a folder; `WriteError` where that has no room."""
    with workshop(folder) as room:
        with telling(room):
            for name, text in sources.items():
                (room / name).write_text(text, encoding="utf-8")
        made = room / "library.so"
        units = [name for name in sources if name.endswith(".c")]
        try:
            link([*command, "-fPIC", "-I."], ["-lm"], shares(sources, units, PARTS), made)
        except SimulationError as error:
            if "No space left on device" in str(error):
                raise WriteError(f"{room} cannot be written: No space left on device") from None
            raise
        return keep(made, folder, fingerprint)


def link(
    command: Sequence[str], libraries: Sequence[str], parts: Sequence[Sequence[str]], made: Path
) -> None:
    """Compile files that lie in a library's folder, parts side by side, and link them to the library.

    A part is one text of all its files: to start a compiler for each takes far longer. What is not optimised
    is compiled by one call, as there is nothing to wait for.

    Raises what `call` raises.
    """
    room = made.parent
    if [one for one in command if one.startswith("-O")][-1:] == ["-O0"]:
        every = [file for part in parts for file in part]
        call([*command, "-shared", "-o", made.name, *every, *libraries], room, made)
        return
    names = [f"part_{at}" for at in range(len(parts))]
    with telling(room):
        for name, files in zip(names, parts, strict=True):
            text = "".join(f'#include "{file}"\n' for file in files)
            (room / f"{name}.c").write_text(text, encoding="utf-8", newline="\n")

    def compile_part(name: str) -> None:
        call([*command, "-c", "-o", f"{name}.o", f"{name}.c"], room, room / f"{name}.o")

    with ThreadPoolExecutor(max_workers=min(len(parts), os.cpu_count() or 1)) as threads:
        for _ in threads.map(compile_part, names):
            pass
    objects = [f"{name}.o" for name in names]
    call([*command, "-shared", "-o", made.name, *objects, *libraries], room, made)


def shares(sources: Mapping[str, str], units: Sequence[str], count: int) -> list[list[str]]:
    """Files in so many parts of about one length, the same on every machine: what is compiled together
    may round otherwise than alone.

    >>> shares({"a.c": "longest", "b.c": "long", "c.c": "two"}, ["a.c", "b.c", "c.c"], 2)
    [['a.c'], ['b.c', 'c.c']]
    """
    parts: list[list[str]] = [[] for _ in range(count)]
    lengths = [0] * count
    for name in sorted(units, key=lambda one: (-len(sources[one]), one)):
        least = lengths.index(min(lengths))
        parts[least].append(name)
        lengths[least] += len(sources[name])
    return [part for part in parts if part]


def loaded(library: Path, declarations: str) -> tuple[Any, Any]:
    """cffi's interface with these declarations, and the library opened through it.

    Raises `MissingExtraError` without cffi, `SimulationError` for a library that does not open.
    """
    ffi = _declared(_interface(), declarations)
    try:
        return ffi, ffi.dlopen(str(library))
    except OSError as error:
        raise SimulationError(f"the library {library} does not open: {error}") from None


@lru_cache(maxsize=32)
def _declared(interface: Any, declarations: str) -> Any:
    """cffi's interface; reading declarations takes longer than opening a library, and many have the same."""
    ffi = interface()
    ffi.cdef(declarations)
    return ffi


def _interface() -> Any:
    try:
        from cffi import FFI
    except ImportError:
        raise MissingExtraError(
            "backend 'c' needs cffi; install the optional extra: pip install "
            '"bondgraph-toolkit[c]"'
        ) from None
    return FFI


def _fingerprint(sources: Mapping[str, str], flags: Sequence[str], command: tuple[str, ...]) -> str:
    parts = [*flags, *command, version(command), machine()]
    for name in sorted(sources):
        parts += [name, sources[name]]
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:40]
