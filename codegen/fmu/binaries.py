"""A unit's sources as shared libraries for one platform or several, and the headers they need."""

import importlib.util
import platform
import struct
import sys
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from bondgraph.errors import MissingExtraError, SignalError, SimulationError
from bondgraph.writing import telling
from codegen.engine.build import PARTS, link, shares
from codegen.engine.cache import workshop
from codegen.engine.compiler import system_compiler, words

FLAGS = ("-std=c99", "-O2", "-g0", "-fvisibility=hidden")

HEADERS: Mapping[str, tuple[str, ...]] = {
    "2.0": ("fmi2Functions.h", "fmi2FunctionTypes.h", "fmi2TypesPlatform.h"),
    "3.0": ("fmi3Functions.h", "fmi3FunctionTypes.h", "fmi3PlatformTypes.h"),
}
"""The standard's own headers, by its version."""


@dataclass(frozen=True)
class Platform:
    """How FMI 3.0 and 2.0 call a platform, how its libraries end, and what ziglang calls it."""

    name: str
    second: str
    ending: str
    target: str


PLATFORMS: Mapping[str, Platform] = {
    one.name: one
    for one in (
        # Linux binaries run with every glibc from this one on.
        Platform("x86_64-linux", "linux64", ".so", "x86_64-linux-gnu.2.17"),
        Platform("aarch64-linux", "aarch64-linux", ".so", "aarch64-linux-gnu.2.17"),
        Platform("x86_64-windows", "win64", ".dll", "x86_64-windows-gnu"),
        Platform("x86_64-darwin", "darwin64", ".dylib", "x86_64-macos"),
        Platform("aarch64-darwin", "darwin64", ".dylib", "aarch64-macos"),
    )
}
"""The platforms that binaries can be made for, by the names of FMI 3.0."""

_MACHINES = {"amd64": "x86_64", "x86_64": "x86_64", "arm64": "aarch64", "aarch64": "aarch64"}


def this_platform() -> str:
    """The name of this machine's platform."""
    machine = _MACHINES.get(platform.machine().lower(), platform.machine().lower())
    return f"{machine}-{platform.system().lower()}"


def chosen_platforms(platforms: str | Iterable[str] | None) -> tuple[str, ...]:
    """This machine's, "all", or those named; `SignalError` for other names."""
    if platforms is None:
        platforms = [this_platform()]
    elif isinstance(platforms, str):
        platforms = PLATFORMS if platforms == "all" else [platforms]
    names = tuple(dict.fromkeys(platforms))
    for name in names:
        if name not in PLATFORMS:
            known = ", ".join(PLATFORMS)
            raise SignalError(f"platform {name!r}: there is {known}, or 'all'")
    if not names:
        raise SignalError("platforms: a unit needs one at least")
    return names


def headers(version: str) -> dict[str, str]:
    """The official headers, as the package fmpy has them; `MissingExtraError` without it."""
    folder = _package("fmpy", "write_fmu takes FMI's headers from fmpy") / "c-code"
    try:
        return {name: (folder / name).read_text(encoding="utf-8") for name in HEADERS[version]}
    except OSError as error:
        raise MissingExtraError(
            f"the package fmpy has no header {error.filename}; install another: pip install "
            '"bondgraph-toolkit[export]"'
        ) from None


def binaries(
    sources: Mapping[str, str], identifier: str, platforms: Sequence[str], version: str
) -> dict[str, bytes]:
    """Shared libraries by their path in the unit. On this machine its own compiler is taken.

    ``CFLAGS`` of the environment come after its flags, and override them.
    """
    made: dict[str, dict[str, bytes]] = {}
    parts = _parts(sources)
    with workshop(Path(tempfile.gettempdir())) as folder:
        with telling(folder):
            for name, text in sources.items():
                (folder / name).write_text(text, encoding="utf-8", newline="\n")
        for name in platforms:
            one = PLATFORMS[name]
            place = one.name if version == "3.0" else one.second
            path = f"binaries/{place}/{identifier}{one.ending}"
            made.setdefault(path, {})[name] = _compiled(folder, parts, identifier, one)
    return {path: _joined(found) for path, found in made.items()}


def _parts(sources: Mapping[str, str]) -> list[list[str]]:
    """The files in parts, the unit's own apart from the model's."""
    files = sorted(name for name in sources if name.endswith(".c"))
    own = [name for name in files if name.startswith("fmu")]
    return [own, *shares(sources, [name for name in files if name not in own], PARTS - 1)]


def _compiled(
    folder: Path, parts: Sequence[Sequence[str]], identifier: str, where: Platform
) -> bytes:
    made = folder / f"{identifier}{where.ending}"
    alone = where.ending == ".dll"
    compiler, own = _compiler(where)
    command = [*compiler, *FLAGS, *([] if alone else ["-fPIC"]), *own, "-I."]
    try:
        link(command, [] if alone else ["-lm"], parts, made)
    except SimulationError as error:
        raise SimulationError(f"{where.name}: {error}") from None
    return made.read_bytes()


def _compiler(where: Platform) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The system's compiler for this machine, if there is one, with the user's flags; else ziglang's."""
    if where.name == this_platform():
        found = system_compiler()
        if found is not None:
            return found, words("CFLAGS")
    _package("ziglang", f"binaries for {where.name} are made by ziglang's compiler")
    return (sys.executable, "-m", "ziglang", "cc", "-target", where.target, "-s"), ()


def _package(name: str, why: str) -> Path:
    found = importlib.util.find_spec(name)
    if found is None or not found.submodule_search_locations:
        raise MissingExtraError(
            f'{why}; install the optional extra: pip install "bondgraph-toolkit[export]"'
        )
    return Path(found.submodule_search_locations[0])


_ALIGNMENT = 14
"""Parts of a universal binary begin at multiples of two to this power."""

_KINDS = {"x86_64-darwin": (0x01000007, 3), "aarch64-darwin": (0x0100000C, 0)}
"""Processor and variant, as a universal binary numbers them."""


def _joined(found: Mapping[str, bytes]) -> bytes:
    """One library as it is; those of several Macs as a universal binary."""
    if len(found) == 1:
        return next(iter(found.values()))
    head, parts = struct.pack(">II", 0xCAFEBABE, len(found)), b""
    start = 1 << _ALIGNMENT
    for name in sorted(found):
        place = start + len(parts)
        head += struct.pack(">IIIII", *_KINDS[name], place, len(found[name]), _ALIGNMENT)
        parts += found[name] + b"\0" * (-len(found[name]) % start)
    return head + b"\0" * (start - len(head)) + parts
