"""Pages of the API stand alone: every public name has an example, says what it refuses, and has a guide.

That each is on exactly one page `test_site.py` checks; that examples run, the collection of doctests.
"""

import ast
import builtins
import importlib
import inspect
import re
import textwrap
from pathlib import Path

import pytest

import bondgraph.errors
from docs.site_tools.used_in import public, used

ROOT = Path(__file__).parents[2]

NAMES = [(package, name) for package, names in public().items() for name in sorted(names)]

WITHOUT_EXAMPLE: set[str] = set()
WITHOUT_ERRORS: set[str] = set()
WITHOUT_GUIDE: set[str] = set()
"""What is still missing. These may only shrink."""


def _own_text(package: str, name: str) -> str:
    """The docstring of a function or a class; nothing for data."""
    thing = getattr(importlib.import_module(package), name)
    return inspect.getdoc(thing) or "" if callable(thing) else ""


def _on_page(package: str, name: str) -> str:
    """What the page of the API says below a name, up to the next."""
    text = (ROOT / "docs" / "api" / f"{package}.md").read_text("utf-8")
    parts = re.split(rf"^(?:::: ({package}\.\S+)|## .*)$", text, flags=re.MULTILINE)
    below = [
        part for shown, part in zip(parts[1::2], parts[2::2], strict=True)
        if shown and shown.rpartition(".")[2] == name
    ]  # fmt: skip
    assert len(below) == 1, f"{package}.{name} is on {len(below)} places of its page"
    return below[0]


def _can_raise(package: str, name: str) -> bool:
    """Every function; of classes those that look at what they are made of, or raise in a method."""
    thing = getattr(importlib.import_module(package), name)
    if not inspect.isclass(thing):
        return callable(thing)
    if issubclass(thing, BaseException):
        return False
    tree = ast.parse(textwrap.dedent(inspect.getsource(thing)))
    return any(
        isinstance(node, ast.Raise) or getattr(node, "name", "") in ("__post_init__", "__init__")
        for node in ast.walk(tree)
    )


def _told(package: str, name: str) -> bool:
    """Whether errors are told, in its docstring or those of its methods."""
    thing = getattr(importlib.import_module(package), name)
    methods = vars(thing).values() if inspect.isclass(thing) else ()
    texts = [_own_text(package, name), *(inspect.getdoc(one) or "" for one in methods)]
    return any(re.search(r"\bRaises\b", text) for text in texts)


def _raised(package: str, name: str) -> set[type[BaseException]]:
    """The classes of errors that its own lines raise, methods included, helpers not."""
    thing = getattr(importlib.import_module(package), name)
    if not callable(thing):
        return set()
    inside = (
        vars(builtins) | vars(bondgraph.errors) | vars(importlib.import_module(thing.__module__))
    )
    tree = ast.parse(textwrap.dedent(inspect.getsource(thing)))
    calls = [node.exc for node in ast.walk(tree) if isinstance(node, ast.Raise)]
    made = [call.func for call in calls if isinstance(call, ast.Call)]
    names = [getattr(one, "id", getattr(one, "attr", "")) for one in made]
    return {inside[name] for name in names}


def _unnamed(package: str, name: str) -> bool:
    """Whether an error that its own lines raise is told by no name, its own or a base's."""
    thing = getattr(importlib.import_module(package), name)
    methods = vars(thing).values() if inspect.isclass(thing) else ()
    told = " ".join([_own_text(package, name), *(inspect.getdoc(one) or "" for one in methods)])
    return any(
        not any(base.__name__ in told for base in error.__mro__ if base is not Exception)
        for error in _raised(package, name)
    )


def _missing(wanting: object) -> set[str]:
    return {f"{package}.{name}" for package, name in NAMES if wanting(package, name)}  # type: ignore[operator]


def test_every_public_name_has_an_example() -> None:
    found = _missing(lambda *at: ">>> " not in _own_text(*at) + _on_page(*at))
    assert found == WITHOUT_EXAMPLE


def test_whatever_can_raise_says_what_or_that_it_does_not() -> None:
    assert _missing(lambda *at: _can_raise(*at) and not _told(*at)) == WITHOUT_ERRORS


def test_errors_that_its_own_lines_raise_are_named() -> None:
    assert _missing(_unnamed) == set()


def test_every_public_name_is_used_in_a_guide() -> None:
    uses = used(ROOT / "docs")
    of_guides = {
        name for name, sections in uses.items()
        if any(section.page != "index.md" for section in sections)
    }  # fmt: skip
    assert _missing(lambda *at: at not in of_guides) == WITHOUT_GUIDE


@pytest.mark.parametrize(
    ("package", "name"), [("bondgraph", "Step"), ("codegen", "Step"), ("bondgraph", "derive")]
)
def test_uses_tell_packages_apart(package: str, name: str) -> None:
    pages = {section.page for section in used(ROOT / "docs").get((package, name), ())}
    assert ("tour.md" in pages) == ((package, name) != ("bondgraph", "Step"))
