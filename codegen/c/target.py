"""C as a target: a folder of C99 whose parameters and main program are the run's."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from bondgraph.writing import write_all
from codegen.c.export import to_c
from codegen.targets import Export


@dataclass(frozen=True)
class C:
    """A folder called like the model."""

    name: str = "c"
    following: str = "cc -std=c99 -O2 {folder}/*.c -lm -o run_{name}"
    compiled: bool = False

    def write(
        self, export: Export, folder: Path, platforms: str | Iterable[str] | None = None
    ) -> list[Path]:
        """See `Target`."""
        files = to_c(
            export.equations, export.parameters, export.laws, name=export.name, main=True,
            initial=export.initial, inputs=export.inputs, initially_on=export.initially_on,
            integrator=export.integrator,
        )  # fmt: skip
        texts = {folder / export.name / file: text for file, text in files.items()}
        write_all(texts)
        return [*texts]
