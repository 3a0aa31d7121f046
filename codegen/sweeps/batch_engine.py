"""One library of a generated model, the engine and the loop over runs; and room to run in."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bondgraph import SimulationError
from codegen.c.export import runtime_file
from codegen.engine.build import FLAGS, compiled, loaded
from codegen.engine.sizes import Engine, Sizes, aligned, declarations, sources
from codegen.program import Program

FILES = (
    "batch.h", "batch.c", "batch_internal.h", "batch_mode.c", "batch_measure.c",
    "batch_model.h", "batch_model.c",
)  # fmt: skip

CAPACITY = 256
"""Events of a run; one with more is done without the loop."""

MOST_MODES = 27
"""Of one run."""


def batch_engine(
    model: Mapping[str, str], program: Program, wanted: Sizes, flags: tuple[str, ...] = FLAGS
) -> Engine:
    """The library for a model that `codegen.to_c` wrote, compiled if need be."""
    files = {**model, **sources(), **{name: runtime_file(name) for name in FILES}}
    files["config.h"] = _config(model["config.h"], program, wanted)
    library = compiled(files, flags)
    numbers = wanted.numbers
    text = declarations("bg_engine.h", numbers)
    text += declarations("batch.h", {"MODES": min(numbers["MODES"], MOST_MODES)}, "BATCH")
    for name in ("MODES", "ROW", "L"):
        text = text.replace(f"[BG_{name}]", f"[{numbers[name]}]")
    ffi, opened = loaded(library, text)
    found = ffi.new("unsigned long[3]")
    opened.batch_sizes(found)
    if [ffi.sizeof("batch_room"), ffi.sizeof("batch_reader")] != list(found)[:2]:
        raise SimulationError(f"the library {library} was compiled for other sizes; delete it")
    return Engine(wanted, ffi, opened)


def _config(model: str, program: Program, wanted: Sizes) -> str:
    """Both headers in one: the names of the engine's sizes are not those of the model's."""
    shared = {
        "STATES": len(program.states), "LAW_STATES": len(program.law_states),
        "INPUTS": len(program.inputs), "EXTERNAL": len(program.external),
        "READINGS": len(program.readings), "PARAMETERS": len(program.parameters),
    }  # fmt: skip
    lines = ",\n".join(f"    BATCH_{name} = {value}" for name, value in shared.items())
    return f"#ifdef BG_ENGINE_H\n{wanted.config}enum {{\n{lines}\n}};\n#else\n{model}#endif\n"


@dataclass
class Room:
    """Where one thread does its runs; keeps all that the record points to."""

    engine: Engine
    samples: int
    signals: int
    record: Any = field(init=False)
    kept: list[Any] = field(init=False, default_factory=list)

    def __post_init__(self) -> None:
        ffi, numbers = self.engine.ffi, self.engine.sizes.numbers
        sizes = ffi.new("unsigned long[3]")
        self.engine.library.batch_sizes(sizes)
        self.record = self.engine.new("batch_room")
        context, pointer = self.engine.context()
        self.kept.append(context)
        self.record.context = pointer
        self.record.capacity = CAPACITY
        width = numbers["ROW"]
        for name, kind, array in (
            ("model", "void *", aligned(sizes[2] // 8 + 1)),
            ("rows", f"double(*)[{width}]", aligned(self.samples, width)),
            ("modes", "int *", np.empty(self.samples, dtype=np.intc)),
            ("values", "double *", np.empty(self.samples)),
            ("given", "double *", np.empty(self.samples * 2 * numbers["W"])),
        ):
            self._point(name, kind, array)
        for name, kind, count in (
            ("events", "bg_event[]", CAPACITY),
            ("readers", "batch_reader[]", MOST_MODES * max(self.signals, 1)),
        ):
            made = ffi.new(kind, count)
            self.kept.append(made)
            setattr(self.record, name, made)

    def _point(self, name: str, kind: str, array: NDArray[Any]) -> None:
        self.kept.append(array)
        setattr(self.record, name, self.engine.ffi.cast(kind, array.ctypes.data))
