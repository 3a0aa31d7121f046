"""An active limited slip differential behind a Ravigneaux gear, which shifts between two ratios.

The Ravigneaux gear has two suns, one ring, one carrier: a simple planetary gear (large sun) and one of
paired planets (small sun) that share ring and carrier. The engine drives the small sun, the ring is
the differential's case. One brake holds the carrier, another the large sun.
"""

import networkx as nx
import numpy as np

import bondgraph as bg
import codegen
from differentials.laws import linear_tire
from differentials.parts import (
    assemble,
    bevel,
    brake,
    clutch,
    double_planetary,
    engine,
    inertia,
    planetary,
    shaft,
    tire,
)

WHEELS = {1: "left", 2: "right"}


def ravigneaux(name: str, small: str, large: str, ring: str, carrier: str) -> nx.DiGraph:
    """``(1 + h_l) w_carrier = h_l w_ring + w_large``, ``h_s w_ring = w_small + (h_s - 1) w_carrier``."""
    return assemble(
        planetary(f"{name}_large", "h_l", sun=large, ring=ring, carrier=carrier),
        double_planetary(f"{name}_small", "h_s", driving=ring, driven=small, carrier=carrier),
    )


def graph() -> nx.DiGraph:
    """Wheels and carrier are the states; the inertias of engine and large sun are dependent."""
    return assemble(
        shaft("small_sun", "omega_e"), shaft("large_sun"), shaft("carrier"), shaft("case", "omega_c"),
        shaft("left"), shaft("right"),
        engine("engine", "tau_e", at="small_sun"),
        inertia("I_k", "I_k", at="carrier", speed="omega_k", priority=-1),
        inertia("I_i", "I_i", at="small_sun", priority=-1),
        inertia("I_l", "I_l", at="large_sun", priority=-1),
        ravigneaux("gear", "small_sun", "large_sun", ring="case", carrier="carrier"),
        bevel("bevel", case="case", left="left", right="right"),
        *(inertia(f"I_w{j}", f"I_w{j}", at=wheel, speed=f"omega_{j}") for j, wheel in WHEELS.items()),
        brake("low", "tau_low", "omega_low", at="carrier"),
        brake("high", "tau_high", "omega_high", at="large_sun"),
        clutch("clutch", "tau_f", "omega_f", driving="case", driven="right"),
        *(tire(j, at=wheel) for j, wheel in WHEELS.items()),
    )  # fmt: skip


def run() -> codegen.Result:
    """A shift under load from low (carrier held) to high (large sun held) at 0.3 s."""
    simulator = codegen.simulator(
        bg.derive(graph(), outputs=["low", "high", "clutch", "small_sun", "case"]),
        {"h_s": 3.2, "h_l": 2.1, "I_i": 0.16, "I_l": 0.01, "I_k": 0.02, "I_w1": 0.8, "I_w2": 0.8,
         "k_t": 2e5, "r": 0.3, "omega_t1_0": 40, "omega_t2_0": 40},
        laws={"low": bg.DryFriction("tau_hl"), "high": bg.DryFriction("tau_hh"),
              "clutch": bg.DryFriction("tau_h"), **{f"tire_{j}": linear_tire(j) for j in WHEELS}},
    )  # fmt: skip
    start = {"omega_1": 40, "omega_2": 40, "omega_k": 0}
    low = codegen.Lag(codegen.Step(0.3, 0.0, initial=600.0), 0.04)
    high = codegen.Lag(codegen.Step(0.3, 600.0), 0.04)
    inputs = {"tau_e": codegen.Lag(codegen.Step(0.05, 120.0), 0.04), "tau_h": 0.0,
              "tau_hl": low, "tau_hh": high}  # fmt: skip
    return simulator.run(np.linspace(0, 1, 1001), start, inputs)


if __name__ == "__main__":
    result = run()
    ratios = result["omega_e"] / result["omega_c"]
    print(f"ratio {ratios[0]:.3f} at first, {ratios[-1]:.3f} in the end")
    print([(event.kind, event.port, round(event.time, 4)) for event in result.events])
