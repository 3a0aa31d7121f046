"""Whether exported C is fit for real time: nothing is allocated, and what a step does is bounded.

``python -m codegen.c.bounded FOLDER`` tells what it finds in the C files of a folder, and ends with 1 if
anything is.
"""

import re
import sys
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

STEP = ("bg_model_settle", "bg_model_advance", "bg_model_step")
"""What a real-time step calls: all that these reach must be bounded."""

PROGRAM = "main.c"
"""A desktop program, no part of what a target runs."""

ALLOCATES = ("malloc", "calloc", "realloc", "aligned_alloc", "alloca", "free", "strdup")

_WORD = re.compile(r"(?<![\w.>])[A-Za-z_]\w*(?:(?:->|\.)\w+)*")
"""A name, of a member the whole way to it."""

_FUNCTION = re.compile(
    r"^(?!typedef|struct|enum|union)[A-Za-z_][^;{}=]*?\b(\w+)\([^;{}]*\)\s*\n\{\n(.*?)^\}",
    re.M | re.S,
)
_ARRAY = re.compile(
    r"(?:^|[;{])\s*(?:static |const |unsigned |long |struct )*(?!return\b|else\b)[A-Za-z_]\w*\s"
    r"[\w\s*,\[\]]*?\w\[([^\]]*)\]",
    re.M,
)
_LOOP = re.compile(r"\b(for|while|do|goto)\b\s*(\()?")
_CHANGED = (
    r"(?<![\w.>])(?:\+\+|--)?\s*\b{name}\b\s*(?:\+\+|--|(?:[-+*/%&|^]|<<|>>)?=(?!=))"
    r"|(?:\+\+|--)\s*{name}\b"
)


@dataclass(frozen=True)
class Function:
    """A function of C: its file, name and body without comments; whether only that file sees it."""

    file: str
    name: str
    body: str
    own: bool

    @property
    def key(self) -> str:
        """What it is called among all files."""
        return f"{self.file}: {self.name}" if self.own else self.name


def findings(files: Mapping[str, str]) -> list[str]:
    """What in these files of C, name to text, is not fit for a real-time step; nothing if all is.

    Memory that is asked for, anywhere but in the desktop program; and in whatever a step reaches, function
    pointers included: an array whose length is not known when it is compiled, a loop without a counter that
    runs to a bound which the loop does not move, ``while``, ``do`` and ``goto`` at all, and recursion.
    """
    plain = {name: _plain(text) for name, text in files.items() if name != PROGRAM}
    found = [
        f"{name}: {word} asks for memory"
        for name, text in plain.items()
        for word in ALLOCATES
        if re.search(rf"\b{word}\s*\(", text)
    ]
    functions = {one.key: one for name, text in plain.items() for one in _functions(name, text)}
    calls = {key: _named(one.file, one.body, functions) for key, one in functions.items()}
    tables = {
        key for name, text in plain.items() for key in _named(name, _outside(text), functions)
    }
    reached = _reached({*STEP, *tables} & {*functions}, calls)
    for key in sorted(reached):
        found += _in_function(functions[key])
    return [*found, *_recursion(reached, calls)]


def _plain(text: str) -> str:
    """C without comments, texts and directives."""
    text = re.sub(r"/\*.*?\*/", " ", text, flags=re.S)
    text = re.sub(r'"(?:\\.|[^"\\\n])*"', '""', text)
    return re.sub(r"^#(?:.*\\\n)*.*$", "", text, flags=re.M)


def _functions(file: str, text: str) -> Iterator[Function]:
    for match in _FUNCTION.finditer(text):
        own = "static" in match[0][: match.start(1) - match.start()]
        yield Function(file, match[1], match[2], own)


def _outside(text: str) -> str:
    """Tables that name functions, which are called through them."""
    rest = _FUNCTION.sub("", text)
    return "\n".join(re.findall(r"=\s*\{.*?\};", rest, flags=re.S))


def _named(file: str, text: str, functions: Mapping[str, Function]) -> set[str]:
    """The functions that a text of a file names: calls, and those that it hands on."""
    words = {*_WORD.findall(text)}
    return {key for word in words for key in (word, f"{file}: {word}") if key in functions}


def _reached(roots: Iterable[str], calls: Mapping[str, set[str]]) -> set[str]:
    waiting, found = [*roots], set[str]()
    while waiting:
        name = waiting.pop()
        if name not in found:
            found.add(name)
            waiting += calls[name]
    return found


def _recursion(reached: set[str], calls: Mapping[str, set[str]]) -> list[str]:
    """Functions that come round to themselves."""
    return [
        f"{name} calls itself, by way of others or at once"
        for name in sorted(reached)
        if name in _reached(calls[name], calls)
    ]


def _in_function(one: Function) -> list[str]:
    """What is not fit in one function."""
    where = f"{one.file}: {one.name}"
    found = [
        f"{where}: an array of {size.strip()} elements, which is not known when it is compiled"
        for size in _ARRAY.findall(one.body)
        if not _is_fixed(size)
    ]
    for match in _LOOP.finditer(one.body):
        if match[1] != "for":
            found.append(f"{where}: {match[1]}, which has no counter")
        elif why := _unbounded(one.body, match.end()):
            found.append(f"{where}: a for loop {why}")
    return found


def _is_fixed(size: str) -> bool:
    """Whether the length of an array is made of numbers and of constants, which are in capitals."""
    words = _WORD.findall(re.sub(r"\bsizeof\b.*", "", size))
    return all(word.isupper() or word.startswith("BG_") for word in words)


def _unbounded(body: str, begin: int) -> str:
    """Why a for loop whose parenthesis opens before ``begin`` is not bounded; nothing if it is."""
    head, end = _to_closing(body, begin, "(", ")")
    parts = head.split(";")
    if len(parts) != 3:
        return "without its three parts"
    inside = _statement(body, end)
    for condition in parts[1].split("&&"):
        match = re.fullmatch(
            r"\s*(?:\+\+|--)?(\w+)(?:\s*[-+]\s*\d+)?\s*(<=?|>=?)\s*(.+?)\s*", condition, re.S
        )
        if match and "||" not in parts[1] and _runs_to(match, parts[2], inside):
            return ""
    return f"whose counter runs to no fixed bound: ({' '.join(head.split())})"


def _runs_to(condition: "re.Match[str]", change: str, inside: str) -> bool:
    """Whether a counter goes on by every turn to a bound that the loop does not move."""
    counter, sign, bound = condition.groups()
    up = re.search(rf"\b{counter}\s*\+\+|\+\+\s*{counter}\b|\b{counter}\s*\+=", change)
    down = re.search(rf"\b{counter}\s*--|--\s*{counter}\b|\b{counter}\s*-=", change)
    goes = up if sign in ("<", "<=") else down if sign in (">", ">=") else None
    if goes is None or _changes(inside, counter):
        return False
    return not any(_changes(inside, word) for word in _WORD.findall(bound) if not word.isupper())


def _changes(text: str, name: str) -> bool:
    return re.search(_CHANGED.format(name=re.escape(name)), text) is not None


def _to_closing(text: str, begin: int, opens: str, closes: str) -> tuple[str, int]:
    """The text up to where what opened before it closes, and the place after that."""
    depth, at = 1, begin
    while depth and at < len(text):
        depth += (text[at] == opens) - (text[at] == closes)
        at += 1
    return text[begin : at - 1], at


def _statement(text: str, begin: int) -> str:
    """The statement that begins there: a block, or up to its semicolon with loops before it."""
    rest = text[begin:]
    skipped = len(rest) - len(rest.lstrip())
    if rest[skipped : skipped + 1] == "{":
        return _to_closing(rest, skipped + 1, "{", "}")[0]
    match = re.match(r"\s*(?:for|if|while)\s*\(", rest)
    if match:
        head, end = _to_closing(rest, match.end(), "(", ")")
        return head + _statement(rest, end)
    return rest[: rest.find(";") + 1]


def main(words: list[str]) -> int:
    """Tell what is found in a folder; 1 if anything is, 2 if there is none."""
    if len(words) != 1 or not Path(words[0]).is_dir():
        sys.stderr.write("usage: python -m codegen.c.bounded FOLDER\n")
        return 2
    files = {
        path.name: path.read_text(encoding="utf-8")
        for path in sorted(Path(words[0]).iterdir())
        if path.suffix in (".c", ".h")
    }
    found = findings(files)
    good = f"{len(files)} files: nothing allocates, all loops are bounded"
    sys.stdout.write("\n".join(found or [good]) + "\n")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
