"""An exported C model, compiled and called from Python."""

import ctypes
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pytest

from codegen import to_c
from codegen.c.export import stepped
from codegen.modes.closed import ClosedModel
from codegen.program.lower import lower
from codegen.program.records import Program

STRICT = ("-std=c99", "-Wall", "-Wextra", "-Wpedantic")

WARNED = (*STRICT, "-Werror", "-Wconversion", "-Wno-sign-conversion")
"""What engines are compiled with that are checked for warnings."""

HARNESS = Path(__file__).parent / "harness.c"


def written(folder: Path, files: Mapping[str, str]) -> list[str]:
    """Write an export; returns its C files."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8")
    return [str(folder / name) for name in files if name.endswith(".c")]


def compiled(folder: Path, sources: Sequence[str], *flags: str, to: str = "run") -> Path:
    """Compile C files without a warning; the test is skipped where there is no gcc.

    With ``-Werror`` among the flags each file by itself, as users do, so that none lacks an include.
    """
    if shutil.which("gcc") is None:
        pytest.skip("no gcc")
    command = ["gcc", *STRICT, *flags, "-I", str(folder), *sources, "-o", str(folder / to), "-lm"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    return folder / to


def closer(files: Mapping[str, str]) -> dict[str, str]:
    """An export whose located runs keep to tolerances of 1e-10 and 1e-11."""
    told = files["tuning.h"].replace("BG_RTOL 1e-08", "BG_RTOL 1e-10")
    told = told.replace("BG_ATOL 1e-10", "BG_ATOL 1e-11")
    assert told.count("1e-11 /* the same in units") == 1
    return {**files, "tuning.h": told}


def check_told(folder: Path, files: Mapping[str, str]) -> None:
    """The compiler has no warning for these files, compiled as one up to where it optimises.

    For sizes beside those at which the same files are compiled one by one as users have them.
    """
    text = "".join(f'#include "{file}"\n' for file in written(folder, files))
    command = ["gcc", *WARNED, "-O1", "-flto", "-fno-fat-lto-objects", "-fPIC", "-I", str(folder)]
    done = subprocess.run([*command, "-x", "c", "-", "-c", "-o", str(folder / "all.o")],
                          input=text, capture_output=True, text=True, check=False)  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")


def _numbers(values: object) -> ctypes.Array:
    flat = np.ravel(np.asarray(values, dtype=float)).tolist()
    return (ctypes.c_double * max(len(flat), 1))(*flat)


class CModel:
    """One instance of an exported model beside the `ClosedModel` it must agree with."""

    def __init__(
        self, library: ctypes.CDLL, program: Program, values: Mapping[str, object]
    ) -> None:
        self.library, self.program = library, program
        library.bg_model_size.restype = ctypes.c_size_t
        library.bg_model_message.restype = ctypes.c_char_p
        self.instance = ctypes.create_string_buffer(library.bg_model_size())
        numbers = [float(values[name.name]) for name in program.parameters]
        self.status = library.bg_model_init(self.instance, _numbers(numbers))
        n, own, m = len(program.states), len(program.law_states), len(program.inputs)
        self.size = max(n + own, 1)
        self.sizes = (n, own, m, m, len(program.readings), self.size, len(program.friction))

    def _mode(self, mode: Sequence[int]) -> ctypes.Array:
        return (ctypes.c_int * max(len(mode), 1))(*mode)

    def evaluate(self, t: float, s, w, dw, mode: Sequence[int]) -> tuple[int, list[np.ndarray]]:
        """The status, and x, z, u, du, y, rate, caps and outputs."""
        room = _numbers(np.zeros(sum(self.sizes) + len(self.program.outputs)))
        status = self.library.harness_evaluate(
            self.instance,
            ctypes.c_double(t),
            _numbers(s),
            _numbers(w),
            _numbers(dw),
            self._mode(mode),
            room,
        )
        return status, np.split(np.array(room), np.cumsum(self.sizes))

    def affine_map(self, mode: Sequence[int]) -> tuple[int, np.ndarray]:
        shape = sum(self.sizes), self.size + 2 * len(self.program.external) + 1
        room = _numbers(np.zeros(shape))
        return self.library.bg_model_affine_map(self.instance, self._mode(mode), room), np.reshape(
            room, shape
        )

    def vector(self, t: float, states, w) -> np.ndarray:
        room = _numbers(np.zeros(self.size))
        status = self.library.bg_model_vector(
            self.instance, ctypes.c_double(t), _numbers(states), _numbers(w), room
        )
        assert status == 0, self.message(status)
        return np.array(room)

    def complete(self, t: float, w, named, s) -> np.ndarray:
        """s with the states that are not named as switches let them be."""
        room = _numbers(s)
        status = self.library.bg_model_complete(
            self.instance, ctypes.c_double(t), _numbers(w), self._mode(named), room
        )
        assert status == 0, self.message(status)
        return np.array(room)

    def rhs(self, t: float, s, w, signs) -> np.ndarray:
        room = _numbers(np.zeros(self.size))
        status = self.library.bg_model_rhs(
            self.instance, ctypes.c_double(t), _numbers(s), _numbers(w), _numbers(signs), room
        )
        assert status == 0, self.message(status)
        return np.array(room)

    def step(self, t: float, h: float, s, w) -> tuple[int, np.ndarray]:
        """One step; w has three rows."""
        room = _numbers(s)
        status = self.library.bg_model_step(
            self.instance, ctypes.c_double(t), ctypes.c_double(h), room, _numbers(w)
        )
        return status, np.array(room)

    def march(
        self, h: float, count: int, every: int, s, w: np.ndarray
    ) -> tuple[np.ndarray, dict[str, np.ndarray]]:
        """Steps from time 0; w: inputs at every half of one. The modes at their starts, and samples."""
        names = [*self.program.states, *self.program.law_states]
        names += [*self.program.inputs, *self.program.readings]
        ports, kept = len(self.program.friction), count // every + 1
        rows = np.zeros((kept, len(names)))
        modes = np.zeros((count + 1, max(ports, 1)), dtype=np.intc)
        status = self.library.harness_march(
            self.instance, ctypes.c_double(h), count, every, _numbers(s), _numbers(w),
            rows.ctypes.data_as(ctypes.c_void_p), modes.ctypes.data_as(ctypes.c_void_p),
        )  # fmt: skip
        assert status == 0, self.message(status)
        samples = {name.name: rows[:, at] for at, name in enumerate(names)}
        return np.reshape(modes.ravel()[: (count + 1) * ports], (count + 1, ports)), samples

    def timed(
        self, h: float, count: int, every: int, s, w: np.ndarray
    ) -> tuple[int, dict[str, np.ndarray]]:
        """The status, and a sample at every step, where the caller runs all tasks at every so many."""
        names = [*self.program.states, *self.program.law_states]
        names += [*self.program.inputs, *self.program.readings]
        rows = np.zeros((count + 1, len(names)))
        status = self.library.harness_timed(
            self.instance, ctypes.c_double(h), count, every, _numbers(s), _numbers(w),
            rows.ctypes.data_as(ctypes.c_void_p),
        )  # fmt: skip
        return status, {name.name: rows[:, at] for at, name in enumerate(names)}

    def band(self, width: float) -> None:
        self.library.harness_band(self.instance, ctypes.c_double(width))

    def longest(self) -> float:
        """The longest stable step, after a step was refused."""
        self.library.harness_longest.restype = ctypes.c_double
        return float(self.library.harness_longest(self.instance))

    def mode(self) -> tuple[int, ...]:
        room = self._mode([0] * len(self.program.friction))
        self.library.harness_mode(self.instance, room)
        return tuple(room[: len(self.program.friction)])

    def message(self, status: int) -> str:
        return self.library.bg_model_message(status).decode()


class Pair:
    """A model in C and in Python, from the same equations."""

    def __init__(
        self, folder: Path, equations, values, laws=None, level: str = "-O0", on=()
    ) -> None:
        self.equations, self.laws = equations, laws
        sources = written(folder, stepped(to_c(equations, values, laws, initially_on=on)))
        library = compiled(
            folder, [*sources, str(HARNESS)], level, "-shared", "-fPIC", to="model.so"
        )
        self.library = ctypes.CDLL(str(library))
        self.at(values)

    def at(self, values: Mapping[str, object]) -> "Pair":
        """Both at other parameters."""
        self.program = lower(self.equations, self.laws, values)
        self.closed = ClosedModel(self.program, self.equations, values)
        self.c = CModel(self.library, self.program, values)
        assert self.c.status == 0, self.c.message(self.c.status)
        return self
