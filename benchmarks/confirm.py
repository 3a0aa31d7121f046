"""Tools of others beside the engine, each where it is installed.

``python benchmarks/confirm.py [ngspice] [siconos] [fmilibrary]`` prints a table for each, or that it is not
there.
"""

import sys
import tempfile
import warnings
from collections.abc import Mapping
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "tests"), str(ROOT / "tests" / "codegen")]

import numpy as np  # noqa: E402
from oracles.drawings import Drawing  # noqa: E402
from oracles.switched_units import SWITCHED  # noqa: E402
from others import importers, siconos_systems, spice  # noqa: E402
from references.switched.network import Network  # noqa: E402

import bondgraph as bg  # noqa: E402
from codegen import Result, simulator  # noqa: E402

Columns = Mapping[str, np.ndarray]


def main() -> None:
    """Run what is asked for, or all."""
    every = {"ngspice": show_spice, "siconos": show_siconos, "fmilibrary": show_importers}
    for name in sys.argv[1:] or every:
        every[name]()


def engine(network: Network, times: np.ndarray) -> Result:
    """A run of a network by the engine."""
    drawing = Drawing(network)
    equations = bg.derive(drawing.graph())
    try:
        ready = simulator(equations, {}, backend="c")
    except bg.StructureError:
        # More ports than C takes.
        ready = simulator(equations, {})
    start = {name: value for name, value in drawing.initial().items() if name in ready.states}
    return ready.run(times, start, drawing.inputs(), initially_on=drawing.initially_on())


def show_spice() -> None:
    """For voltages and for currents: differences, what ngspice's diodes are expected to leave of them."""
    if why := spice.missing():
        print(why)
        return
    print(
        "ngspice: differences of capacitors' voltages and coils' currents, of the largest of each;"
    )
    print("beside them what its diodes leave, by a run with twice their drop; and their N\n")
    heads = ("events", "voltages", "(diodes)", "currents", "(diodes)", "N")
    print(f"{'':<38}" + "".join(f"{head:>10}" for head in heads))
    for name, (network, end) in spice.CIRCUITS.items():
        times = np.linspace(0.0, end, spice.SAMPLES)
        ours = engine(network, times)
        try:
            emission, one, two = spice.both(network, end, times)
        except RuntimeError as error:
            print(f"{name:<38}{error}")
            continue
        cells = [
            len(ours.events),
            *_apart(ours, one, two, "u"),
            *_apart(ours, one, two, "i"),
            emission,
        ]
        print(f"{name:<38}" + "".join(f"{cell:>10}" for cell in cells), flush=True)


def _apart(ours: Columns, one: Columns, two: Columns, kind: str) -> tuple[str, str]:
    names = [name for name in one if name[0] == kind]
    if not names:
        return "-", "-"
    size = max(np.abs(ours[name]).max() for name in names)
    found = (max(np.abs(a[name] - one[name]).max() for name in names) / size for a in (ours, two))
    differs, diodes = found
    return f"{differs:.1e}", f"{diodes:.1e}"


def show_siconos() -> None:
    """Differences of states at a step and half of it, and of these two from each other."""
    print()
    if why := siconos_systems.missing():
        print(why)
        return
    print(
        "Siconos: differences of states, of the largest of each, at a step and at half of it; of its own"
    )
    print("two; and of the limit of both for short steps\n")
    heads = ("events", "step", "half", "own", "limit")
    print(f"{'':<38}" + "".join(f"{head:>10}" for head in heads))
    for name, make in siconos_systems.SYSTEMS.items():
        system = make()
        found, events = siconos_systems.ours(system)
        one, half = (siconos_systems.theirs(system, parts) for parts in (1, 2))
        size = np.abs(found).max(axis=0)
        pairs = ((one, found), (half, found), (one, half), (2 * half - one, found))
        cells = [f"{(np.abs(a - b) / size).max():.1e}" for a, b in pairs]
        print(f"{name:<38}{events:>10}" + "".join(f"{cell:>10}" for cell in cells), flush=True)


def show_importers() -> None:
    """Differences of states between two importers, and of the second from the engine's run."""
    print()
    if why := importers.missing():
        print(why)
        return
    rows = []
    for name, make in SWITCHED.items():
        case = make()
        states = [str(one) for one in case.equations.states]
        with tempfile.TemporaryDirectory() as folder:
            path = case.written(Path(folder) / f"{name}.fmu", "2.0")
            library, other = (
                by(path, case, states) for by in (importers.by_library, importers.by_fmpy)
            )
        with warnings.catch_warnings():
            # One is completed at its start, which is told.
            warnings.simplefilter("ignore", bg.ModelWarning)
            run = case.run(importers.STEPS + 1)
        right = np.column_stack([run[state][1:] for state in states])
        size = np.abs(right).max(axis=0)
        rows.append(
            (name, *(f"{(np.abs(library - one) / size).max():.1e}" for one in (other, right)))
        )
    # After what the library itself logs.
    print(
        "FMI Library: differences of states, of the largest of each, from FMPy and from the engine\n"
    )
    print(f"{'':<38}{'FMPy':>10}{'engine':>10}")
    for name, *cells in rows:
        print(f"{name:<38}" + "".join(f"{cell:>10}" for cell in cells))


if __name__ == "__main__":
    main()
