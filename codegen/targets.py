"""What a target is: something that writes a model so that it runs outside the toolkit.

A target is a folder of `codegen` with the same roles as ``c``, ``python`` and ``fmu``: names and blocks
(a program's assignments as text), tables (its numbers), export (the whole), and a file ``target`` with the
object that `codegen.exports.TARGETS` lists.
"""

from collections.abc import Hashable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from bondgraph.equations import StateEquations
from codegen.inputs.signal import Signal
from codegen.numbers.arrays import Array


@dataclass(frozen=True)
class Export:
    """One run to be written: equations, numbers, laws, start, inputs, samples [s], and what it is called.

    ``initially_on``: the switches that are on at first; ``integrator``: the method of fixed steps, as of
    `codegen.to_c`.
    """

    name: str
    equations: StateEquations
    parameters: Mapping[str, object]
    laws: Mapping[Hashable, object]
    initial: Mapping[str, float]
    inputs: Mapping[str, Signal]
    times: Array
    initially_on: tuple[Hashable, ...] = ()
    integrator: str = "rk4"


class Target(Protocol):
    """What writes models; `write` may raise any `BondGraphError`, and then has written nothing."""

    @property
    def name(self) -> str:
        """What it is asked for by, such as "c"."""

    @property
    def following(self) -> str:
        """The line that goes on from there, with ``{folder}``, ``{file}``, ``{path}`` and ``{name}``."""

    @property
    def compiled(self) -> bool:
        """Whether it holds machine code, for ``platforms``."""

    def write(
        self, export: Export, folder: Path, platforms: str | Iterable[str] | None = None
    ) -> list[Path]:
        """Write a run into a folder; the files written, what is to be used last.

        ``platforms``: as of `codegen.write_fmu`, where it is ``compiled``.
        """
