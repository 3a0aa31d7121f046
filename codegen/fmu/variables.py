"""The variables of a functional mock-up unit: their names, what they are, where they start."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import sympy as sp

from bondgraph.equations import StateEquations
from codegen.fmu.tabled import arrays_of, scalars_of
from codegen.fmu.variable import Variable
from codegen.model.commands import conditions_told
from codegen.program.records import Program
from codegen.program.units import units

STEP = "fixed_internal_step"
"""The parameter that is the length of co-simulation's fixed steps [s]; 0: events are located."""


@dataclass(frozen=True)
class Starts:
    """Where parameters, states and inputs start; ``sources``: external inputs with sources inside.

    ``named``: whether each state was. ``step``: what co-simulation may be stepped by [s].
    """

    parameters: tuple[float, ...]
    states: tuple[float, ...]
    named: tuple[bool, ...]
    inputs: tuple[float, ...]
    sources: frozenset[int]
    step: float


def moved(program: Program) -> bool:
    """Whether inputs drive dependent storages, so that the integrated vector is not the states."""
    return bool(program.layout["E"].rows) and not program.varying


def variables(
    program: Program, equations: StateEquations, starts: Starts, indicators: int, version: str
) -> tuple[Variable, ...]:
    """All variables, names made unique; those of the model come before those that are made up.

    ``version``: of FMI; 2.0 has no arrays, so there a table is a parameter for each of its values, and
    one of more than `TUNING.most_scalars` is a constant.
    """
    listing = _Listing(program, units(equations), starts)
    listing.known(arrays=version != "2.0")
    listing.unknown()
    listing.made_up(indicators)
    return tuple(_described(one, program, equations) for one in listing.found)


def _described(one: Variable, program: Program, equations: StateEquations) -> Variable:
    """With when switches change over, at switches and at the inputs that they go by."""
    told = {switch.name: conditions_told(switch) for switch in equations.plain_switches}
    texts: list[str] = []
    if one.kind == "FMU_SWITCH":
        texts = [
            f"1 on, 0 off; {told[name]}"
            for name in [program.friction[one.index].name]
            if told[name]
        ]
    elif one.kind == "FMU_INPUT":
        symbol = program.external[one.index]
        texts = [
            f"switch {switch.name} {told[switch.name]}"
            for switch in equations.plain_switches
            if told[switch.name] and symbol in switch.on.free_symbols | switch.off.free_symbols
        ]
    return replace(one, description=plain(". ".join(texts))) if texts else one


class _Listing:
    """Variables in the order of their value references."""

    def __init__(self, program: Program, unit: Mapping[sp.Symbol, str], starts: Starts) -> None:
        self.found: list[Variable] = []
        self._program, self._unit, self._starts = program, unit, starts
        self._moved = moved(program)
        self._places: dict[sp.Symbol, int] = {}
        symbols = [*program.parameters, *program.states, *program.law_states, *program.external]
        symbols += [*program.inputs, *program.readings]
        self._reserved = {plain(symbol.name) for symbol in symbols}
        self._used: set[str] = set()

    def known(self, arrays: bool) -> None:
        """Time, parameters, tables, inputs and where states start."""
        program, starts = self._program, self._starts
        self._made("time", "FMU_TIME", causality="independent", initial=None, unit="s")
        kept = "fixed" if self._moved else "tunable"
        for at, (symbol, value) in enumerate(
            zip(program.parameters, starts.parameters, strict=True)
        ):
            self._named(
                symbol, "FMU_PARAMETER", at, "parameter", variability=kept, initial="exact",
                start=value,
            )  # fmt: skip
        self._tables(kept, arrays)
        self._made(
            STEP, "FMU_INTERNAL_STEP", causality="parameter", variability="fixed", initial="exact",
            start=0.0, unit="s",
        )  # fmt: skip
        free = [at for at in range(len(program.external)) if at not in starts.sources]
        for at in free:
            self._named(
                program.external[at], "FMU_INPUT", at, "input", initial=None,
                start=starts.inputs[at],
            )  # fmt: skip
        for at in free if program.rated else []:
            name = f"der({program.external[at].name})"
            self._made(name, "FMU_SLOPE", at, causality="input", initial=None, start=0.0)
        for at, symbol in enumerate((*program.states, *program.law_states)):
            self._named(symbol, "FMU_STATE", at, initial="exact", start=starts.states[at])

    def _tables(self, kept: str, arrays: bool) -> None:
        """The values of tables, and their axes, under names that the model leaves free."""
        tables = self._program.tables
        for one in arrays_of(tables) if arrays else scalars_of(tables):
            name = self._free(plain(one.name), self._used | self._reserved)
            tuned = kept if one.causality == "parameter" else "constant"
            self.found.append(replace(one, name=name, variability=tuned))

    def unknown(self) -> None:
        """Readings, outputs among them, and what laws and sources give."""
        program = self._program
        hidden = {port.received for port in program.friction if port.slides}
        hidden |= {port.reading for port in program.friction if port.plain is not None}
        for at, symbol in enumerate(program.readings):
            if at in hidden:
                continue
            shown = "output" if symbol in program.outputs else "local"
            place = self._places.get(symbol)
            if place is None:
                self._named(symbol, "FMU_READING", at, shown)
            elif shown == "output" and self.found[place].causality == "local":
                self.found[place] = replace(self.found[place], causality=shown)
            elif shown == "output":
                self._made(symbol.name, "FMU_READING", at, causality=shown)
        for at in sorted(self._starts.sources):
            self._named(program.external[at], "FMU_SOURCE", at)
        for at in program.shown_inputs:
            symbol = program.inputs[at]
            if symbol not in self._places:
                self._named(symbol, "FMU_GIVEN", at)

    def made_up(self, indicators: int) -> None:
        """The integrated vector where it is none of the states, its rates, modes and indicators."""
        program = self._program
        symbols = (*program.states, *program.law_states)
        places = [self._places[symbol] for symbol in symbols]
        for at, symbol in enumerate(program.states if self._moved else ()):
            places[at] = len(self.found)
            self._made(f"integrated({symbol.name})", "FMU_VECTOR", at)
        for at, (symbol, place) in enumerate(zip(symbols, places, strict=True)):
            unit = self._unit.get(symbol)
            rate = f"{unit}/s" if unit else ""
            base = self.found[place].name
            self._made(f"der({base})", "FMU_RATE", at, derivative=place, unit=rate)
        for at, port in enumerate(program.friction):
            if port.switch is None or port.slides:
                kind = "FMU_SLIDES" if port.slides else "FMU_MODE"
                if port.way >= 0:
                    self._made(f"mode({port.name})", kind, at, variability="discrete")
            elif port.transition is None:
                self._made(str(port.name), "FMU_SWITCH", at, variability="discrete")
        for at in range(indicators):
            self._made(f"event_indicator({at + 1})", "FMU_INDICATOR", at)

    def _named(
        self, symbol: sp.Symbol, kind: str, index: int, causality: str = "local",
        variability: str = "continuous", initial: str | None = "calculated",
        start: float | None = None,
    ) -> None:  # fmt: skip
        """A variable under a name of the model's."""
        self._places[symbol] = len(self.found)
        name = self._free(plain(symbol.name), self._used)
        unit = self._unit.get(symbol, "")
        self.found.append(Variable(name, kind, index, causality, variability, initial, start, unit))

    def _made(
        self, name: str, kind: str, index: int = 0, causality: str = "local",
        variability: str = "continuous", initial: str | None = "calculated",
        **more: Any,
    ) -> None:  # fmt: skip
        """A variable under a name that the model leaves free."""
        name = self._free(plain(name), self._used | self._reserved)
        self.found.append(Variable(name, kind, index, causality, variability, initial, **more))

    def _free(self, name: str, taken: set[str]) -> str:
        while name in taken:
            name += "_"
        self._used.add(name)
        return name


def plain(name: str) -> str:
    """A name without characters that XML's attributes do not keep.

    >>> plain("a\\tb\\x00 c")
    'a_b_ c'
    """
    text = "".join(one if _kept(one) else "_" for one in name)
    return text or "_"


def _kept(one: str) -> bool:
    return one == " " or (one.isprintable() and not one.isspace())
