"""The sizes that the C engine is compiled for, its library, and its arrays as numpy sees them."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from bondgraph.errors import SimulationError
from codegen.c.runtime import SHARED, runtime_file, runtime_names
from codegen.engine.build import FLAGS, compiled, loaded
from codegen.numbers.arrays import Array
from codegen.tuning import tuning_text

PAUSED = ("run_paused.h", "run_paused.c", "exact_paused.h", "exact_paused.c")
"""What steps runs from outside."""

MOST_MODES, FEW_MODES = 81, 27
"""So many modes of a model are kept in C at a time; of one with more than .."""

FEW_PORTS = 16
""".. so many ports, whose modes are large."""

DIGITS = 32
"""Ports of which a word tells the mode, two bits for each."""

ALIGNMENT = 64
"""Of arrays that the engine works on, in bytes; a power of two."""


@dataclass(frozen=True)
class Sizes:
    """What ``config.h`` says: lengths of s, x and u, external inputs, ports, slots, resets, clocks."""

    N: int
    X: int
    U: int
    W: int
    K: int
    G: int
    R: int = 0
    C: int = 0

    @property
    def config(self) -> str:
        """The generated header."""
        named = {**vars(self), "MODES": self.numbers["MODES"]}
        lines = ",\n".join(f"    EX_{name} = {value}" for name, value in named.items())
        guard = "#ifndef EXACT_SIZES_H\n#define EXACT_SIZES_H\n"
        ports = f"#ifndef BG_PORTS\n#define BG_PORTS {max(self.K, 1)}\n#endif\n"
        ports += f"#ifndef BG_RESETS\n#define BG_RESETS {self.R}\n#endif\n"
        ports += f"#ifndef BG_CLOCKS\n#define BG_CLOCKS {self.C}\n#endif\n"
        return f"/* The sizes of one model. */\n{guard}{ports}enum {{\n{lines}\n}};\n#endif\n"

    @property
    def numbers(self) -> dict[str, int]:
        """Every size that declarations use."""
        ports = max(self.K, 1)
        most = MOST_MODES if self.K <= FEW_PORTS else FEW_MODES
        row = -(-(self.N + self.G + 4 * self.K) // 4) * 4
        shot = -(-(self.X + self.U + 4 * ports + self.N) // 4) * 4
        length = self.N + 2 * self.W + 1
        return {
            **vars(self), "MODES": min(3**self.K, most), "PORTS": ports, "ROW": row,
            "SHOT": shot, "WORDS": -(-ports // DIGITS), "L": length,
            "SHARP": 1 if self.K else length, "MOST_RESETS": max(self.R, 1),
            "MOST_CLOCKS": max(self.C, 1),
        }  # fmt: skip


@dataclass(frozen=True)
class Engine:
    """A compiled engine: cffi's interface and the library."""

    sizes: Sizes
    ffi: Any
    library: Any

    def new(self, what: str) -> Any:
        """A zeroed record, alive as long as it is referred to."""
        return self.ffi.new(f"{what} *")

    def copy(self, record: Any) -> Any:
        """A record like one that there is."""
        room = self.ffi.new_allocator(should_clear_after_alloc=False)
        made = room(self.ffi.typeof(record))
        self.ffi.memmove(made, record, self.ffi.sizeof(record[0]))
        return made

    def context(self) -> tuple[Array, Any]:
        """Room for runs, one at a time, and where it is."""
        room = self.ffi.new("unsigned long[5]")
        self.library.ex_sizes(room)
        context = aligned(room[0] // 8 + 1)
        context[:] = 0.0
        pointer = self.ffi.cast("ex_context *", context.ctypes.data)
        self.library.ex_forget(pointer)
        return context, pointer


def sources() -> dict[str, str]:
    """The engine's files, name to text."""
    names = (*SHARED, *runtime_names("run"), *runtime_names("exact"), *PAUSED)
    return {"tuning.h": tuning_text(), **{name: runtime_file(name) for name in names}}


@cache
def engine(wanted: Sizes, flags: tuple[str, ...] = FLAGS) -> Engine:
    """The engine of these sizes, compiled if need be."""
    library = compiled({**sources(), "config.h": wanted.config}, flags)
    ffi, opened = loaded(library, engine_declarations(wanted.numbers))
    expected = ffi.new("unsigned long[5]")
    opened.ex_sizes(expected)
    here = [ffi.sizeof(name) for name in ("ex_model", "ex_mode", "ex_chains")]
    if [*here, 8 * wanted.numbers["ROW"]] != list(expected)[1:]:
        raise SimulationError(f"the library {library} was compiled for other sizes; delete it")
    return Engine(wanted, ffi, opened)


def aligned(*shape: int) -> Array:
    """An array of doubles, not set, that begins where vectors may."""
    count = int(np.prod(shape))
    room = np.empty(count + ALIGNMENT // 8)
    first = -room.ctypes.data % ALIGNMENT // 8
    return room[first : first + count].reshape(shape)


def view(engine: Engine, field: Any, *shape: int) -> Array:
    """An array of doubles inside a record, without a copy."""
    array: Array = np.frombuffer(engine.ffi.buffer(field), dtype=np.float64)
    return array.reshape(shape) if shape else array


def engine_declarations(numbers: Mapping[str, int]) -> str:
    """What the engine is asked with, as cffi reads it."""
    shared = declarations("port_switch.h", {}) + declarations("port_events.h", {})
    return shared + declarations("exact.h", numbers) + declarations("exact_paused.h", numbers)


def declarations(header: str, numbers: Mapping[str, int], prefix: str = "EX") -> str:
    """A header as cffi reads it: without comments, and with its sizes as numbers."""
    text = runtime_file(header)
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
    text = "\n".join(line for line in text.splitlines() if not line.startswith("#"))
    text = re.sub(r"enum \{.*?\};", "", text, count=1, flags=re.DOTALL)
    for name, value in numbers.items():
        text = re.sub(rf"\b{prefix}_{name}\b", str(value), text)
    return text
