"""Where guides use a public name: a list below each name of the API, made anew from the guides' text."""

import importlib
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from markdown.extensions.toc import slugify, unique

PACKAGES = {"bg": "bondgraph", **{name: name for name in ("bondgraph", "codegen", "differentials")}}
"""What guides call the packages."""

_DOTTED = re.compile(rf"(?<![\w.])({'|'.join(PACKAGES)})((?:\.\w+)+)")
_IMPORT = re.compile(rf"from ({'|'.join(PACKAGES)}) import ([\w, ]+)")
_CODE = re.compile(r"`([A-Za-z]\w*)(?:\([^`]*\))?`")
_HEADING = re.compile(r"(#+) (.+)")
_SHOWN = re.compile(r"::: (\w+)\.(?:\w+\.)*(\w+)\n(?:    .*\n)*", re.MULTILINE)

Names = Mapping[str, frozenset[str]]
"""Public names by package."""


@dataclass(frozen=True)
class Section:
    """A stretch of a guide below one heading."""

    page: str
    guide: str
    title: str
    anchor: str
    text: str

    @property
    def link(self) -> str:
        """As Markdown, seen from the pages of the API."""
        title = self.guide if self.title == self.guide else f"{self.guide}: {self.title}"
        return f"[{title}](../{self.page}#{self.anchor})"


def public() -> Names:
    """What the packages' ``__all__`` say.

    >>> "derive" in public()["bondgraph"]
    True
    """
    return {
        name: frozenset(importlib.import_module(name).__all__)
        for name in dict.fromkeys(PACKAGES.values())
    }


def sections(page: str, text: str) -> Iterator[Section]:
    """The sections of a guide, each with the anchor that the site gives it.

    >>> [(s.title, s.anchor) for s in sections("a.md", "# A guide\\nText.\\n## One\\n## One\\n")]
    [('A guide', 'a-guide'), ('One', 'one'), ('One', 'one_1')]
    """
    found: list[tuple[str, list[str]]] = []
    fenced = False
    for line in text.splitlines():
        fenced ^= line.startswith("```")
        heading = None if fenced else _HEADING.fullmatch(line)
        if heading is not None:
            found.append((heading[2].replace("`", ""), []))
        elif found:
            found[-1][1].append(line)
    taken: set[str] = set()
    for title, lines in found:
        anchor = unique(slugify(title, "-"), taken)
        yield Section(page, found[0][0], title, anchor, "\n".join(lines))


def named(text: str, names: Names) -> set[tuple[str, str]]:
    """The public names that a text uses, each with its package.

    After a package's name, in an import, or alone between backticks, where one package alone has it.

    >>> sorted(named("`peak` of bg.derive(g).A", public()))
    [('bondgraph', 'derive'), ('codegen', 'peak')]
    """
    found = {
        (PACKAGES[package], name)
        for package, rest in _DOTTED.findall(text)
        for name in rest.split(".")[1:]
    }
    found |= {
        (PACKAGES[package], name)
        for package, rest in _IMPORT.findall(text)
        for name in re.findall(r"\w+", rest)
    }
    for name in _CODE.findall(text):
        owners = [package for package, known in names.items() if name in known]
        if len(owners) == 1:
            found.add((owners[0], name))
    return {(package, name) for package, name in found if name in names[package]}


def used(folder: Path) -> dict[tuple[str, str], list[Section]]:
    """For each public name the first section of every guide that uses it, guides by name."""
    names = public()
    found: dict[tuple[str, str], list[Section]] = {}
    for path in sorted(folder.glob("*.md")):
        seen: set[tuple[str, str]] = set()
        for section in sections(path.name, path.read_text("utf-8")):
            for name in named(section.text, names) - seen:
                found.setdefault(name, []).append(section)
                seen.add(name)
    return found


def with_uses(text: str, uses: Mapping[tuple[str, str], list[Section]]) -> str:
    """A page of the API with a line below each name that guides use.

    >>> guide = Section("a.md", "A guide", "Laws", "laws", "")
    >>> print(with_uses("::: codegen.trim.trim\\n", {("codegen", "trim"): [guide]}))
    ::: codegen.trim.trim
    <BLANKLINE>
    Used in [A guide: Laws](../a.md#laws).
    <BLANKLINE>
    """

    def line(shown: re.Match[str]) -> str:
        links = [section.link for section in uses.get((shown[1], shown[2]), ())]
        return shown[0] + (f"\nUsed in {', '.join(links)}.\n" if links else "")

    return _SHOWN.sub(line, text)


def on_page_markdown(markdown: str, *, page: Any, config: Any, **_: object) -> str:
    """Called by mkdocs for every page before it is turned."""
    if not page.file.src_uri.startswith("api/"):
        return markdown
    return with_uses(markdown, used(Path(config.docs_dir)))
