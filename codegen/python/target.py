"""Python as a target: a module, and a script that runs it."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from bondgraph.writing import write_all
from codegen.model.resting import warn_of_rests
from codegen.program.identifiers import module_name
from codegen.program.lower import lower
from codegen.python.export import to_python
from codegen.python.script import script
from codegen.supplied import supplied
from codegen.targets import Export


@dataclass(frozen=True)
class Python:
    """One module, called like the model unless Python knows something else by that name."""

    name: str = "python"
    following: str = "cd {folder} && python {file}"
    compiled: bool = False

    def write(
        self, export: Export, folder: Path, platforms: str | Iterable[str] | None = None
    ) -> list[Path]:
        """See `Target`."""
        equations = supplied(export.equations, export.laws, export.parameters)
        model = (equations, export.parameters, export.laws)
        module = to_python(
            *model, export.name, initial=export.initial, inputs=export.inputs,
            integrator=export.integrator,
        )  # fmt: skip
        program = lower(equations, export.laws, export.parameters, timed=True)
        own = module_name(export.name)
        run = script(own, export, [symbol.name for symbol in program.asked])
        warn_of_rests(
            equations, export.parameters, export.inputs, export.initially_on, export.times
        )
        texts = {folder / f"{own}.py": module, folder / f"run_{own}.py": run}
        write_all(texts)
        return [*texts]
