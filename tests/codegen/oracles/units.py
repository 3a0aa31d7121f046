"""Models to make units of, and units run by fmpy."""

import importlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from fmpy import simulate_fmu
from references.build import bond_graph

import bondgraph as bg
import codegen


@dataclass(frozen=True)
class Case:
    """A model and a run of it: what `simulator` and `write_fmu` take alike."""

    equations: bg.StateEquations
    parameters: Mapping[str, float]
    laws: Mapping | None
    initial: Mapping[str, float]
    inputs: Mapping[str, object]
    end: float

    def written(self, path: Path, version: str, **more) -> Path:
        """The unit; those of both versions share most objects where their names are the same."""
        given = {"initial": self.initial, "inputs": self.inputs} | more
        path.parent.mkdir(exist_ok=True)
        return codegen.write_fmu(path, self.equations, self.parameters, self.laws, version, **given)

    def run(self, samples: int = 1001, method: str = "auto") -> codegen.Result:
        times = np.linspace(0.0, self.end, samples)
        ready = codegen.simulator(self.equations, self.parameters, self.laws)
        return ready.run(times, self.initial, self.inputs, method)


def figure_11() -> Case:
    """The active limited slip differential whose clutch sticks and lets go again."""
    full = importlib.import_module("differentials.model").model("alsd")
    values = {symbol: parameter.value for symbol, parameter in full.parameters.items()}
    speeds = (80.0, 82.0)
    values |= dict(zip(full.starts, speeds, strict=True))
    initial = {f"omega_{j}": speed for j, speed in enumerate(speeds, 1)}
    initial |= {f"omega_t{j}": speed for j, speed in enumerate(speeds, 1)}
    states = {name.name for name in full.equations.states}
    if "omega_e" in states:
        initial["omega_e"] = values["i"] * sum(speeds) / 2
    initial = {name: speed for name, speed in initial.items() if name in states}
    (level,) = full.differential.clutches.values()
    inputs = {
        "tau_e": codegen.Lag(codegen.Step(0.1, 350.0), 0.04),
        level: codegen.Lag(codegen.Step(0.5, 1000.0), 0.04),
    }
    return Case(full.equations, values, full.laws, initial, inputs, 1.0)


def duffing() -> Case:
    """A mass on a hardening spring, whose displacement is its law's own state, with friction."""
    nodes = [
        bg.Se("force", "F"), bg.One("n"), bg.I("m", "m", flow="v", unit="m/s"),
        bg.C("s", law="k*q_s + c*q_s**3"),
        bg.R("rub", law=bg.DryFriction("N*mu", breakaway=1.4)),
    ]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "force>n>m n>s n>rub"), outputs=["rub"])
    numbers = {"m": 1.3, "k": 4.0, "c": 9.0, "mu": 0.3, "N": 2.0}
    return Case(
        equations, numbers, None, {"q_s": 1.1, "v": -0.4}, {"F": codegen.Sine(2.0, 0.7)}, 6.0
    )


def belt() -> Case:
    """A mass on a spring that a belt drags along: it sticks and slips again and again."""
    nodes = [
        bg.Sf("belt", "v_b"), bg.Zero("z"), bg.One("n"), bg.I("m", "m", flow="v"),
        bg.C("s", "1/k", effort="F_s"),
        bg.R("rub", law=bg.DryFriction("N", curve="1 + 0.5*exp(-slip/0.05)", breakaway=1.6)),
    ]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "belt>z>rub n>m n>s n>z"), outputs=["rub"])
    return Case(equations, {"m": 1.0, "k": 50.0, "N": 3.0}, None, {}, {"v_b": 0.1}, 3.0)


def divider() -> Case:
    """A source on two capacitances in series: the state jumps with the source."""
    nodes = [
        bg.Se("s", "V"), bg.One("n"), bg.Zero("z"), bg.R("r", "R"),
        bg.C("upper", "C_1", effort="v_1"), bg.C("lower", "C_2", effort="v_2", priority=1.0),
    ]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "s>n>upper n>z>lower z>r"), outputs=["z"])
    numbers = {"C_1": 0.3, "C_2": 0.2, "R": 1.4}
    return Case(equations, numbers, None, {"v_2": 0.4}, {"V": codegen.Step(0.5, 3.0, 1.0)}, 2.0)


def ran(path: Path, kind: str, case: Case, names, samples: int = 1001, **more):
    """A run of a unit by fmpy, sampled where the toolkit's is, and the times of changes of mode."""
    found = simulated(path, kind, case, [*names, *more.pop("modes", [])], samples, **more)
    modes = [name for name in found.dtype.names if name.startswith("mode(")]
    changes = [t for name in modes for t in found["time"][1:][np.diff(found[name]) != 0]]
    return sampled(found, case, samples), sorted(changes)


def simulated(
    path: Path, kind: str, case: Case, output, samples: int, tolerance: float = 1e-9, **more
):
    """The table that fmpy makes of a run, with rows at events beside those at the samples."""
    return simulate_fmu(
        str(path), fmi_type=kind, start_time=0.0, stop_time=case.end, solver="CVode",
        output_interval=case.end / (samples - 1), relative_tolerance=tolerance, output=list(output),
        **more,
    )  # fmt: skip


def sampled(found, case: Case, samples: int) -> dict[str, np.ndarray]:
    """Columns at equal steps of time; at an event the later of two rows counts."""
    grid = np.linspace(0.0, case.end, samples)
    places = np.searchsorted(found["time"], grid + 1e-9 * case.end, side="right") - 1
    return {name: found[name][places] for name in found.dtype.names}
