"""Three models for real time: a differential, a gearbox of seven clutches, a bridge of six diodes."""

import ctypes
import subprocess
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from references.build import bond_graph

import bondgraph as bg
from codegen import Lag, Sampled, Signal, Sine, Step, simulator, to_c
from codegen.c.export import stepped
from codegen.program.lower import lower
from differentials.scenarios import prepared
from oracles.c_model import compiled, written
from oracles.many import bridge

DRIVER = Path(__file__).parent / "realtime.c"

COUNTED = Path(__file__).parent / "counted.hpp"

EVERY = 0.01
"""Between samples [s]."""


@dataclass(frozen=True)
class RealTime:
    """A model in a run, and a stretch from its start on in which no port changes [s]."""

    equations: bg.StateEquations
    numbers: Mapping[str, object]
    laws: Mapping[Any, object] | None
    initial: Mapping[str, float]
    inputs: Mapping[str, Signal]
    end: float
    smooth: float

    @cached_property
    def reference(self) -> np.ndarray:
        """The states at samples, events located."""
        times = np.linspace(0, self.end, round(self.end / EVERY) + 1)
        ready = simulator(self.equations, self.numbers, self.laws, backend="c")
        run = ready.run(times, self.initial, self.inputs)
        return np.column_stack([run[name] for name in ready.states])

    def export(self, integrator: str = "rk4") -> dict[str, str]:
        return stepped(to_c(self.equations, self.numbers, self.laws, integrator=integrator))


GEARS = (("G1", "A", 3.6), ("G3", "A", 1.5), ("G2", "B", 2.2), ("G4", "B", 1.1), ("GR", "B", -3.2))
"""The gears of the gearbox: the shaft each is on, and its ratio."""


def gearbox() -> RealTime:
    """A dual-clutch gearbox: two input clutches, five gears that clutches engage, a driveshaft, a car.

    From standstill it starts in gear 1 and shifts to gear 2, whose shaft is ready, then to gear 3.
    """
    nodes = [
        bg.Se("engine", "T"),
        bg.R("drag", 0.3),
        bg.Zero("shaft"),
        bg.C("spring", 1 / 2000.0, effort="F"),
    ]
    bonds = ["engine>in", "out>shaft>wheel", "shaft>spring", "wheel>drag"]
    for name, inertia in (("in", 0.15), ("A", 0.02), ("B", 0.025), ("out", 0.05), ("wheel", 2.0)):
        nodes += [bg.One(name), bg.I(f"I_{name}", inertia, flow=f"w_{name}")]
        bonds += [f"{name}>I_{name}"]
    for name, shaft in (("K1", "A"), ("K2", "B")):
        nodes += [bg.Zero(f"z{name}"), bg.R(name, law=bg.DryFriction(f"N_{name}"))]
        bonds += [f"in>z{name}>{shaft}", f"z{name}>{name}"]
    for name, shaft, ratio in GEARS:
        law = bg.DryFriction(f"N_{name}")
        nodes += [bg.Zero(f"z{name}"), bg.TF(f"t{name}", 1 / ratio), bg.R(name, law=law)]
        bonds += [f"{shaft}>t{name}>z{name}>out", f"z{name}>{name}"]
    inputs = {
        "T": Sine(20.0, 1.5),
        "N_K1": Lag(Sampled([0, 0.1, 1.0], [0.0, 60.0, 0.5]), 0.05),
        "N_K2": Lag(Sampled([0, 1.0, 2.0], [0.2, 60.0, 60.0]), 0.05),
        "N_G1": Lag(Step(1.3, 0.1, 200.0), 0.03),
        "N_G2": Lag(Step(2.0, 150.0, 150.0), 0.03),
        "N_G3": Lag(Step(1.5, 150.0, 0.3), 0.03),
        "N_G4": Lag(Step(0.0, 0.2, 0.2), 0.03),
        "N_GR": Lag(Step(0.0, 0.1, 0.1), 0.03),
    }
    equations = bg.derive(bond_graph(nodes, " ".join(bonds)))
    return RealTime(equations, {}, None, {}, inputs, 2.0, 0.0)


def slipping_gearbox() -> RealTime:
    """The same with every clutch slipping on, each shaft much faster than the next."""
    case = gearbox()
    start = {"w_in": 900.0, "w_A": 500.0, "w_B": 300.0, "w_out": 20.0, "w_wheel": 20.0}
    inputs = {"T": Sine(20.0, 1.5)} | {
        name: Sine(0.4, 2.0, 1.0, 1.0) for name in case.inputs if name != "T"
    }
    return RealTime(case.equations, {}, None, start, inputs, 0.2, 0.2)


def alsd(scenario: str = "fig11") -> RealTime:
    """The active limited slip differential of the paper; its clutch sticks, and slips again."""
    case = prepared("alsd", scenario)
    end, smooth = float(case.times[-1]), 0.5 if scenario == "fig11" else 0.0
    return RealTime(
        case.equations, case.parameters, case.laws, case.initial, case.inputs, end, smooth
    )


def six_pulse() -> RealTime:
    """A bridge of six diodes on three phases with coils, before a choke."""
    case = bridge(3)
    return RealTime(bg.derive(case.graph), {}, None, {}, case.inputs, 0.65, 0.03)


def conducting_bridge() -> RealTime:
    """The same with a current in two of its phases, so that the next diode turns on at 0.04 s."""
    case, start = six_pulse(), {"i": 1.0, "i1": 1.02, "i2": -1.02}
    return RealTime(case.equations, {}, None, start, case.inputs, case.end, 0.03)


@dataclass(frozen=True)
class Marched:
    """Steps: states at the end of each, modes then, blocks run through, statuses; how many were taken."""

    rows: np.ndarray
    modes: np.ndarray
    costs: np.ndarray
    told: np.ndarray
    taken: int


def _pointer(values: np.ndarray) -> ctypes.c_void_p:
    return values.ctypes.data_as(ctypes.c_void_p)


class Exported:
    """A model as C, compiled so that what its steps run through is counted."""

    def __init__(self, case: RealTime, folder: Path, integrator: str = "rk4") -> None:
        self.case, self.program = case, lower(case.equations, case.laws, case.numbers)
        sources = [*written(folder, case.export(integrator)), str(DRIVER)]
        # What a step costs is asked of Runge-Kutta's alone, optimised.
        level = "-O1" if integrator == "rk4" else "-O0"
        flags = (level, "-fsanitize-coverage=trace-pc", "-shared", "-fPIC")
        self.library = ctypes.CDLL(str(compiled(folder, sources, *flags, to="model.so")))
        self.library.bg_model_size.restype = ctypes.c_size_t
        self.library.bg_model_message.restype = ctypes.c_char_p
        self.external = [one.name for one in self.program.external]
        self.states = [one.name for one in (*self.program.states, *self.program.law_states)]

    def begun(self, w: np.ndarray) -> tuple[Any, np.ndarray]:
        """An instance, and the vector at the start."""
        model = ctypes.create_string_buffer(self.library.bg_model_size())
        assert self.library.bg_model_init(model, None) == 0
        s = np.array([float(self.case.initial.get(name, 0.0)) for name in self.states])
        out = np.zeros(len(s))
        status = self.library.bg_model_vector(
            model,
            ctypes.c_double(0.0),
            _pointer(s),
            _pointer(np.ascontiguousarray(w)),
            _pointer(out),
        )
        assert status == 0
        return model, out

    def given(self, h: float, count: int) -> np.ndarray:
        """The inputs at 0, h/2, h and so on."""
        signals = [self.case.inputs[name] for name in self.external]
        times = 0.5 * h * np.arange(2 * count + 1)
        return np.array([[float(signal(t)) for signal in signals] for t in times])

    def march(self, h: float, end: float) -> Marched:
        count = round(end / h)
        w = self.given(h, count)
        model, s = self.begun(w[0])
        rows, costs = np.zeros((count, len(s))), np.zeros(count)
        modes = np.zeros((count, len(self.program.friction)), np.intc)
        told = np.zeros(count, np.intc)
        taken = self.library.realtime_march(
            model, ctypes.c_double(h), count, _pointer(s), _pointer(w), _pointer(rows),
            _pointer(modes), _pointer(costs), _pointer(told),
        )  # fmt: skip
        return Marched(rows, modes, costs, told, taken)

    def error(self, h: float) -> float:
        """The largest difference of a state from the reference at samples, over its range."""
        found, every = self.march(h, self.case.end), round(EVERY / h)
        assert found.taken == len(found.costs), self.message(int(found.told[found.taken]))
        expected = self.case.reference
        return float(
            (np.abs(found.rows[every - 1 :: every] - expected[1:]) / np.ptp(expected, axis=0)).max()
        )

    def rest(self, h: float, count: int, w: Mapping[str, float], swings: str, by: float):
        """How often modes change in so many steps at rest, how far states go from their place, the last."""
        values, far = np.array([float(w.get(name, 0.0)) for name in self.external]), np.zeros(1)
        model, s = self.begun(values)
        changes = self.library.realtime_rest(
            model, ctypes.c_double(h), count, _pointer(s), _pointer(values),
            self.external.index(swings), ctypes.c_double(by), _pointer(far),
        )  # fmt: skip
        return changes, float(far[0]), dict(zip(self.states, s.tolist(), strict=True))

    def message(self, status: int) -> str:
        return str(self.library.bg_model_message(status).decode())


_COUNTING = """
#undef double
#include <cstdio>
int main()
{
    static bg_model model;
    static counted s[BG_SIZE], w[3 * BG_ROOM(BG_EXTERNAL)];
    const double states[] = {%s}, given[] = {%s};
    for (int i = 0; i < BG_SIZE; i++)
        s[i] = states[i];
    for (int i = 0; i < 3 * BG_EXTERNAL; i++)
        w[i] = given[i %% BG_EXTERNAL];
    static counted x[BG_SIZE];
    bg_model_init(&model, nullptr);
    bg_model_vector(&model, 0.0, s, w, x);
    for (int k = 0; k < 5; k++) {
        std::memset(operations, 0, sizeof operations);
        const int status = bg_model_step(&model, k * 1e-4, 1e-4, x, w);
        std::printf("%%d %%llu %%llu %%llu %%llu\\n", status, operations[0], operations[1], operations[2],
                    operations[3]);
    }
}
"""


def operations(case: RealTime, folder: Path, integrator: str = "rk4") -> np.ndarray:
    """Statuses of five steps from the start, and their products, sums, quotients and calls: counted by
    numbers that count, as C++."""
    files = case.export(integrator)
    written(folder, files)
    program = lower(case.equations, case.laws, case.numbers)
    names = [one.name for one in (*program.states, *program.law_states)]
    states = ", ".join(repr(float(case.initial.get(name, 0.0))) for name in names)
    given = ", ".join(repr(float(case.inputs[one.name](0.0))) for one in program.external)
    parts = [f'#include "{COUNTED}"', '#include "port_switch.h"', "#define bg_way bg_tried_way"]
    parts += [f'#include "{name}"' for name in files if name.endswith(".c")]
    (folder / "all.cpp").write_text("\n".join(parts) + _COUNTING % (states, given))
    command = [
        "g++",
        "-std=gnu++20",
        "-fpermissive",
        "-w",
        "-O0",
        "-I",
        str(folder),
        str(folder / "all.cpp"),
    ]
    done = subprocess.run(
        [*command, "-o", str(folder / "count")], capture_output=True, text=True, check=False
    )
    if done.returncode:
        pytest.fail(done.stderr[:2000])
    told = subprocess.run(
        [str(folder / "count")], capture_output=True, text=True, check=True
    ).stdout
    return np.array([[int(one) for one in line.split()] for line in told.splitlines()])
