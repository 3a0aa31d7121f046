"""Rates and instants of several runs at once, in straight-line code that compilers turn into vectors."""

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp

from bondgraph.algebra.expressions import TIME
from codegen.c.blocks import body, function, places
from codegen.c.constants import expanded, needed
from codegen.c.rhs import Builder, is_straight
from codegen.c.text import comment, integers
from codegen.program.layout import RATE, widths
from codegen.program.records import Block, Program

LANES = 8
"""So many runs go side by side: as many doubles as the widest vectors of today's processors hold."""

MOST_STATES, MOST_HELD = 40, 512
"""Beyond these sizes runs go one after the other: a lane's numbers would no longer be near at hand."""


@dataclass(frozen=True)
class Lanes:
    """``rates``, and everything at an instant in the order of its parts, ``look``.

    ``constants``: names of what parameters determine, ``hoisted``, and of the entries of A^-1 at ``inverses``;
    ``signs``: of friction's directions; ``held``: of a held port's effort the factors of states, inputs and
    rates of outside inputs, port by port; ``changes``: the rates of these inputs.
    """

    rates: Block
    look: Block
    constants: tuple[sp.Symbol, ...]
    hoisted: tuple[sp.Expr, ...]
    inverses: tuple[tuple[int, int], ...]
    signs: tuple[sp.Symbol, ...]
    held: tuple[sp.Symbol, ...]
    changes: tuple[sp.Symbol, ...]


def lanes(program: Program) -> Lanes | None:
    """Code for runs side by side, or None for a program whose runs go one after the other.

    Those are of affine programs, which have exact steps, and of those in which more happens than that friction
    sticks and slips, or something is solved for or looked up in a table.
    """
    plain = is_straight(program) and not program.affine and program.corners is None
    rubs = all(
        port.switch is None and not port.jumps and port.moving is None and port.plain is None
        for port in program.friction
    )
    more = (
        *program.delayed, *program.clocks, *program.resets, *program.guards.results,
        *program.coupled.inputs, *program.tables, *program.turnings, *program.momenta.results,
    )  # fmt: skip
    wide = len(program.states) + len(program.inputs) + len(program.given)
    few = program.size <= MOST_STATES and len(program.friction) * wide <= MOST_HELD
    return _Builder(program).lanes() if plain and rubs and not more and few else None


class _Builder(Builder):
    """The same assignments with friction that may hold, and all that an instant has."""

    def lanes(self) -> Lanes:
        program, wide = self._program, self._wide
        new, ports = self._constants.new, range(len(program.friction))
        self._changes = [new(f"change_{at}") for at in program.given]
        self._held = [[new(f"held_{i}_{j}") for j in range(wide)] for i in ports]
        rates = self._rates_of_all() or [sp.S.Zero]
        look = self._instant(rates)
        inverses = self._places()
        names = (*self._constants.names.values(), *(self._inverses[one] for one in inverses))
        return Lanes(
            needed(self._assignments, rates), needed(self._assignments, look), names,
            tuple(self._constants.names), tuple(inverses), self._signs,
            tuple(one for row in self._held for one in row), tuple(self._changes),
        )  # fmt: skip

    @property
    def _wide(self) -> int:
        program = self._program
        return len(program.states) + len(program.inputs) + len(program.given)

    def _friction(self) -> None:
        """What slips rubs, and what is held gives what holds it: of each port one of these is zero."""
        super()._friction()
        program, given = self._program, dict(self._given)
        entries, outside = self._entries["D"], set(program.given)
        rated = {j for port in program.friction for j, _ in entries.get(port.reading, []) if j in outside}
        changes = [one if at in rated else sp.S.Zero for at, one in zip(program.given, self._changes, strict=True)]
        for port in program.friction:
            given[port.input] = self._renamed(program.inputs[port.input])
        for port, row in zip(program.friction, self._held, strict=True):
            names = [*program.states, *(given.get(j, sp.S.Zero) for j in range(len(program.inputs)))]
            terms = zip(row, [*names, *changes], strict=True)
            effort = sp.Add(given[port.input], *(factor * one for factor, one in terms))
            self._assignments.append((program.inputs[port.input], effort))

    def _renamed(self, name: sp.Symbol) -> sp.Symbol:
        """A name of its own for what is assigned so."""
        own = self._constants.new(f"rub_{name.name}")
        self._assignments = [(own if one == name else one, value) for one, value in self._assignments]
        return own

    def _instant(self, rates: list[sp.Expr]) -> list[sp.Expr]:
        """The parts of an instant, one after the other."""
        program, known = self._program, {name for name, _ in self._assignments}
        changes = [sp.S.Zero] * len(program.inputs)  # which no signal shows
        values = expanded(program.friction_values)
        self._read(values[1::4])
        readings = [
            name if name in known else self._row(at, "F", "D")
            for at, name in enumerate(program.readings)
        ]
        caps = [self._constants.hoisted(value) for value in values[1::4]]
        inputs = [self._given.get(at, sp.S.Zero) for at in range(len(program.inputs))]
        return [*program.states, *program.law_states, *inputs, *changes, *readings, *rates, *caps]


def lanes_text(program: Program, code: Lanes) -> dict[str, str]:
    """The files that are written for a model: name to text."""
    used = {name for value in code.hoisted for name in value.free_symbols}
    hoisted = Block(tuple(one for one in program.parameters if one in used), (), code.hoisted)
    rows, columns = (tuple(place[at] for place in code.inverses) for at in (0, 1))
    lines = [
        "/* Rates and instants of several runs at once; written by bondgraph-toolkit. */",
        '#include "lanes.h"', '#include "lanes_functions.h"',
        *function("lanes_hoisted", "What parameters determine", hoisted, places(program)), "",
        *integers("lanes_rows", rows, local=True), *integers("lanes_columns", columns, local=True), "",
        "void bg_lanes_prepare(bg_model *m, double *constants)", "{",
        "    lanes_hoisted(&m->now, constants);",
        f"    bg_inverse_entries(m, {len(rows)}, lanes_rows, lanes_columns,",
        f"                       constants + {len(code.hoisted)});", "}",
        *_function("bg_lanes_rates", "The rates of s", code.rates, code, program),
        *_function("bg_lanes_look", "Everything at an instant", code.look, code, program),
    ]  # fmt: skip
    rated = bool({*code.changes} & {*code.rates.arguments})
    sizes = {"CONSTANTS": len(code.constants), "HELD": len(code.held), "RATED": int(rated)}
    head = ["/* Sizes of runs side by side; written by bondgraph-toolkit. */",
            "#ifndef BG_LANES_CONFIG_H", "#define BG_LANES_CONFIG_H", "",
            f"#define BG_LANES {LANES}",
            *(f"#define BG_LANE_{key} {value}" for key, value in sizes.items()), "", "#endif", ""]  # fmt: skip
    return {"lanes_config.h": "\n".join(head), "lanes_model.c": "\n".join(lines) + "\n"}


def _function(name: str, what: str, block: Block, code: Lanes, program: Program) -> list[str]:
    """A block as a function of all lanes."""
    lines = body(block, _where(code, program), "out", "lanes", "[l]")
    return [
        "", *comment(f"{what}: {block.operations} operations a lane."),
        f"void {name}(const bg_lanes_own *restrict own, const bg_lanes_at *restrict at,",
        f"{' ' * len(name)}      const bg_lane *restrict s, bg_lane *restrict out)", "{",
        "    (void)own, (void)at, (void)s;",
        "    for (int l = 0; l < BG_LANES; l++) {", *(f"    {line}" for line in lines), "    }", "}",
    ]  # fmt: skip


def _where(code: Lanes, program: Program) -> Mapping[sp.Symbol, str]:
    """Where the values of a lane stand."""
    found: dict[sp.Symbol, str] = {TIME: "at->t[l]"}
    for at, name in enumerate((*program.states, *program.law_states)):
        found.setdefault(name, f"s[{at}][l]")
    for at, name in enumerate(program.external):
        found.setdefault(name, f"at->w[{at}][l]")
    for at, name in zip(program.given, code.changes, strict=True):
        found[name] = f"at->dw[{program.external.index(program.inputs[at])}][l]"
    for part in ("constants", "signs", "held"):
        names = getattr(code, part)
        found |= {name: f"own->{part}[{at}][l]" for at, name in enumerate(names)}
    return found


def instant_width(program: Program) -> int:
    """How many numbers `bg_lanes_look` gives a lane."""
    return sum(widths(program)[: RATE + 2])
