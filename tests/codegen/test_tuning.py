"""Tolerances and choices of size have one home, and C has the same numbers."""

import ast
import re
from dataclasses import FrozenInstanceError, fields
from pathlib import Path

import pytest

import codegen
from codegen.c.runtime import FOLDERS, runtime_file, runtime_names
from codegen.tuning import TUNING, tuning_text

FILES = ("main.c", *(name for folder in FOLDERS for name in runtime_names(folder)))

TABLES = {"located_explicit_table.h", "batch_gauss.h", "lanes_functions.h"}
"""Coefficients of methods and of functions."""

NUMBER = re.compile(r"(?<![\w.%])(?:\d+\.\d*(?:[eE][-+]?\d+)?|\d+[eE][-+]?\d+)")


def test_c_has_the_same_numbers() -> None:
    found = dict(re.findall(r"^#define BG_(\w+) (\S+) /\*", tuning_text(), re.MULTILINE))
    assert {name.lower(): float(text) for name, text in found.items()} == vars(TUNING)


def test_c_has_no_small_number_of_its_own() -> None:
    for name in set(FILES) - TABLES:
        text = re.sub(r"/\*.*?\*/|\"[^\"\n]*\"", "", runtime_file(name), flags=re.DOTALL)
        own = [number for number in NUMBER.findall(text) if 0 < float(number) < 1e-2]
        assert own == [], name


def test_python_has_no_small_number_of_its_own() -> None:
    """But pictures, whose sizes are on paper."""
    top = Path(codegen.__path__[0])
    for path in top.rglob("*.py"):
        if path.name == "tuning.py" or path.relative_to(top).parts[0] in ("pictures", "plots"):
            continue
        nodes = list(ast.walk(ast.parse(path.read_text("utf-8"))))
        constants = [node.value for node in nodes if isinstance(node, ast.Constant)]
        own = [value for value in constants if isinstance(value, float) and 0 < value < 1e-2]
        own += [ast.unparse(node) for node in nodes if _is_small_power(node)]
        assert own == [], path


def _is_small_power(node: ast.AST) -> bool:
    """Such as ``2.0**-40``."""
    raised = isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow)
    return raised and isinstance(node.left, ast.Constant) and isinstance(node.right, ast.UnaryOp)


def test_every_number_is_used_and_told() -> None:
    c = "".join(map(runtime_file, FILES))
    python = "".join(path.read_text("utf-8") for path in Path(codegen.__path__[0]).rglob("*.py"))
    for one in fields(TUNING):
        assert one.metadata["what"]
        used = re.search(rf"\bBG_{one.name.upper()}\b", c), f"TUNING.{one.name}" in python
        assert any(used), one.name


def test_numbers_stay_as_they_are() -> None:
    with pytest.raises(FrozenInstanceError, match="cannot assign to field 'rounding'"):
        TUNING.rounding = 1.0  # type: ignore[misc]
