"""A rear unit without a bevel gear: two clutches from the ring gear's shaft to the wheels.

Each clutch gives its wheel as much torque as it is pressed for; the ring turns faster than the wheels
by the gear's ratio, so both slip while the car turns. Both locked, the axle is rigid.
"""

import networkx as nx
import numpy as np

import bondgraph as bg
import codegen
from differentials.laws import linear_tire
from differentials.parts import assemble, clutch, engine, gear, inertia, shaft, tire

WHEELS = {1: "left", 2: "right"}


def graph() -> nx.DiGraph:
    """Ring shaft and wheels are the states, the input inertia is referred to the ring."""
    return assemble(
        shaft("input", "omega_e"), shaft("ring"), shaft("left"), shaft("right"),
        engine("engine", "tau_e", at="input"), inertia("I_i", "I_i", at="input", priority=-1),
        gear("final_drive", "i", driving="input", driven="ring"),
        inertia("I_r", "I_r", at="ring", speed="omega_r"),
        *(inertia(f"I_w{j}", "I_w", at=wheel, speed=f"omega_{j}") for j, wheel in WHEELS.items()),
        *(clutch(f"clutch_{j}", f"tau_f{j}", f"omega_f{j}", "ring", wheel) for j, wheel in WHEELS.items()),
        *(tire(j, at=wheel) for j, wheel in WHEELS.items()),
    )  # fmt: skip


def run(left: float = 400.0, right: float = 150.0) -> codegen.Result:
    """A bend to the right at 60 and 57 rad/s: the outer, left clutch is pressed harder."""
    simulator = codegen.simulator(
        bg.derive(graph(), outputs=["clutch_1", "clutch_2"]),
        {"i": 2.5, "I_i": 0.16, "I_r": 0.02, "I_w": 0.8, "k_t": 2e5, "r": 0.3,
         "omega_t1_0": 60, "omega_t2_0": 57},
        laws={"clutch_1": bg.DryFriction("tau_h1"), "clutch_2": bg.DryFriction("tau_h2"),
              **{f"tire_{j}": linear_tire(j) for j in WHEELS}},
    )  # fmt: skip
    start = {"omega_r": 63, "omega_1": 60, "omega_2": 57}
    pressed = {"tau_h1": left, "tau_h2": right}
    demands = {name: codegen.Lag(codegen.Step(0.0, level), 0.04) for name, level in pressed.items()}
    # What the clutches pass on in the end is what the engine gives, so the ring settles.
    drive = codegen.Lag(codegen.Step(0.0, (left + right) / 2.5), 0.04)
    return simulator.run(np.linspace(0, 1, 1001), start, {"tau_e": drive, **demands})


if __name__ == "__main__":
    result = run()
    print(f"left {result['tau_t1'][-1]:.1f} N m, right {result['tau_t2'][-1]:.1f} N m")
    print([(event.kind, event.port, round(event.time, 4)) for event in result.events])
