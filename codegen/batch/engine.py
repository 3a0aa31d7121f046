"""One library of a generated model, the engine and the loop over runs; and room to run in."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from numpy.typing import NDArray

from bondgraph.errors import SimulationError
from codegen.c.runtime import runtime_file
from codegen.engine.build import FLAGS, compiled, loaded
from codegen.engine.runs import NO_END
from codegen.engine.sizes import Engine, Sizes, aligned, declarations, engine_declarations, sources

FILES = (
    "batch.h", "batch_internal.h", "batch.c", "batch_advance.c", "batch_doubt.h", "batch_gauss.h",
    "batch_integral.c", "batch_leap.c",
    "batch_measure.h", "batch_measure.c",
    "batch_fastest.c", "batch_mode.c", "batch_mode_switches.c", "batch_model.h", "batch_model.c",
    "batch_signal.c", "batch_table.c",
)  # fmt: skip

CAPACITY = 256
"""Events of a run; one with more is done without the loop."""

STRIDE = 8
"""Steps that are taken from one state."""

SQUARES = 4
"""Matrices that integrals are worked out in."""


def batch_engine(model: Mapping[str, str], wanted: Sizes, flags: tuple[str, ...] = FLAGS) -> Engine:
    """The library for a model that `codegen.to_c` wrote, compiled if need be."""
    files = {**model, **sources(), **{name: runtime_file(name) for name in FILES}}
    files["config.h"] = model["config.h"] + wanted.config
    library = compiled(files, flags)
    numbers = wanted.numbers
    text = engine_declarations(numbers)
    shared = {"STRIDE": STRIDE, "SQUARES": SQUARES}
    text += declarations("batch_measure.h", {}) + declarations("batch.h", shared, "BATCH")
    for name in ("MODES", "ROW", "L", "WORDS"):
        text = text.replace(f"[EX_{name}]", f"[{numbers[name]}]")
    ffi, opened = loaded(library, text)
    found = ffi.new("unsigned long[5]")
    opened.batch_sizes(found)
    if ffi.sizeof("batch_room") != found[0]:
        raise SimulationError(f"the library {library} was compiled for other sizes; delete it")
    return Engine(wanted, ffi, opened)


def room_for_events(eventful: bool) -> int:
    """How many events a run may have; where no measure asks for them, they are not kept."""
    return CAPACITY if eventful else NO_END


@dataclass
class Room:
    """Where one thread does its runs; keeps all that the record points to."""

    engine: Engine
    samples: int
    signals: int
    factors: int
    products: int
    #: Whether a measure asks for events.
    eventful: bool
    record: Any = field(init=False)
    kept: list[Any] = field(init=False, default_factory=list)

    def __post_init__(self) -> None:
        ffi, numbers, signals = self.engine.ffi, self.engine.sizes.numbers, max(self.signals, 1)
        readers = numbers["MODES"] * (signals + self.factors)
        sizes = ffi.new("unsigned long[5]")
        self.engine.library.batch_sizes(sizes)
        _, model, table, of_signal, tables = sizes
        self.record = self.engine.new("batch_room")
        context, self.record.context = self.engine.context()
        self.kept.append(context)
        self.record.capacity, self.record.pitch = (
            room_for_events(self.eventful),
            self.samples + STRIDE,
        )
        events = ffi.new("bg_event[]", CAPACITY) if self.eventful else ffi.NULL
        self.kept.append(events)
        self.record.events = events
        for name, kind, array in (
            ("model", "void *", aligned(model // 8 + 1)),
            (
                "readers",
                f"double(*)[{numbers['L']}]",
                aligned(readers, numbers["L"]),
            ),
            ("tables", "double *", aligned(tables * (table + signals * of_signal))),
            ("values", "double *", aligned(signals, self.record.pitch)),
            ("levels", "double *", aligned(signals)),
            ("totals", "double *", aligned(self.products + 1)),
            ("squares", "double *", aligned(SQUARES * (numbers["N"] + numbers["G"] + 1) ** 2)),
            ("constants", f"double(*)[{STRIDE}]", aligned(4 * numbers["K"] + signals, STRIDE)),
        ):
            self._point(name, kind, array)

    def _point(self, name: str, kind: str, array: NDArray[Any]) -> None:
        self.kept.append(array)
        setattr(self.record, name, self.engine.ffi.cast(kind, array.ctypes.data))
