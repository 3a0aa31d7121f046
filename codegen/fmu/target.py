"""Functional mock-up units as targets, one for each version of FMI: a unit with its inputs inside."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from bondgraph.writing import made_folder
from codegen.fmu.export import write_fmu
from codegen.targets import Export


@dataclass(frozen=True)
class Fmu:
    """A unit of one version, such as "3.0"."""

    version: str
    compiled: bool = True

    @property
    def name(self) -> str:
        """Such as "fmu3"."""
        return f"fmu{self.version[0]}"

    @property
    def following(self) -> str:
        """See `Target`."""
        return f"load {{path}} into any tool that knows FMI {self.version}"

    def write(
        self, export: Export, folder: Path, platforms: str | Iterable[str] | None = None
    ) -> list[Path]:
        """See `Target`."""
        made_folder(folder)
        path = folder / f"{export.name}.fmu"
        write_fmu(
            path, export.equations, export.parameters, export.laws, version=self.version,
            name=export.name, platforms=platforms, initial=export.initial, inputs=export.inputs,
            initially_on=export.initially_on, integrator=export.integrator,
        )  # fmt: skip
        return [path]
