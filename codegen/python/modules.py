"""Real modules as one text: each written out whole, after those that it imports, less its imports."""

import ast
from collections.abc import Iterable, Iterator
from dataclasses import fields
from functools import lru_cache
from importlib.resources import files

from codegen.python.text import RULE
from codegen.tuning import TUNING

PROJECT = ("codegen.", "bondgraph.searching", "bondgraph.tables.")
"""Modules of these packages are written out; all others are imported."""

TOLERANCES = "codegen.tuning"
"""Of this one only the numbers that the others read are written out."""


def written_out(names: Iterable[str]) -> tuple[list[str], str]:
    """The modules of these names and all of the project that they import, each once and in order.

    First the lines that import what is not the project's.
    """
    lines, text = _written_out(tuple(names))
    return [*lines], text


LONGEST_LINE = 100


@lru_cache(maxsize=64)
def _written_out(names: tuple[str, ...]) -> tuple[tuple[str, ...], str]:
    """Models differ in few of them; the project's files do not change while it runs."""
    found: dict[str, ast.Module] = {}
    for name in names:
        _gather(name, found)
    imports: dict[str, set[str]] = {}
    for tree in found.values():
        for module, used in _imported(tree):
            if not module.startswith(PROJECT):
                imports.setdefault(module, set()).update(used)
    told = _numbers(found.values())
    text = "\n\n\n".join([*told, *(_body(name, tree) for name, tree in found.items())])
    lines = [
        _importing(one, sorted(used))
        for one, used in sorted(imports.items(), key=lambda each: (bool(each[1]), each[0]))
    ]
    ours = [line for line in lines if "numpy" in line]
    return (*(line for line in lines if line not in ours), "", *ours), text


def _importing(module: str, names: list[str]) -> str:
    """An import, one name a line where it would be too long."""
    line = f"from {module} import {', '.join(names)}" if names else f"import {module}"
    if len(line) <= LONGEST_LINE:
        return line
    return "\n".join([f"from {module} import (", *(f"    {name}," for name in names), ")"])


def _gather(name: str, found: dict[str, ast.Module]) -> None:
    if name in found or name == TOLERANCES:
        return
    tree = ast.parse(_source(name))
    for module, _ in _imported(tree):
        if module.startswith(PROJECT):
            _gather(module, found)
    found[name] = tree


def _numbers(trees: Iterable[ast.Module]) -> list[str]:
    """The tolerances that modules read, as one class; nothing where they read none."""
    nodes = [node for tree in trees for node in ast.walk(tree) if isinstance(node, ast.Attribute)]
    read = {node.attr for node in nodes if ast.unparse(node.value) == "TUNING"}
    rows = [
        f"    {one.name} = {_number(getattr(TUNING, one.name))}  # {one.metadata['what']}"
        for one in fields(TUNING)
        if one.name in read
    ]
    head = [RULE, "# Tolerances and choices of size.", "", "", "class TUNING:"]
    return (
        ["\n".join([*head, '    """The numbers that runs rest on."""', "", *rows])] if rows else []
    )


def _number(value: float) -> str:
    """A number as formatters write it."""
    return repr(value).replace("e+", "e")


def _source(name: str) -> str:
    package, _, file = name.rpartition(".")
    return files(package).joinpath(f"{file}.py").read_text(encoding="utf-8")


def _imported(tree: ast.Module) -> Iterator[tuple[str, list[str]]]:
    """The modules that a module imports, with the names taken from them; none for a whole module."""
    for node in tree.body:
        if isinstance(node, ast.ImportFrom):
            yield str(node.module), [ast.unparse(one) for one in node.names]
        elif isinstance(node, ast.Import):
            yield from ((ast.unparse(one), []) for one in node.names)


def _body(name: str, tree: ast.Module) -> str:
    """A module's text below its imports, under its docstring as a comment."""
    kept = [node for node in tree.body[1:] if not isinstance(node, ast.Import | ast.ImportFrom)]
    lines = _source(name).splitlines()
    start = min([kept[0].lineno, *(one.lineno for one in getattr(kept[0], "decorator_list", ()))])
    told = [f"# {line}".rstrip() for line in str(ast.get_docstring(tree)).splitlines()]
    gap = 2 if isinstance(kept[0], ast.ClassDef | ast.FunctionDef) else 1
    return "\n".join([RULE, *told, *[""] * gap, *lines[start - 1 :]])
