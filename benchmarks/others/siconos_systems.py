"""Friction chains and a diode bridge as Siconos takes them, and as the engine does.

Its steps are of the first order, so that the error of one with half the step is as large as the two differ.
"""

import json
import os
import shutil
import subprocess
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import networkx as nx
import numpy as np
from references.build import bond_graph

import bondgraph as bg
from codegen import Signal, Sine, simulator

SCRIPT = Path(__file__).with_name("siconos_steps.py")
SAMPLES = 50


@dataclass(frozen=True)
class System:
    """A graph and a run of it; matrices of the same, whose first states are those of ``names``."""

    graph: "nx.DiGraph[object]"
    inputs: Mapping[str, Signal]
    initial: Mapping[str, float]
    names: tuple[str, ...]
    matrices: Mapping[str, list[list[float]]]
    x: list[float]
    limits: list[float]
    end: float
    steps: int


def chain(count: int) -> System:
    """Masses between springs, each rubbing on the ground, the first pushed by a sine."""
    draw = np.random.default_rng(count)
    mass, spring = draw.uniform(0.5, 2.0, count).tolist(), draw.uniform(20, 60, count).tolist()
    levels, size, turns = draw.uniform(0.3, 1.5, count).tolist(), 8.0, 0.35
    nodes = [bg.Se("push", "P"), *(bg.One(f"n{k}") for k in range(count))]
    bonds = ["push>n0"]
    for k in range(count):
        nodes += [bg.I(f"m{k}", mass[k], flow=f"v{k}"), bg.R(f"rub{k}", law=bg.DryFriction(levels[k])),
                  bg.C(f"s{k}", f"1/{spring[k]!r}", effort=f"F{k}")]  # fmt: skip
        bonds += [f"n{k}>m{k}", f"n{k}>rub{k}"]
        if k + 1 < count:
            nodes.append(bg.Zero(f"z{k}"))
            bonds += [f"n{k}>z{k}>n{k + 1}", f"z{k}>s{k}"]
        else:
            bonds.append(f"n{k}>s{k}")
    n, omega = 2 * count + 2, 2 * np.pi * turns
    A, B, C = np.zeros((n, n)), np.zeros((n, count)), np.zeros((count, n))
    for k in range(count):
        # Of the springs behind and before it; and what moves them.
        A[k, count + k], A[count + k, k] = -1 / mass[k], spring[k]
        if k + 1 < count:
            A[k + 1, count + k], A[count + k, k + 1] = 1 / mass[k + 1], -spring[k]
        B[k, k], C[k, k] = 1 / mass[k], 1.0
    A[0, n - 2], A[n - 2, n - 1], A[n - 1, n - 2] = size / mass[0], omega, -omega
    names = [f"v{k}" for k in range(count)] + [f"F{k}" for k in range(count)]
    matrices = {"A": A, "B": B, "C": C, "D": np.zeros((count, count))}
    return System(
        bond_graph(nodes, " ".join(bonds)), {"P": Sine(size, turns)}, {}, tuple(names),
        {name: value.tolist() for name, value in matrices.items()}, [0.0] * (n - 1) + [1.0],
        levels, 5.0, 4_000,
    )  # fmt: skip


def bridge() -> System:
    """A coil and a capacitor ring down through four diodes into a resistance (Acary, Brogliato 2008)."""
    L, C, R = 1e-2, 1e-6, 1e3
    ways = ["a>w1>d1 w1>p", "b>w2>d2 w2>p", "q>w3>d3 w3>a", "q>w4>d4 w4>b"]
    nodes = [bg.I("L", L, flow="i"), bg.C("C", C, effort="v"), bg.R("R", R), bg.One("lc"), bg.One("out"),
             *(bg.Zero(n) for n in "abpq"), *(bg.One(f"w{k}") for k in range(1, 5)),
             *(bg.Diode(f"d{k}") for k in range(1, 5)), bg.Zero("both"),
             bg.One("leak"), bg.R("far", 1e9)]  # fmt: skip
    bonds = "both>L both>C lc>both b>lc lc>a p>out out>q out>R b>leak leak>far " + " ".join(ways)
    matrices = {
        "A": [[0, -1 / C], [1 / L, 0]],
        "B": [[0, 0, -1 / C, 1 / C], [0, 0, 0, 0]],
        "C": [[0, 0], [0, 0], [-1, 0], [1, 0]],
        "D": [[1 / R, 1 / R, -1, 0], [1 / R, 1 / R, 0, -1], [1, 0, 0, 0], [0, 1, 0, 0]],
    }
    return System(
        bond_graph(nodes, bonds), {}, {"v": 10.0}, ("v", "i"), matrices, [10.0, 0.0], [], 2e-3, 8_000
    )  # fmt: skip


SYSTEMS = {
    "chain of 3 with friction": lambda: chain(3), "chain of 8 with friction": lambda: chain(8),
    "bridge of four diodes": bridge,
}  # fmt: skip


def interpreter() -> str | None:
    """The Python that Debian's package python3-siconos belongs to."""
    return shutil.which("python3", path=os.defpath)


def missing() -> str:
    """Why it cannot be asked; nothing if it can."""
    python = interpreter()
    asked = [python or "python3", "-c", "import siconos.kernel"]
    if python and not subprocess.run(asked, capture_output=True, check=False).returncode:
        return ""
    return "Siconos is not installed (Debian's package python3-siconos)"


def theirs(system: System, parts: int) -> np.ndarray:
    """Its states at the samples, by steps of a part."""
    count = system.steps * parts
    told = {
        **system.matrices, "x": system.x, "limits": system.limits, "h": system.end / count,
        "count": count, "every": count // SAMPLES,
    }  # fmt: skip
    done = subprocess.run(
        [str(interpreter()), str(SCRIPT)], input=json.dumps(told), capture_output=True, text=True,
        check=True,
    )  # fmt: skip
    rows = json.loads(done.stdout[done.stdout.index("[[") :])
    return np.array(rows)[:, : len(system.names)]


def ours(system: System) -> tuple[np.ndarray, int]:
    """The engine's, and how many events."""
    ready = simulator(bg.derive(system.graph), {}, backend="c")
    times = np.linspace(0.0, system.end, SAMPLES + 1)
    run = ready.run(times, system.initial, system.inputs)
    return np.column_stack([run[name] for name in system.names]), len(run.events)
