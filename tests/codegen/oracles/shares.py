"""How ports share a load in C, along any directions."""

import ctypes
from pathlib import Path

import numpy as np
from references.build import bond_graph

import bondgraph as bg
from codegen import to_c
from oracles.c_model import compiled, written

HARNESS = Path(__file__).parent / "share_harness.c"

Numbers = ctypes.POINTER(ctypes.c_double)


class SharesInC:
    """``fair_share`` of C, for so many ports at the most: those of one shaft with as many brakes."""

    def __init__(self, folder: Path, ports: int, level: str = "-O0") -> None:
        nodes = [bg.Se("push", "P"), bg.One("n"), bg.I("m", 2, flow="v"),
                 *(bg.R(f"b{i}", law=bg.DryFriction(1)) for i in range(ports))]  # fmt: skip
        brakes = " ".join(f"n>b{i}" for i in range(ports))
        sources = written(folder, to_c(bg.derive(bond_graph(nodes, f"push>n>m {brakes}")), {}))
        sources = [one for one in sources if not one.endswith("main.c")]
        built = compiled(folder, [*sources, str(HARNESS)], level, "-shared", "-fPIC", to="share.so")
        self.call = ctypes.CDLL(str(built)).harness_share
        self.call.argtypes = [ctypes.c_int, ctypes.c_int, Numbers, Numbers, Numbers]

    def __call__(self, efforts: np.ndarray, share: np.ndarray, caps: np.ndarray) -> np.ndarray:
        found, rows, most = (
            np.array(one, dtype=float, order="C") for one in (efforts, share, caps)
        )
        status = self.call(
            *rows.shape, *(one.ctypes.data_as(Numbers) for one in (rows, most, found))
        )
        assert status == 0, status
        return found
