"""The floor for models that are not affine: Fig. 11 with magic formula tires in hand-specialised C.

Builds ``magic_*.c`` and runs it: by DOP853, by exponential steps, and by these of eight runs at once. ``CC``
and ``CFLAGS`` change the compiler and its options.
"""

import ctypes
import os
import shlex
import subprocess
from collections.abc import Callable, Mapping
from ctypes import POINTER, Structure, byref, c_double, c_int
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

HERE = Path(__file__).parent
RUNTIME = HERE.parents[1] / "codegen" / "runtime"

Array = npt.NDArray[np.float64]

SAMPLES, STEP = 1001, 1e-3
STATES = ("omega_1", "omega_2", "tau_k1", "tau_k2", "omega_t1", "omega_t2")
COLUMNS = (*STATES, "tau_f", "omega_f")
FIGURE = {
    "i": 2.8, "I_i": 0.1604, "I_1": 0.008, "I_2": 0.008, "I_w": 0.8, "k": 8600.0, "k_t": 200000.0,
    "r": 0.3, "lag": 0.04, "omega_0": 80.0, "dw0": -2.0, "tau_e": 350.0, "tau_h": 1000.0,
    "time_e": 0.1, "time_h": 0.5, "D": 4000.0, "C": 1.65, "E": -1.0,
}  # fmt: skip
"""The figure's numbers, and those of the tires."""

FLAGS = (
    "-O3 -march=native -mprefer-vector-width=512 -ffp-contract=fast -fno-math-errno -fno-trapping-math "
    "-std=c99 -Wall -Wextra -Wno-psabi -Werror"
)
DOUBLES = POINTER(c_double)
EXPONENTIAL = 0.0
"""The tolerance that asks for exponential steps, which have none."""


class Parameters(Structure):
    """``magic_parameters``."""

    _fields_ = [(name, c_double) for name in FIGURE]


class Result(Structure):
    """``magic_result``."""

    _fields_ = [
        *((name, c_double) for name in ("peak", "lock", "last")),
        *((name, c_int) for name in ("events", "steps", "renewals")),
    ]


@dataclass(frozen=True)
class Runs:
    """Rows as ``COLUMNS`` name them, run after run, if they were kept; what each run gives."""

    rows: Array | None
    peak: Array
    lock: Array
    last: Array
    events: Array


def build(folder: Path) -> ctypes.CDLL:
    """Compile the library into a folder and load it."""
    library = folder / "magic_floor.so"
    compiler = shlex.split(os.environ.get("CC", "gcc"))
    flags = shlex.split(os.environ.get("CFLAGS", FLAGS))
    headers = [f"-I{RUNTIME / part}" for part in ("located", "lanes")]
    sources = [str(source) for source in sorted(HERE.glob("magic_*.c"))]
    ending = ["-shared", "-fPIC", "-o", str(library), *sources, "-lm"]
    subprocess.run([*compiler, *flags, *headers, *ending], check=True)
    return ctypes.CDLL(str(library))


def one_by_one(
    library: ctypes.CDLL, stiffness: Array, torque: Array, tolerance: float, keep: bool = False,
    changed: Mapping[str, float] = FIGURE,
) -> Runs:  # fmt: skip
    """Runs one after another, by DOP853 or `EXPONENTIAL` steps; ``keep``: their samples."""
    call = library.magic_sweep
    return _runs(call, stiffness, torque, [c_double(tolerance)], keep, changed)


def at_once(
    library: ctypes.CDLL, stiffness: Array, torque: Array, keep: bool = False,
    changed: Mapping[str, float] = FIGURE,
) -> Runs:  # fmt: skip
    """The same, eight runs at once."""
    return _runs(library.magic_lanes, stiffness, torque, [], keep, changed)


def _runs(
    call: Callable[..., int], stiffness: Array, torque: Array, more: list[c_double], keep: bool,
    changed: Mapping[str, float],
) -> Runs:  # fmt: skip
    count = stiffness.size
    rows = np.empty((count, SAMPLES, len(COLUMNS))) if keep else None
    given, found = Parameters(**{**FIGURE, **changed}), (Result * count)()
    ending = (*more, None if rows is None else _at(rows), found)
    arrays = _at(np.ascontiguousarray(stiffness)), _at(np.ascontiguousarray(torque))
    failed = call(byref(given), c_double(STEP), SAMPLES, count, *arrays, *ending)
    if failed:
        raise RuntimeError(f"{failed} of {count} runs failed")
    names = ("peak", "lock", "last", "events")
    return Runs(rows, *(np.array([getattr(one, name) for one in found]) for name in names))


def _at(values: Array) -> object:
    return values.ctypes.data_as(DOUBLES)
