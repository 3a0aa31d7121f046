"""The C compiler: which one, what it calls itself, and how it is called."""

import importlib.util
import os
import platform
import shlex
import shutil
import subprocess
import sys
from collections.abc import Sequence
from functools import cache
from pathlib import Path

from bondgraph.errors import MissingExtraError, SimulationError


def compiler() -> tuple[str, ...]:
    """The command of a C compiler: ``CC``, else cc, gcc or clang, else that of the package ziglang.

    Raises `MissingExtraError` where there is none.
    """
    found = system_compiler()
    if found is not None:
        return found
    if importlib.util.find_spec("ziglang") is not None:
        return (sys.executable, "-m", "ziglang", "cc")
    raise MissingExtraError(
        "backend 'c' needs a C compiler, and there is none: install the system's (gcc or clang, such as "
        "the package build-essential; CC names another), or the wheel: pip install ziglang"
    )


def system_compiler() -> tuple[str, ...] | None:
    """The command of ``CC``, else of cc, gcc or clang, if there is one."""
    chosen = words("CC")
    if chosen:
        return chosen
    for name in ("cc", "gcc", "clang"):
        found = shutil.which(name)
        if found is not None:
            return (found,)
    return None


def words(variable: str) -> tuple[str, ...]:
    """The words of a variable of the environment; `MissingExtraError` where a quote stays open."""
    text = os.environ.get(variable, "")
    try:
        return tuple(shlex.split(text))
    except ValueError as error:
        raise MissingExtraError(
            f"{variable} is {text!r}, which is no command ({error}); close the quote or unset it"
        ) from None


def call(
    command: Sequence[str], folder: str | Path | None = None, makes: Path | None = None
) -> str:
    """Run a compiler, however long it takes; what it prints. ``makes``: the file that must be there then.

    Raises `MissingExtraError` for one that does not start, `SimulationError` for what it refuses.
    """
    # Words that are looked for in what it says are those of no language.
    environment = {**os.environ, "LC_ALL": "C"}
    try:
        done = subprocess.run(
            command, cwd=folder, env=environment, capture_output=True, text=True, errors="replace",
            check=False,
        )  # fmt: skip
    except OSError as error:
        raise MissingExtraError(
            f"the C compiler {shlex.join(command[:1])} does not start ({error}); set CC to one that does, "
            "unset it to use the system's, or install the wheel: pip install ziglang"
        ) from None
    if done.returncode:
        raise SimulationError(
            f"the C compiler failed: {shlex.join(command)}\n{done.stderr.strip()[-2000:]}"
        )
    if makes is not None and not makes.is_file():
        raise SimulationError(
            f"the C compiler {shlex.join(command[:1])} says that all went well and made no library; set CC "
            "to a C compiler, or unset it to use the system's"
        )
    return done.stdout


@cache
def version(command: tuple[str, ...]) -> str:
    """What a compiler calls itself."""
    return call([*command, "--version"])


@cache
def machine() -> str:
    """What the machine's own instructions depend on."""
    lines: list[str] = []
    try:
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace")
        lines = [line for line in text.splitlines() if line.startswith(("flags", "Features"))][:1]
    except OSError:
        pass
    return "\n".join([platform.system(), platform.machine(), platform.processor(), *lines])
