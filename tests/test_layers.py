"""Folders are the stages: imports go one way down this list, and nothing goes round in a circle.

Every import counts, inside functions and for types alone, too; faces (`__init__`) and `__main__` do not, as
they are for users. A file at the top of a package is a folder of its own.
"""

import ast
import re
from collections import Counter
from pathlib import Path

import networkx as nx
import pytest

ROOT = Path(__file__).parents[1]

ORDER = {
    "bondgraph": "offering errors named writing searching tables algebra solving inverses nodes declare "
    "blocks causality reduce equations derive sampling analyse show rates explaining checking layout drawing "
    "files",
    "codegen": "tuning standalone fixed stops numbers data inputs called targets supplied program model "
    "ports straight modes corners instants energy runs pictures record plots analysis c engine taking "
    "streaming stepping delays simulator simulate trim packing family batch abreast sweeps python switched "
    "sparse fmu cosimulation exports",
    "differentials": "aligned laws parts pieces passive active topologies parameters model identification "
    "speeds prepared control scenarios exporting figures loop_figures report commands",
}
"""Each imports only earlier ones."""

FOLDERS = [f"{package}.{name}" for package, names in ORDER.items() for name in names.split()]

DISPLAY = re.compile(r"_repr_[a-z]+_|__str__")
"""What `print` and a notebook call: these methods of a record may import the showing of it."""

MOST_FILES = 20
"""In one folder."""

LONGEST = 32
"""Files, each importing the next, over `bondgraph` and `codegen`."""


def _modules() -> dict[str, Path]:
    found = {}
    for package in ("bondgraph", "codegen", "differentials"):
        for path in (ROOT / package).rglob("*.py"):
            if path.stem not in ("__init__", "__main__"):
                found[".".join(path.relative_to(ROOT).with_suffix("").parts)] = path
    return found


def _imported(path: Path, modules: dict[str, Path]) -> set[str]:
    waiting, found = [ast.parse(path.read_text(encoding="utf-8"))], set()
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.FunctionDef) and DISPLAY.fullmatch(node.name):
            continue
        waiting += ast.iter_child_nodes(node)
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}:{node.lineno} imports relatively"
            parts = {f"{node.module}.{alias.name}" for alias in node.names}
            found |= parts & set(modules) or {str(node.module)}
    return found


def _folder(module: str) -> str:
    parts = module.split(".")
    return module if len(parts) == 2 else ".".join(parts[:2])


@pytest.fixture(scope="module")
def imports() -> "nx.DiGraph[str]":
    """An edge from each file to each that it imports; to a face where it takes that."""
    modules = _modules()
    found: nx.DiGraph[str] = nx.DiGraph()
    found.add_nodes_from(modules)
    for module, path in modules.items():
        found.add_edges_from((module, name) for name in _imported(path, modules))
    return found


def test_files_import_files_and_no_faces(imports: "nx.DiGraph[str]") -> None:
    """Inside the two packages that others build on."""
    faces = {name for name in imports if name.split(".")[0] in ("bondgraph", "codegen")}
    faces -= set(_modules())
    taken = [(one, face) for one, face in imports.edges if face in faces]
    assert [edge for edge in taken if not edge[0].startswith("differentials.")] == []


def test_folders_import_only_earlier_ones(imports: "nx.DiGraph[str]") -> None:
    place = {folder: at for at, folder in enumerate(FOLDERS)}
    ours = imports.subgraph(_modules())
    assert sorted(set(map(_folder, ours)) ^ set(FOLDERS)) == []
    up = [(a, b) for a, b in ours.edges if place[_folder(a)] < place[_folder(b)]]
    assert up == []


def test_no_file_imports_itself_in_a_circle(imports: "nx.DiGraph[str]") -> None:
    ours = imports.subgraph(_modules())
    circles = [sorted(part) for part in nx.strongly_connected_components(ours) if len(part) > 1]
    assert circles == []


def test_no_chain_of_imports_is_long(imports: "nx.DiGraph[str]") -> None:
    core = [name for name in _modules() if not name.startswith("differentials")]
    chain = nx.dag_longest_path(imports.subgraph(core))
    assert len(chain) <= LONGEST, chain


def test_no_folder_has_many_files(imports: "nx.DiGraph[str]") -> None:
    counts = Counter(_folder(name) for name in _modules())
    assert {folder: count for folder, count in counts.items() if count > MOST_FILES} == {}
