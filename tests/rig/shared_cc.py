"""A C compiler that keeps the object of each unit by all that it depends on.

Run as a script, by bare Python: FOLDER COMPILER ARGUMENTS. Calls that are no builds of C files go to the
compiler as they are. A unit's object depends on the compiler, the flags, the unit's text, and the texts of
what it includes from its own folder or one given by ``-I``; comments do not count, so that two models of the
same sizes have all in common that depends on those alone.
"""

import fcntl
import hashlib
import os
import re
import subprocess
import sys
from collections.abc import Iterator, Sequence
from functools import cache

ALONE = ("-c", "-E", "-S", "-fsyntax-only", "-M", "-MM", "-x", "-v", "-###")
"""Flags of calls that are no links of units."""

WITH_ARGUMENT = ("-o", "-I", "-D", "-U", "-l", "-L", "-include", "-isystem")

INCLUDED = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]', re.M)

COMMENT = re.compile(r'"(?:\\.|[^"\\\n])*"|/\*.*?\*/', re.S)


def main(folder: str, compiler: str, arguments: Sequence[str]) -> int:
    """The status of the link, or of the first unit that is refused."""
    parts = split(arguments)
    if parts is None:
        os.execv(compiler, [compiler, *arguments])
    units, flags, places, rest = parts
    objects = []
    for unit in units:
        status, found = compiled(folder, compiler, unit, flags, places)
        if status:
            return status
        objects.append(found)
    inputs = [objects.pop(0) if one in units else one for one in rest]
    return subprocess.run([compiler, *flags, *inputs], check=False).returncode


def split(arguments: Sequence[str]) -> tuple[list[str], list[str], list[str], list[str]] | None:
    """C files, flags of their compilation, folders of headers, and the rest in order with the C files."""
    units: list[str] = []
    flags: list[str] = []
    places: list[str] = []
    rest: list[str] = []
    waiting = iter(arguments)
    for one in waiting:
        if one in ALONE or one.startswith("@"):
            return None
        value = [next(waiting, "")] if one in WITH_ARGUMENT else []
        if one.endswith(".c"):
            units.append(one)
            rest.append(one)
        elif one.startswith("-I"):
            places.append("".join([one[2:], *value]))
        elif one.startswith(("-o", "-l", "-L")) or not one.startswith("-"):
            rest += [one, *value]
        else:
            flags += [one, *value]
    return (units, flags, places, rest) if units and "-o" in rest else None


def compiled(
    folder: str, compiler: str, unit: str, flags: Sequence[str], places: Sequence[str]
) -> tuple[int, str]:
    """The status, and the object: kept, or compiled while others that want it wait."""
    key = fingerprint(compiler, unit, flags, places)
    kept = os.path.join(folder, "objects", key[:2], key + ".o")
    os.makedirs(os.path.dirname(kept), exist_ok=True)
    with open(kept + ".lock", "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        known = os.path.exists(kept)
        note(folder, "shared" if known else "compiled")
        if known:
            return 0, kept
        made = f"{kept}.{os.getpid()}"
        # A unit with warnings is not kept: whoever compiles it is to see them.
        command = [compiler, *flags, *(f"-I{place}" for place in places), "-c", unit, "-o", made]
        done = subprocess.run(command, capture_output=True, check=False)
        sys.stdout.buffer.write(done.stdout)
        sys.stderr.buffer.write(done.stderr)
        if done.returncode or done.stderr:
            return done.returncode, made
        os.replace(made, kept)
    return 0, kept


def fingerprint(compiler: str, unit: str, flags: Sequence[str], places: Sequence[str]) -> str:
    """All that the object of a unit depends on."""
    status = os.stat(compiler)
    parts = [compiler, str(status.st_mtime_ns), *flags, os.path.basename(unit)]
    for name, text in texts(unit, tuple(places)):
        parts += [name, text]
    return hashlib.sha256("\0".join(parts).encode("utf-8", "surrogateescape")).hexdigest()


def texts(unit: str, places: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    """The unit and what it includes, and so on, less comments; what is found nowhere is the system's."""
    seen, waiting = set(), [unit]
    while waiting:
        path = waiting.pop()
        if path in seen:
            continue
        seen.add(path)
        text, included = read(path)
        if text is None:
            continue
        yield os.path.basename(path), text
        for name in included:
            near = [os.path.join(place, name) for place in (os.path.dirname(path), *places)]
            waiting += [next((one for one in near if os.path.exists(one)), name)]


@cache
def read(path: str) -> tuple[str | None, tuple[str, ...]]:
    """A file less its comments, and what it includes; many units of a call include the same."""
    try:
        with open(path, encoding="utf-8", errors="surrogateescape") as file:
            text = file.read()
    except OSError:
        return None, ()
    plain = COMMENT.sub(lambda found: found[0] if found[0][0] == '"' else " ", text)
    return plain, tuple(INCLUDED.findall(text))


def note(folder: str, word: str) -> None:
    """A word for the count at the end."""
    with open(os.path.join(folder, "log"), "a", encoding="utf-8") as log:
        log.write(word + "\n")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2], sys.argv[3:]))
