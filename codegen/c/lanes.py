"""Rates and instants of several runs at once, in straight-line code that compilers turn into vectors."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import sympy as sp

from bondgraph.algebra.expressions import TIME
from codegen.c.blocks import body, function, places
from codegen.c.constants import expanded, needed
from codegen.c.rhs import Builder, is_straight
from codegen.c.text import comment, integers
from codegen.program.records import Block, Corners, Program

LANES = 8
"""So many runs go side by side: as many doubles as the widest vectors of today's processors hold."""

FEW_STATES = 16
"""So many go by exponential steps: the matrices of more would not be near at hand."""

MOST_STATES, MOST_HELD = 40, 512
"""Beyond these sizes runs go one after the other: a lane's numbers would no longer be near at hand."""


@dataclass(frozen=True)
class Lanes:
    """``rates``, and everything at an instant in the order of its parts, ``look``.

    ``constants``: names of what parameters determine, ``hoisted``, and of the entries of A^-1 at
    ``inverses``; ``signs``: of friction's directions; ``held``: of a held port's effort the factors of
    states, inputs and rates of outside inputs, port by port; ``changes``: the rates of these inputs. Where
    laws have corners it is the code on one side of each, and ``plain`` that of laws as they are.
    """

    rates: Block
    look: Block
    constants: tuple[sp.Symbol, ...]
    hoisted: tuple[sp.Expr, ...]
    inverses: tuple[tuple[int, int], ...]
    signs: tuple[sp.Symbol, ...]
    held: tuple[sp.Symbol, ...]
    changes: tuple[sp.Symbol, ...]
    plain: "Lanes | None" = None

    @property
    def parts(self) -> "tuple[Lanes, ...]":
        """Itself and the code of laws as they are, if there is one."""
        return (self,) if self.plain is None else (self, self.plain)


def lanes(program: Program) -> Lanes | None:
    """Code for runs side by side, or None for a program whose runs go one after the other.

    Those are of affine programs, which have exact steps, and of those in which more happens than that
    friction sticks and slips, or something is solved for or looked up in a table.
    """
    plain = is_straight(program) and is_straight(program.on_sides) and not program.affine
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
    if not plain or not rubs or more or not few:
        return None
    if program.corners is None:
        return _Builder(program).lanes()
    return replace(_Builder(program.on_sides).lanes(), plain=_Builder(program).lanes())


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
        changes = self._changes_read()
        for port in program.friction:
            given[port.input] = self._renamed(program.inputs[port.input])
        for port, row in zip(program.friction, self._held, strict=True):
            names = [
                *program.states,
                *(given.get(j, sp.S.Zero) for j in range(len(program.inputs))),
            ]
            terms = zip(row, [*names, *changes], strict=True)
            effort = sp.Add(given[port.input], *(factor * one for factor, one in terms))
            self._assignments.append((program.inputs[port.input], effort))

    def _changes_read(self) -> list[sp.Expr]:
        """The rates of outside inputs, of which those count that slips are read off themselves."""
        program, entries = self._program, self._entries["D"]
        read = {j for port in program.friction for j, _ in entries.get(port.reading, [])}
        pairs = zip(program.given, self._changes, strict=True)
        return [change if at in read else sp.S.Zero for at, change in pairs]

    def _renamed(self, name: sp.Symbol) -> sp.Symbol:
        """A name of its own for what is assigned so."""
        own = self._constants.new(f"rub_{name.name}")
        self._assignments = [
            (own if one == name else one, value) for one, value in self._assignments
        ]
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
        shown = [*program.states, *program.law_states, *inputs, *changes, *readings, *rates, *caps]
        return shown if program.corners is None else [*shown, *self._hung(program.corners)]

    def _hung(self, corners: Corners) -> list[sp.Expr]:
        """What corners hang on, then whether each counts."""
        values = expanded(corners.values)
        self._read(values)
        return [self._constants.hoisted(value) for value in values]


def lanes_text(program: Program, code: Lanes) -> dict[str, str]:
    """The files that are written for a model: name to text."""
    lines = ["/* Rates and instants of several runs at once; written by bondgraph-toolkit. */",
             '#include "lanes.h"', '#include "lanes_functions.h"']  # fmt: skip
    prepare, first = list[str](), 0
    for name, one in zip(("", "_plain"), code.parts, strict=False):
        lines += _constants(name, one, program)
        count = first + len(one.hoisted)
        prepare += [f"    lanes_hoisted{name}(&m->now, constants + {first});",
                    f"    bg_inverse_entries(m, {len(one.inverses)}, lanes_rows{name}, lanes_columns{name},",
                    f"                       constants + {count});"]  # fmt: skip
        first += len(one.constants)
    plain, begin = (code, 0) if code.plain is None else (code.plain, len(code.constants))
    lines += [
        "", "void bg_lanes_prepare(bg_model *m, double *constants)", "{", *prepare, "}",
        *_function("bg_lanes_rates", "The rates of s", code.rates, _where(code, program)),
        *_function("bg_lanes_look", "Everything at an instant", code.look, _where(code, program)),
        *_function("bg_lanes_plain", "The rates of s by laws as they are", plain.rates,
                   _where(plain, program, begin)),
    ]  # fmt: skip
    rated = bool({*code.changes} & {*code.rates.arguments})
    sizes = {"FEW": FEW_STATES, "CONSTANTS": first, "HELD": len(code.held), "RATED": int(rated)}
    head = [
        "/* Sizes of runs side by side; written by bondgraph-toolkit. */",
        "#ifndef BG_LANES_CONFIG_H", "#define BG_LANES_CONFIG_H", "", f"#define BG_LANES {LANES}",
        *(f"#define BG_LANE_{key} {value}" for key, value in sizes.items()), "", "#endif", "",
    ]  # fmt: skip
    return {"lanes_config.h": "\n".join(head), "lanes_model.c": "\n".join(lines) + "\n"}


def _constants(name: str, code: Lanes, program: Program) -> list[str]:
    """What parameters determine, and which entries of A^-1."""
    used = {one for value in code.hoisted for one in value.free_symbols}
    hoisted = Block(tuple(one for one in program.parameters if one in used), (), code.hoisted)
    rows, columns = (tuple(place[at] for place in code.inverses) for at in (0, 1))
    what = "What parameters determine"
    return [*function(f"lanes_hoisted{name}", what, hoisted, places(program)), "",
            *integers(f"lanes_rows{name}", rows, local=True),
            *integers(f"lanes_columns{name}", columns, local=True)]  # fmt: skip


def _function(name: str, what: str, block: Block, where: Mapping[sp.Symbol, str]) -> list[str]:
    """A block as a function of all lanes."""
    lines = body(block, where, "out", "lanes", "[l]")
    return [
        "", *comment(f"{what}: {block.operations} operations a lane."),
        f"void {name}(const bg_lanes_own *restrict own, const bg_lanes_at *restrict at,",
        f"{' ' * len(name)}      const bg_lane *restrict s, bg_lane *restrict out)", "{",
        "    (void)own, (void)at, (void)s;",
        "    for (int l = 0; l < BG_LANES; l++) {", *(f"    {line}" for line in lines), "    }", "}",
    ]  # fmt: skip


def _where(code: Lanes, program: Program, first: int = 0) -> Mapping[sp.Symbol, str]:
    """Where the values of a lane stand; ``first``: the place of the code's constants."""
    found: dict[sp.Symbol, str] = {TIME: "at->t[l]"}
    for at, name in enumerate((*program.states, *program.law_states)):
        found.setdefault(name, f"s[{at}][l]")
    for at, name in enumerate(program.external):
        found.setdefault(name, f"at->w[{at}][l]")
    for at, name in zip(program.given, code.changes, strict=True):
        found[name] = f"at->dw[{program.external.index(program.inputs[at])}][l]"
    for part, names, begin in (("constants", code.constants, first), ("signs", code.signs, 0),
                               ("held", code.held, 0), ("sides", program.sides, 0)):  # fmt: skip
        found |= {name: f"own->{part}[{begin + at}][l]" for at, name in enumerate(names)}
    return found
