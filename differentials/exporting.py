"""Differentials in their scenarios as Python, C and functional mock-up units."""

from collections.abc import Iterable, Mapping
from pathlib import Path

from codegen.exports import target as asked
from codegen.targets import Export
from differentials.control.manoeuvres import Manoeuvre
from differentials.prepared import Prepared
from differentials.scenarios import Scenario, prepared


def export(
    name: str,
    target: str,
    scenario: str | Scenario | Manoeuvre,
    parameters: Mapping[str, float] | None,
    out: Path,
) -> list[Path]:
    """Write a differential's full model, as it is in a scenario, into a folder; the files written.

    ``target``: see `write`. Raises `BondGraphError` for names and numbers that don't fit, and for what the
    target needs.
    """
    asked(target)
    return write(name, target, prepared(name, scenario, parameters), out)


def write(
    name: str,
    target: str,
    ready: Prepared,
    out: Path,
    platforms: str | Iterable[str] | None = None,
    integrator: str = "rk4",
) -> list[Path]:
    """Write what a run needs into a folder; the files written.

    ``target``: one of `codegen.exports.TARGETS`. "python", a module and a script that runs it, called like
    the model unless Python knows something else by that name; "c", a folder of C99 whose parameters and main
    program are the run's; "fmu2" or "fmu3", a unit with its inputs inside, for ``platforms`` as of
    `codegen.write_fmu`. ``integrator``: the method of fixed steps, "rk4" or "rosenbrock", as of
    `codegen.to_c`.

    Raises `BondGraphError` for names and numbers that don't fit, and for what the target needs.
    """
    run = Export(
        name,
        ready.equations,
        ready.parameters,
        ready.laws,
        ready.initial,
        ready.inputs,
        ready.times,
        ready.initially_on,
        integrator,
    )
    return asked(target).write(run, out, platforms)
