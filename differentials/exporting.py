"""Differentials in their scenarios as Python, C and functional mock-up units."""

from collections.abc import Iterable, Mapping
from pathlib import Path

import bondgraph as bg
import codegen
from bondgraph.writing import made_folder, write_all
from codegen.program.identifiers import module_name
from differentials.scenarios import Prepared, Scenario, prepared
from differentials.scripts import script

TARGETS = ("python", "c", "fmu2", "fmu3")


def export(
    name: str,
    target: str,
    scenario: str | Scenario,
    parameters: Mapping[str, float] | None,
    out: Path,
) -> list[Path]:
    """Write a differential's full model, as it is in a scenario, into a folder; the files written.

    ``target``: see `write`. Raises `BondGraphError` for names and numbers that don't fit, and for what the
    target needs.
    """
    _check(target)
    return write(name, target, prepared(name, scenario, parameters), out)


def write(
    name: str,
    target: str,
    ready: Prepared,
    out: Path,
    platforms: str | Iterable[str] | None = None,
) -> list[Path]:
    """Write what a run needs into a folder; the files written.

    ``target``: "python", a module and a script that runs it, called like the model unless Python knows
    something else by that name; "c", a folder of C99 whose parameters and main
    program are the run's; "fmu2" or "fmu3", a unit with its inputs inside, for ``platforms`` as of
    `codegen.write_fmu`.

    Raises `BondGraphError` for names and numbers that don't fit, and for what the target needs.
    """
    _check(target)
    arguments = (ready.equations, ready.parameters, ready.laws)
    if target.startswith("fmu"):
        made_folder(out)
        path = out / f"{name}.fmu"
        codegen.write_fmu(
            path, *arguments, version=f"{target[-1]}.0", initial=ready.initial, inputs=ready.inputs,
            name=name, platforms=platforms,
        )  # fmt: skip
        return [path]
    if target == "c":
        texts = codegen.to_c(
            *arguments, name=name, main=True, initial=ready.initial, inputs=ready.inputs
        )
        return _written({out / name / file: text for file, text in texts.items()})
    module = codegen.to_python(*arguments, name, initial=ready.initial, inputs=ready.inputs)
    own = module_name(name)
    run = script(own, ready, codegen.Family(*arguments).inputs)
    return _written({out / f"{own}.py": module, out / f"run_{own}.py": run})


def _check(target: str) -> None:
    if target not in TARGETS:
        raise bg.SignalError(f"unknown target {target!r}; there are {', '.join(TARGETS)}")


def _written(texts: Mapping[Path, str]) -> list[Path]:
    write_all(texts)
    return [*texts]
