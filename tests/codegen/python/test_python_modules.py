"""The modules that exported Python consists of: they fit into one file, and need numpy only."""

import ast
import sys
from collections import Counter
from pathlib import Path

import pytest

import codegen
from bondgraph import searching
from bondgraph.tables import looking
from codegen.python.modules import written_out

FOLDER = Path(codegen.__file__).parent / "standalone"
NAMES = sorted(path.stem for path in FOLDER.glob("*.py") if path.stem != "__init__")


def _trees() -> dict[str, ast.Module]:
    return {name: ast.parse((FOLDER / f"{name}.py").read_text(encoding="utf-8")) for name in NAMES}


def _defined(tree: ast.Module) -> list[str]:
    """The names that a module gives at its top."""
    found = []
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            found.append(node.name)
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            found += [
                name.id for one in targets for name in ast.walk(one) if isinstance(name, ast.Name)
            ]
    return found


def test_no_name_is_given_by_two_modules() -> None:
    """Of all that may stand in one file: the second would be the first's, too."""
    root = FOLDER.parent
    more = [*(root / "fixed").glob("*.py"), *(root / "stops").glob("*.py"), Path(looking.__file__),
            Path(searching.__file__)]  # fmt: skip
    trees = [*_trees().values(), *(ast.parse(path.read_text(encoding="utf-8")) for path in more)]
    counts = Counter(name for tree in trees for name in _defined(tree))
    assert [name for name, count in counts.items() if count > 1] == []


@pytest.mark.parametrize("name", NAMES)
def test_they_import_python_numpy_and_one_another(name: str) -> None:
    nodes = [
        node for node in ast.walk(_trees()[name]) if isinstance(node, ast.Import | ast.ImportFrom)
    ]
    for node in nodes:
        assert node.col_offset == 0
        modules = (
            [node.module] if isinstance(node, ast.ImportFrom) else [a.name for a in node.names]
        )
        for module in map(str, modules):
            top = module.partition(".")[0]
            assert top in {*sys.stdlib_module_names, "numpy"} or module.startswith(
                ("codegen.standalone.", "codegen.tuning")
            )


def test_each_is_written_once_and_after_what_it_imports() -> None:
    imports, text = written_out([f"codegen.standalone.{name}" for name in reversed(NAMES)])
    scope: dict[str, object] = {"__name__": "written"}
    exec(compile("\n".join(imports) + "\n" + text, "written", "exec"), scope)
    for tree in _trees().values():
        assert set(_defined(tree)) <= set(scope)
    assert "codegen" not in "\n".join(imports)
    for name in NAMES:
        body = (FOLDER / f"{name}.py").read_text(encoding="utf-8").split("\n\n\n")[-1].strip()
        assert text.count(body) == 1
