"""Models and measures for sweeps, in a module that other processes can import."""

import os
import signal
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType, SimpleNamespace

import numpy as np
from references.build import bond_graph

import bondgraph as bg
from codegen import Family, Lag, Result, Step, final, first_event, peak
from codegen.numbers.arrays import Array

TIMES = np.linspace(0.0, 2.0, 21)


def spring_mass() -> Family:
    """A mass on a spring pushed by P: m v' = P - F, F' = k v."""
    nodes = [bg.Se("push", "P"), bg.One("mass"), bg.I("m", "m", flow="v"),
             bg.C("spring", "1/k", effort="F")]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "push>mass>m mass>spring"))
    return Family(equations, {"m": 2.0, "k": 8.0})


def answer(m: Array, k: Array, v: Array, P: Array, t: float) -> tuple[Array, Array]:
    """Speed and force of `spring_mass` after a time, from speed v and no force."""
    w = np.sqrt(k / m)
    speed = v * np.cos(w * t) + P / (m * w) * np.sin(w * t)
    force = P * (1 - np.cos(w * t)) + v * m * w * np.sin(w * t)
    return speed, force


def locking() -> Family:
    """The rigid active limited slip differential of the README."""
    nodes = [bg.Se("engine", "tau_e"), bg.One("input"), bg.I("I_i", "I_i", priority=-1),
             bg.TF("final_drive", "1/i"), bg.One("case"), bg.TF("halves", 2), bg.Zero("sum"),
             bg.One("left"), bg.One("right"), bg.I("I_w1", "I_w1", flow="omega_1"),
             bg.I("I_w2", "I_w2", flow="omega_2"), bg.Zero("slip"),
             bg.R("clutch", effort="tau_f", flow="omega_f"),
             bg.R("tire_1", effort="tau_t1", flow="omega_t1"),
             bg.R("tire_2", effort="tau_t2", flow="omega_t2")]  # fmt: skip
    bonds = ("engine>input>final_drive>case>halves>sum input>I_i sum>left sum>right left>I_w1 "
             "right>I_w2 case>slip slip>clutch slip>right left>tire_1 right>tire_2")  # fmt: skip
    laws = {"clutch": bg.DryFriction("tau_h"), "tire_1": "c*(omega_t1 - w_0)",
            "tire_2": "c*(omega_t2 - w_0)"}  # fmt: skip
    numbers = {"i": 2.8, "I_i": 0.1604, "I_w1": 0.8, "I_w2": 0.8, "c": 750, "w_0": 80}
    return Family(bg.derive(bond_graph(nodes, bonds), outputs=["clutch"]), numbers, laws)


LOCKING = {
    "time": np.linspace(0.0, 0.1, 21),
    "measures": {"stick": first_event("clutch", "stick"), "peak": peak("tau_f")},
    "initial": {"omega_1": 80.0, "omega_2": 82.0},
    "inputs": {"tau_e": Step(0.05, 350.0), "tau_h": Lag(Step(0.0, 1000.0), 0.04)},
}
"""What the sweeps over `locking` share."""

MEASURES = {"speed": final("v"), "force": final("F")}


@dataclass(frozen=True)
class Plain:
    """A model that runs in no time: a, twice a."""

    parameters: Mapping[str, object] = field(default_factory=lambda: MappingProxyType({"a": 0.0}))
    states: tuple[str, ...] = ()
    inputs: tuple[str, ...] = ()

    def simulator(self, /, **changes: object) -> SimpleNamespace:
        if changes["a"] == 1e6:
            raise bg.ParameterError("a is a million")
        made = {"a": changes["a"], "twice": 2 * changes["a"]}
        return SimpleNamespace(run=lambda *_, **__: made)

    def fingerprint(self) -> str:
        return "plain"


def twice(result: Result) -> float:
    return float(result["twice"])


@dataclass(frozen=True)
class Logged:
    """The speed at the end; notes every run in a file, after a while."""

    folder: Path
    seconds: float = 0.0

    def __call__(self, result: Result) -> float:
        time.sleep(self.seconds)
        with (self.folder / "log").open("a") as file:
            file.write("x")
        return float(result["v"][-1])

    def __repr__(self) -> str:
        return "Logged()"

    def runs(self) -> int:
        return len((self.folder / "log").read_text())


@dataclass(frozen=True)
class Killer:
    """The force at the end; ends its process where the speed starts at ``at``, once or every time."""

    at: float
    folder: Path | None = None

    def __call__(self, result: Result) -> float:
        if result["v"][0] == self.at:
            if self.folder is None:
                os._exit(3)
            if not (self.folder / "killed").exists():
                (self.folder / "killed").touch()
                os.kill(os.getpid(), signal.SIGKILL)
        return float(result["F"][-1])
