"""Targets: those that there are, and one that is made here as the guide says."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from references.build import bond_graph

import bondgraph as bg
from bondgraph.writing import write_all
from codegen import lower
from codegen.exports import TARGETS, target
from codegen.program.records import Block
from codegen.targets import Export, Target


def _export() -> Export:
    nodes = [bg.Se("push", "P"), bg.One("mass"), bg.I("m", "m", flow="v"), bg.R("air", flow="w")]
    equations = bg.derive(bond_graph(nodes, "push>mass>m mass>air"))
    return Export(
        "car", equations, {"m": 2.0, "c": 0.5}, {"air": "c*w*abs(w)"}, {"v": 3.0}, {},
        np.linspace(0.0, 1.0, 11),
    )  # fmt: skip


@dataclass(frozen=True)
class PlainText:
    """A throw-away target: every assignment of a model as a line."""

    name: str = "text"
    following: str = "read {path}"
    compiled: bool = False

    def write(
        self, export: Export, folder: Path, platforms: str | Iterable[str] | None = None
    ) -> list[Path]:
        """See `Target`."""
        program = lower(export.equations, export.laws, export.parameters)
        lines = [f"{symbol} = {export.parameters[symbol.name]}" for symbol in program.parameters]
        entries = [
            f"{matrix}[{row}, {column}]"
            for matrix, pattern in program.layout.items()
            for row, column in zip(pattern.rows, pattern.columns, strict=True)
        ]
        lines += _lines(program.coefficients, entries)
        for group in program.groups:
            lines += _lines(group.values, [str(program.inputs[at]) for at in group.inputs])
        path = folder / f"{export.name}.txt"
        write_all({path: "\n".join(lines) + "\n"})
        return [path]


def _lines(block: Block, results: Sequence[str]) -> list[str]:
    told = [*block.assignments, *zip(results, block.results, strict=True)]
    return [f"{name} = {value}" for name, value in told]


def test_a_target_is_one_class(tmp_path: Path) -> None:
    made: Target = PlainText()
    (path,) = made.write(_export(), tmp_path)
    # m v' = P - e_air; both ports receive v.
    assert path.read_text("utf-8").splitlines() == [
        "c = 0.5", "m = 2.0", "A[0, 0] = m", "B[0, 0] = 1", "B[0, 1] = -1", "F[0, 0] = 1",
        "F[1, 0] = 1", "e_air = c*w*Abs(w)",
    ]  # fmt: skip


@pytest.mark.parametrize("name", TARGETS)
def test_every_target_writes_what_it_says(name: str, tmp_path: Path) -> None:
    paths = target(name).write(_export(), tmp_path)
    assert paths
    assert all(path.is_file() and path.is_relative_to(tmp_path) for path in paths)
    last = paths[-1]
    told = target(name).following.format(folder=last.parent, file=last.name, path=last, name="car")
    assert str(last) in told or str(last.parent) in told


def test_an_unknown_target_is_refused() -> None:
    with pytest.raises(bg.SignalError, match="'fortran'; there are python, c, fmu2, fmu3"):
        target("fortran")
