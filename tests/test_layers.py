"""Imports go one way: between the packages, and inside each down a list of its files."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
DISPLAY = re.compile(r"_repr_[a-z]+_")


def _room(folder: str, files: str) -> list[str]:
    return [f"{folder}.{file}" for file in files.split()]


#: Each package may import the ones before it; each file of a package the files before it.
ORDER = {
    "bondgraph": [
        "errors", "writing", "residues", "expressions", "laws", "elements", "elimination", "fields",
        "attributes", "declared", "names", "graph", "switching", "strokes", "causal_order",
        "regularity", "stories", "exact", "vanishing", "causality", "lines", "assignments", "tidy",
        "junction", "modulation", "sorting", "resistances", "stored", "reduction", "rates",
        "inertia", "loop_gains", "outputs", "readings", "sums", "blocks", "display", "latex",
        "equations", "closures", "slopes", "constrained", "holding", "closed_rows", "response",
        "linear", "explicit",
        *_room("explaining", "records momenta strokes_told primitives elimination dependence inertias "
               "layout text typesetting explanation"),
        *_room("drawing", "rich metrics subject shapes tight layers order columns marks places ends bonds "
               "powers compose svg plot listing picture"),
        "renaming", "composition", "declarations", "restored", "nodelink", "safexml", "graphml", "files",
    ],
    "codegen": [
        "arrays", "pairs", "roots", *_room("inputs", "pieces generators polynomials signal signals sampled "
                                            "tables discs segments branches harmonics known"),
        "model.affine", "closing", "timed", "records", "gains", "sections", "program", "identifiers",
        "printing", "units",
        *_room("model", "numpy_backend numbers energies sharp sources pace snapshot sharing slips "
               "friction instant loops real_roots solutions doubts terms rubbing closed stability sizes "
               "trials rounding verdicts modes guards places"),
        *_room("energy", "stored quadrature accounts tally"),
        *_room("runs", "events sundials progress legs watched exact ladder free hybrid arguments steps "
               "impulses observer tables summary"),
        *_room("energy", "audit ledger"), *_room("pictures", "style canvas labels flags marks stacked"),
        *_room("runs", "result snapshots columns"), "energy.replay",
        *_room("pictures", "panels poles bode shapes"), *_room("analysis", "spectrum comparison"),
        *_room("c", "text structure constants rhs blocks rates tables prefix scenario export"),
        *_room("engine", "compiler cache build sizes modes inputs fallback runs located"),
        "simulate", "trim",
        *_room("sweeps", "packing family measures design columns swept batch_inputs batch_engine batch_model "
               "batch_plan batch_energy batch_call batch_exact batch_located batch job crews cluster drive "
               "result store sweep"),
        *_room("python", "sticking text blocks tables export"),
        *_room("switched", "handover phases spliced simulator"),
        *_room("sparse", "valued signal_rows model steps run"),
        *_room("fmu", "variables switches resolution model dependencies xml binaries export"),
    ],
    "differentials": [
        "laws", "parts", "pieces", "passive", "active", "topologies", "parameters", "model",
        "identification", "speeds", "scenarios", "scripts", "exporting", "figures", "report",
        *_room("cli", "printing names signals subject options preparing pictures reading graphs "
               "linearising running grids sweeping exporting tours app"),
    ],
}  # fmt: skip


def _nodes(tree: ast.AST) -> Iterator[ast.AST]:
    """What a file consists of, without the bodies of display methods.

    A notebook calls ``_repr_svg_`` and its like; they may ask a later file for the picture of their record.
    """
    for node in ast.iter_child_nodes(tree):
        if not (isinstance(node, ast.FunctionDef) and DISPLAY.fullmatch(node.name)):
            yield node
            yield from _nodes(node)


def _imports(path: Path) -> Iterator[str]:
    """The full name of every module that a file imports, anywhere in it but in display methods."""
    for node in _nodes(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}:{node.lineno} imports relatively"
            module = str(node.module)
            yield from (
                (f"{module}.{alias.name}" for alias in node.names) if module in ORDER else [module]
            )


def _files(package: str) -> dict[str, Path]:
    folder = ROOT / package
    files = {path.relative_to(folder): path for path in folder.rglob("*.py")}
    return {".".join(name.with_suffix("").parts): path for name, path in files.items()}


CASES = [(package, module) for package, modules in ORDER.items() for module in modules]


@pytest.mark.parametrize(("package", "module"), CASES)
def test_file_imports_only_what_is_above_it(package: str, module: str) -> None:
    packages = list(ORDER)
    below = {*packages[packages.index(package) + 1 :]}
    above = ORDER[package][: ORDER[package].index(module)]
    for name in _imports(_files(package)[module]):
        top, _, rest = name.partition(".")
        assert top not in below, f"{package}.{module} imports {name}"
        if top == package:
            assert rest in above, f"{package}.{module} imports {name}"


@pytest.mark.parametrize("package", [package for package, modules in ORDER.items() if modules])
def test_every_file_has_its_place(package: str) -> None:
    files = {
        name for name in _files(package) if name.split(".")[-1] not in ("__init__", "__main__")
    }
    assert sorted(files) == sorted(ORDER[package])
