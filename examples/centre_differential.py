"""A centre differential that splits torque k : 1 between a rear and a front passive differential.

A planetary gear does it: the transmission drives the carrier, the ring the rear axle, the sun the
front one. Ring over sun teeth k is the split. Wheels 1, 2 are at the rear, 3, 4 at the front.
"""

import networkx as nx
import numpy as np

import bondgraph as bg
import codegen
from differentials.laws import linear_tire
from differentials.parts import assemble, bevel, engine, gear, inertia, planetary, shaft, tire

WHEELS = {1: "rear_left", 2: "rear_right", 3: "front_left", 4: "front_right"}


def graph() -> nx.DiGraph:
    """The driveline: four wheel speeds are the states, the input inertia is dependent."""
    return assemble(
        shaft("carrier", "omega_e"), shaft("ring"), shaft("sun"),
        shaft("rear_case"), shaft("front_case"), *(shaft(wheel) for wheel in WHEELS.values()),
        engine("engine", "tau_e", at="carrier"), inertia("I_i", "I_i", at="carrier", priority=-1),
        planetary("centre", "k", sun="sun", ring="ring", carrier="carrier"),
        gear("rear_drive", "i_r", driving="ring", driven="rear_case"),
        gear("front_drive", "i_f", driving="sun", driven="front_case"),
        bevel("rear", case="rear_case", left="rear_left", right="rear_right"),
        bevel("front", case="front_case", left="front_left", right="front_right"),
        *(inertia(f"I_w{j}", "I_w", at=wheel, speed=f"omega_{j}") for j, wheel in WHEELS.items()),
        *(tire(j, at=wheel) for j, wheel in WHEELS.items()),
    )  # fmt: skip


def run() -> codegen.Result:
    """200 N m at the carrier from 80 rad/s on: the tires carry the split."""
    simulator = codegen.simulator(
        bg.derive(graph()),
        {"k": 1.5, "i_r": 2.8, "i_f": 2.8, "I_i": 0.16, "I_w": 0.8, "k_t": 2e5, "r": 0.3}
        | {f"omega_t{j}_0": 80 for j in WHEELS},
        laws={f"tire_{j}": linear_tire(j) for j in WHEELS},
    )
    start = {f"omega_{j}": 80 for j in WHEELS}
    return simulator.run(np.linspace(0, 1, 101), start, {"tau_e": codegen.Step(0.1, 200)})


if __name__ == "__main__":
    result = run()
    rear, front = (result[f"tau_t{j}"] + result[f"tau_t{j + 1}"] for j in (1, 3))
    print(
        f"rear {rear[-1]:.1f} N m, front {front[-1]:.1f} N m, split {rear[-1] / front[-1]:.3f} : 1"
    )
