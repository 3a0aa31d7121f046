"""`write_fmu`: a model as a functional mock-up unit, for model exchange and co-simulation."""

import hashlib
import io
import math
import os
import zipfile
from collections.abc import Hashable, Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from bondgraph.algebra.atoms import normal
from bondgraph.declare.switching import checked_modes
from bondgraph.equations import StateEquations
from bondgraph.errors import BondGraphError, SignalError
from bondgraph.writing import write_bytes
from codegen.c.export import exported
from codegen.c.runtime import runtime_file, runtime_names
from codegen.fmu.binaries import binaries, chosen_platforms, headers
from codegen.fmu.model import FmuModel, config_text, model_text
from codegen.fmu.switches import switching, told_by_time
from codegen.fmu.variables import Starts, variables
from codegen.fmu.xml import build_description, description
from codegen.inputs.signal import Signal
from codegen.inputs.signals import Constant, as_signal
from codegen.model.doubts import warn_of_doubts
from codegen.model.resting import warn_of_rests
from codegen.model.sources import with_first
from codegen.modes.pace import time_constant
from codegen.modes.steps import round_step, step_at_start
from codegen.program.identifiers import identifiers
from codegen.program.records import Program
from codegen.runs.arguments import initial_values, named_numbers
from codegen.runs.impulses import refuse_impulses
from codegen.runs.legs import Leg
from codegen.runs.start import check_exported
from codegen.runs.track import Settings
from codegen.simulate import bare_simulator
from codegen.simulator import Simulator
from codegen.supplied import supplied
from codegen.tuning import TUNING

OTHERS: Mapping[str, str] = {"2.0": "fmu3", "3.0": "fmu2"}
"""How sources that a unit has no use for begin, by its FMI version."""

_DATE = (1980, 1, 1, 0, 0, 0)


def write_fmu(
    path: str | os.PathLike[str],
    equations: StateEquations,
    parameters: Mapping[str, object],
    laws: Mapping[Any, object] | None = None,
    version: str = "2.0",
    initial: Mapping[str, float] | None = None,
    inputs: Mapping[str, object] | None = None,
    name: str | None = None,
    platforms: str | Iterable[str] | None = None,
    initially_on: Iterable[Hashable] = (),
    integrator: str = "rk4",
) -> Path:
    """The equations, closed by laws, as an FMU of FMI ``version`` "2.0" or "3.0"; its path.

    ``parameters``, ``laws``, ``initial``: as `simulator` and its ``run`` take them. ``inputs``: a signal is a
    source inside the unit, a number is where an input of the unit starts; all others start at 0.
    ``name``: of the model, the path's stem if none is given. ``platforms``: names such as
    "x86_64-windows", "all" for every one, this machine's if none is given; see `PLATFORMS`. ``initially_on``:
    the switches that are on before the start, as far as their conditions let them; states that neither
    ``initial`` names nor the importer sets then follow what these hold.

    Each switch is an integer variable, 1 on and 0 off, whose description tells when it turns, as does that of
    an input that it goes by. Of sources inside that rest at zero while such a switch is on a `ModelWarning`
    tells. Co-simulation locates events and keeps the importer's tolerance; with the parameter
    ``fixed_internal_step`` above zero [s] it takes fixed steps, by ``integrator``: "rk4", or "rosenbrock" for
    stiff laws, as `to_c` takes it.

    The same arguments and compilers give the same bytes. Raises what `to_c` raises, `SignalError` for
    unusable arguments, `MissingExtraError` without the extra ``export``, `WriteError` where the file cannot
    be written; what was there is kept.
    """
    if version not in OTHERS:
        raise SignalError(f"FMI version {version!r}: there is {', '.join(OTHERS)}")
    target = Path(path)
    chosen = chosen_platforms(platforms)
    official, equations = headers(version), supplied(equations, laws, parameters)
    model = _model(
        name or target.stem, equations, parameters, laws, initial or {}, inputs or {}, initially_on,
        version,
    )  # fmt: skip
    start, code = exported(equations, parameters, laws, name=model.name, integrator=integrator)
    warn_of_doubts(start.closed.program, equations, start.closed.parameters)
    own = [name for name in runtime_names("fmu") if not name.startswith(OTHERS[version])]
    sources = code | {name: runtime_file(name) for name in own}
    sources |= {"fmu_model.c": model_text(model), **official}
    units = sorted(file for file in sources if file.endswith(".c"))
    token = _token(sources, description(model, version, "", units), config_text(model, ""))
    sources["fmu_config.h"] = config_text(model, token)
    entries = {f"sources/{file}": text.encode() for file, text in sources.items()}
    entries["modelDescription.xml"] = description(model, version, token, units).encode()
    if version == "3.0":
        built = build_description(model.identifier, units)
        entries["sources/buildDescription.xml"] = built.encode()
    entries |= binaries(sources, model.identifier, chosen, version)
    write_bytes(target, _zipped(entries))
    return target


def _model(
    name: str,
    equations: StateEquations,
    parameters: Mapping[str, object],
    laws: Mapping[Any, object] | None,
    initial: Mapping[str, float],
    inputs: Mapping[str, object],
    initially_on: Iterable[Hashable],
    version: str,
) -> FmuModel:
    """Everything about the unit but its sources."""
    ready = bare_simulator(equations, parameters, laws, timed=False)
    check_exported(ready.closed.program)
    told = bare_simulator(equations, parameters, laws)
    program, exact = ready.closed.program, ready.closed.parameters
    wanted = dict(zip(ready.inputs, _signals(ready, inputs), strict=True))
    every = [Constant(one) if isinstance(one, float) else one for one in wanted.values()]
    every = with_first(program, every, exact)
    signals = [wanted.get(name.name, one) for name, one in zip(program.asked, every, strict=True)]
    inside = {at: one for at, one in enumerate(signals) if not isinstance(one, float)}
    refuse_impulses(ready.closed, every, np.array([0.0, math.inf]))
    initial = ready.starting(initial)
    start = initial_values(initial, ready.states)
    named = named_numbers(initial, ready.states)
    on = checked_modes(ready.switches, initially_on)
    own = {program.asked[at].name: one for at, one in inside.items()}
    warn_of_rests(equations, parameters, own, on)
    shortest = _shortest(told, start.tolist(), every)
    switches = switching(program)
    starts = Starts(
        tuple(float(exact[symbol.name]) for symbol in program.parameters),
        tuple(start.tolist()),
        tuple(name in named for name in ready.states),
        tuple(one if isinstance(one, float) else 0.0 for one in signals),
        frozenset(inside),
        _internal_step(shortest, step_at_start(ready.closed, start, every)),
    )
    return FmuModel(
        name,
        _identifier(name),
        program,
        equations,
        variables(program, equations, starts, _indicators(program) + len(switches), version),
        starts,
        tuple(sorted(inside.items())),
        program.before(on),
        switches,
        told_by_time(program),
        told.closed.program.sources,
        shortest,
    )


def _indicators(program: Program) -> int:
    return 2 * len(program.friction)


def _signals(ready: Simulator, inputs: Mapping[str, object]) -> list[Signal | float]:
    """For each input the source inside, or the number where it starts."""
    if not isinstance(inputs, Mapping):
        raise SignalError(f"inputs must map names to values, not be {inputs!r}")
    given = {str(normal(key)): value for key, value in inputs.items()}
    for key in given:
        if key not in ready.inputs:
            known = ", ".join(ready.inputs) or "none"
            raise SignalError(f"unknown input {key!r}; the model's inputs are {known}")
    found: list[Signal | float] = []
    for key in ready.inputs:
        signal = as_signal(given.get(key, 0.0), key)
        found.append(signal if isinstance(given.get(key), Signal) else signal(0.0))
    return found


def _shortest(ready: Simulator, start: list[float], signals: list[Signal]) -> float:
    """The shortest time constant [s] at the start, friction slipping."""
    signals = [*signals, *ready.sources(0.0, 0.0, found=True)]
    pieces = [signal.piece(0.0) for signal in signals]
    mode = tuple(1 for _ in ready.closed.program.friction)
    settings = Settings()
    try:
        with np.errstate(all="ignore"):
            given = np.array([signal(0.0) for signal in signals])
            vector = ready.vector(0.0, np.array(start), given)
            fastest = Leg(ready.closed, pieces, mode, settings, 0.0).fastest(0.0, vector)
    except BondGraphError:
        return TUNING.unit_step
    return time_constant(fastest, 0.0)


def _internal_step(shortest: float, longest: float) -> float:
    """A round length: a fifth of the shortest time constant or less, half the longest stable one at most."""
    return round_step(min(TUNING.unit_longest, shortest / 5, longest / 2))


def _identifier(name: str) -> str:
    return identifiers([name], "c")[name]


def _token(sources: Mapping[str, str], *more: str) -> str:
    """A hash of everything the unit is made of."""
    parts = [*more, *(f"{name}\0{sources[name]}" for name in sorted(sources))]
    text = hashlib.sha256("\0".join(parts).encode()).hexdigest()
    return f"{{{text[:8]}-{text[8:12]}-{text[12:16]}-{text[16:20]}-{text[20:32]}}}"


def _zipped(entries: Mapping[str, bytes]) -> bytes:
    """An archive in which nothing depends on when or where it is made."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in sorted(entries):
            about = zipfile.ZipInfo(name, _DATE)
            about.compress_type = zipfile.ZIP_DEFLATED
            about.create_system = 3
            about.external_attr = (0o755 if name.startswith("binaries/") else 0o644) << 16
            archive.writestr(about, entries[name])
    return buffer.getvalue()
