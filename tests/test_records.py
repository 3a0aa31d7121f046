"""Records are frozen in more than name: no field of one is declared as what can be changed."""

import ast
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]

CHANGEABLE = {"list", "dict", "set", "bytearray", "defaultdict", "deque", "Counter"}

EXCEPTED = {
    "bondgraph.files.declarations.Declaration": "data as JSON has it, lists and objects in one another",
}


def _annotated(record: ast.ClassDef) -> Iterator[tuple[str, ast.expr]]:
    for part in record.body:
        if isinstance(part, ast.AnnAssign) and isinstance(part.target, ast.Name):
            yield part.target.id, part.annotation


def _is_frozen(record: ast.ClassDef) -> bool:
    told = [ast.unparse(one) for one in record.decorator_list]
    named = any(isinstance(base, ast.Name) and base.id == "NamedTuple" for base in record.bases)
    return named or any(one.startswith("dataclass") and "frozen=True" in one for one in told)


def _changeable(source: str, module: str) -> list[str]:
    found: list[str] = []
    if "frozen=True" not in source and "NamedTuple" not in source:
        return found
    for record in ast.walk(ast.parse(source)):
        if not isinstance(record, ast.ClassDef) or not _is_frozen(record):
            continue
        where = f"{module}.{record.name}"
        for name, kind in _annotated(record) if where not in EXCEPTED else ():
            used = {part.id for part in ast.walk(kind) if isinstance(part, ast.Name)}
            # A function of a list is no list.
            if used & CHANGEABLE and not ast.unparse(kind).startswith("Callable"):
                found.append(f"{where}.{name}: {ast.unparse(kind)}")
    return found


def test_no_field_of_a_record_is_declared_as_what_can_be_changed() -> None:
    found: list[str] = []
    for package in ("bondgraph", "codegen", "differentials"):
        for path in sorted((ROOT / package).rglob("*.py")):
            module = ".".join(path.relative_to(ROOT).with_suffix("").parts)
            found += _changeable(path.read_text(encoding="utf-8"), module)
    assert found == []


def test_what_is_declared_so_is_found() -> None:
    """The look itself."""
    record = "@dataclass(frozen=True)\nclass R:\n    a: tuple[dict[int, str], ...]\n    b: int\n"
    named = "class N(NamedTuple):\n    c: list[int]\n"
    assert _changeable(record + named, "m") == [
        "m.R.a: tuple[dict[int, str], ...]",
        "m.N.c: list[int]",
    ]
    assert _changeable("@dataclass\nclass R:\n    a: list[int]\n", "m") == []
