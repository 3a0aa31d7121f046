"""A C compiler that keeps what it compiles by all that this depends on.

Run as a script, by bare Python: FOLDER COMPILER QUICK ARGUMENTS. Calls that are no builds of C files, or that
ask for warnings of each file as errors, go to the compiler as they are. The files of a build are compiled as
one, in a third of the time that they take one by one, but for those that only some programs of a model have,
which are one of their own; what comes of it depends on the compiler, the flags, the files' texts, and the
texts of what they include from their own folder or one given by ``-I``; comments do not count. Files that
are refused as one, or with a word, are compiled one by one, as without this program.

QUICK is another compiler, or nothing: tcc makes code that is not optimised in a thirtieth of the time. It is
asked where a call asks for no optimising and for nothing else that it does not know; where it has a word to
say, the compiler itself is. Of warnings that a call asks for the compiler tells first, and stops at the form
that it keeps for the link: so far it takes a third of the time.
"""

import fcntl
import hashlib
import os
import re
import subprocess
import sys
from collections.abc import Iterator, Sequence
from functools import cache

ALONE = ("-c", "-E", "-S", "-fsyntax-only", "-M", "-MM", "-x", "-v", "-###", "-Werror")
"""Flags of calls that are the compiler's own: no links of files, or checks of each."""

OWN = ("fmu", "batch")
"""How files begin that are compiled beside the others: a model's units of both versions share the rest, and
so do its runs one by one and all at once."""

WITH_ARGUMENT = ("-o", "-I", "-D", "-U", "-l", "-L", "-include", "-isystem")

NEEDLESS = (
    "-O",
    "-std=c99",
    "-ffp-contract=",
    "-march=native",
    "-fvisibility=hidden",
    "-g0",
    "-fPIC",
    "-shared",
)
"""How flags begin that a quick compiler is not told: they change nothing of what code that is not optimised
computes."""

CHECKED = ("-flto", "-fno-fat-lto-objects")
"""What has warnings told and no code made."""

INCLUDED = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]', re.M)

COMMENT = re.compile(r'"(?:\\.|[^"\\\n])*"|/\*.*?\*/', re.S)


def main(folder: str, compiler: str, quick: str, arguments: Sequence[str]) -> int:
    """The status of the link, or of the first file that is refused."""
    parts = split(arguments)
    if parts is None:
        os.execv(compiler, [compiler, *arguments])
    files, flags, places, rest = parts
    objects = []
    told = plain(flags) if quick else None
    warned = any(one.startswith("-W") for one in flags)
    check = [compiler, *flags, *CHECKED] if warned else []
    for group in grouped(files):
        made = None if told is None else compiled(folder, quick, group, told, places, check)
        made = made or compiled(folder, compiler, group, flags, places)
        if made is None:
            return subprocess.run([compiler, *arguments], check=False).returncode
        objects.append(made)
    # Of objects by a compiler that does not say so the linker would warn that they want a stack to run.
    flags = [*flags, "-Wl,-z,noexecstack"] if told is not None else flags
    return subprocess.run([compiler, *flags, *objects, *rest], check=False).returncode


def grouped(files: Sequence[str]) -> list[list[str]]:
    """Files that are compiled as one, without the groups that have none."""
    own = [one for one in files if os.path.basename(one).startswith(OWN)]
    return [group for group in ([one for one in files if one not in own], own) if group]


def split(arguments: Sequence[str]) -> tuple[list[str], list[str], list[str], list[str]] | None:
    """C files, flags of their compilation, folders of headers, and the rest, which the link is given."""
    files: list[str] = []
    flags: list[str] = []
    places: list[str] = []
    rest: list[str] = []
    waiting = iter(arguments)
    for one in waiting:
        if one in ALONE or one.startswith("@"):
            return None
        value = [next(waiting, "")] if one in WITH_ARGUMENT else []
        if one.endswith(".c"):
            files.append(one)
        elif one.startswith("-I"):
            places.append("".join([one[2:], *value]))
        elif one.startswith(("-o", "-l", "-L")) or not one.startswith("-"):
            rest += [one, *value]
        else:
            flags += [one, *value]
    return (files, flags, places, rest) if files and "-o" in rest else None


def plain(flags: Sequence[str]) -> list[str] | None:
    """What a quick compiler is told, names and their values; None where it is not to be asked."""
    told: list[str] = []
    waiting = iter(flags)
    for one in waiting:
        if one in ("-D", "-U"):
            told += [one, next(waiting, "")]
        elif one.startswith(("-D", "-U")):
            told.append(one)
        elif one.startswith("-Wl,") or not one.startswith((*NEEDLESS, "-W")):
            return None
    wanted = [one for one in flags if one.startswith("-O")]
    return told if wanted[-1:] in ([], ["-O0"]) else None


def compiled(
    folder: str,
    compiler: str,
    files: Sequence[str],
    flags: Sequence[str],
    places: Sequence[str],
    check: Sequence[str] = (),
) -> str | None:
    """The object of all files: kept, or compiled while others that want it wait; None if there is none.

    ``check``: another compiler's call, which must have nothing to say of them.
    """
    key = fingerprint(compiler, files, [*flags, *check], places)
    kept = os.path.join(folder, "objects", key[:2], key + ".o")
    os.makedirs(os.path.dirname(kept), exist_ok=True)
    with open(kept + ".lock", "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        known = os.path.exists(kept)
        if not known:
            made = f"{kept}.{os.getpid()}"
            calls = [[compiler, *flags, "-o", made]]
            if check:
                calls.insert(0, [*check, "-o", os.devnull])
            if not all(silent(call, files, places) for call in calls):
                note(folder, "apart")
                return None
            os.replace(made, kept)
    note(folder, "shared" if known else "compiled")
    return kept


def silent(call: Sequence[str], files: Sequence[str], places: Sequence[str]) -> bool:
    """Whether a compiler takes all files as one, without a word."""
    near = [f"-I{place}" for place in places]
    done = subprocess.run(
        [*call, *near, "-x", "c", "-", "-c"],
        input=os.fsencode(joined(files)),
        capture_output=True,
        check=False,
    )
    return not (done.returncode or done.stderr)


def joined(files: Sequence[str]) -> str:
    """A text that is all files."""
    return "".join(f'#include "{os.path.abspath(one)}"\n' for one in files)


def fingerprint(
    compiler: str, files: Sequence[str], flags: Sequence[str], places: Sequence[str]
) -> str:
    """All that the object of these files depends on."""
    parts = [compiler, str(os.stat(compiler).st_mtime_ns), *flags]
    for file in files:
        for name, text in texts(file, tuple(places)):
            parts += [name, text]
    return hashlib.sha256("\0".join(parts).encode("utf-8", "surrogateescape")).hexdigest()


def texts(file: str, places: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    """The file and what it includes, and so on, less comments; what is found nowhere is the system's."""
    seen, waiting = set(), [file]
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
    """A file less its comments, and what it includes; many files of a call include the same."""
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
    sys.exit(main(*sys.argv[1:4], sys.argv[4:]))
