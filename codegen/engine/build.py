"""C sources as shared libraries: compiled once, kept in the user's cache, loaded through cffi."""

import hashlib
import importlib.util
import os
import platform
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from bondgraph import MissingExtraError, SimulationError

FLAGS = ("-O3", "-std=c99", "-ffp-contract=fast", "-march=native")
"""For code that runs on this machine: all its instructions, fused multiplications among them."""

PACKAGE = "bondgraph-toolkit"
"""The folder in the user's cache."""


def compiler() -> tuple[str, ...]:
    """The command of a C compiler: ``CC``, else cc, gcc or clang, else that of the package ziglang.

    Raises `MissingExtraError` where there is none.
    """
    chosen = shlex.split(os.environ.get("CC", ""))
    if chosen:
        return tuple(chosen)
    for name in ("cc", "gcc", "clang"):
        found = shutil.which(name)
        if found is not None:
            return (found,)
    if importlib.util.find_spec("ziglang") is not None:
        return (sys.executable, "-m", "ziglang", "cc")
    raise MissingExtraError(
        "backend 'c' needs a C compiler, and there is none: install the system's (gcc or clang, such as "
        "the package build-essential; CC names another), or the wheel: pip install ziglang"
    )


def check_tools() -> None:
    """Refuse to go on without a C compiler or cffi; `MissingExtraError`."""
    compiler()
    _interface()


def compiled(sources: Mapping[str, str], flags: Sequence[str] = FLAGS) -> Path:
    """The shared library of these sources, file name to text; compiled unless the cache has it.

    ``CFLAGS`` of the environment come after ``flags``, and override them.

    Several processes may do so at once: a library appears whole or not at all. Raises
    `MissingExtraError` without a compiler, `SimulationError` with its message if it refuses.
    """
    command = compiler()
    flags = [*flags, *shlex.split(os.environ.get("CFLAGS", ""))]
    library = cache_folder() / f"{_fingerprint(sources, flags, command)}.so"
    if library.exists():
        return library
    library.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=library.parent) as folder:
        for name, text in sources.items():
            (Path(folder) / name).write_text(text, encoding="utf-8")
        made = Path(folder) / library.name
        units = sorted(name for name in sources if name.endswith(".c"))
        ending = ["-shared", "-fPIC", "-I.", "-o", made.name, *units, "-lm"]
        _call([*command, *flags, *ending], folder)
        os.replace(made, library)
    return library


def loaded(library: Path, declarations: str) -> tuple[Any, Any]:
    """cffi's interface with these declarations, and the library opened through it.

    Raises `MissingExtraError` without cffi.
    """
    ffi = _interface()()
    ffi.cdef(declarations)
    return ffi, ffi.dlopen(str(library))


def cache_folder() -> Path:
    """Where libraries are kept: below ``XDG_CACHE_HOME``, or ``~/.cache``."""
    home = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    return Path(home) / PACKAGE


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
    parts = [*flags, *command, _version(command), _machine()]
    for name in sorted(sources):
        parts += [name, sources[name]]
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:40]


@cache
def _version(command: tuple[str, ...]) -> str:
    return _call([*command, "--version"])


@cache
def _machine() -> str:
    """What the machine's own instructions depend on."""
    lines: list[str] = []
    try:
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace")
        lines = [line for line in text.splitlines() if line.startswith(("flags", "Features"))][:1]
    except OSError:
        pass
    return "\n".join([platform.system(), platform.machine(), platform.processor(), *lines])


def _call(command: Sequence[str], folder: str | None = None) -> str:
    """Run a compiler; what it prints."""
    try:
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    except OSError as error:
        raise MissingExtraError(
            f"the C compiler {shlex.join(command[:1])} does not start ({error}); set CC to one that does, "
            "unset it to use the system's, or install the wheel: pip install ziglang"
        ) from None
    if done.returncode:
        raise SimulationError(
            f"the C compiler failed: {shlex.join(command)}\n{done.stderr.strip()[-2000:]}"
        )
    return done.stdout
