"""A motor with a sampled controller, as one graph and in two."""

import numpy as np

import bondgraph as bg
import codegen

SHAFT = [bg.One("shaft"), bg.I("J", "J", flow="omega"), bg.R("b", "b")]
PATH = "motor > shaft > J, shaft > b"
PLANT = {"J": 0.5, "b": 0.2}
CONTROL = {"K": 1.0, "K_i": 4.0, "T": 0.01}
WIRES = {"plant.omega": "controller.omega", "controller.tau": "plant.tau"}


def controller(offset: object = 0) -> object:
    return bg.Controller(
        "pi", every=0.01, offset=offset, reads=["ref", "omega"], states={"z": 0},
        update={"z": "z + T*K_i*(ref - omega)"}, gives={"tau": "K*(ref - omega) + z"},
    )  # fmt: skip


def late_controller() -> object:
    """What it gives at an instant was told at the one before."""
    return bg.Controller(
        "pi", every=0.01, reads=["ref", "omega"], states={"z": 0, "next": 0},
        update={"z": "z + T*K_i*(ref - omega)", "next": "K*(ref - omega) + z"},
        gives={"tau": "next"},
    )  # fmt: skip


def whole(node: object) -> codegen.Result:
    """The loop in one graph."""
    graph = bg.graph([bg.Se("motor", "1*tau"), *SHAFT, node], PATH)
    ready = codegen.simulator(bg.derive(graph), {**PLANT, **CONTROL})
    return ready.run(np.arange(101) / 100, inputs={"ref": 1.0})


def plant(backend: str = "numpy") -> codegen.Simulator:
    graph = bg.graph([bg.Se("motor", "tau"), *SHAFT], PATH)
    return codegen.simulator(bg.derive(graph), PLANT, backend=backend)


def off(found: np.ndarray, wanted: np.ndarray) -> float:
    """The largest difference, of the range."""
    return float(np.abs(found - wanted).max() / np.ptp(wanted))
