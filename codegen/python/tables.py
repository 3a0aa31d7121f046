"""The constants at the head of generated Python: names, places in arrays, friction ports, steps."""

from collections.abc import Mapping, Sequence
from typing import Any

from codegen.modes.stability import modes_told
from codegen.modes.steps import round_step, told_step
from codegen.program.records import Program
from codegen.python.text import listing, names_tuple
from codegen.standalone.ranks import SlipRows
from codegen.tuning import TUNING


def public(program: Program) -> list[str]:
    """The names a user of the module works with."""
    states = (*program.states, *program.law_states)
    parts = (("STATES", states), ("INPUTS", program.external), ("OUTPUTS", program.outputs))
    return [line for name, part in parts for line in _names(name, part)]


def places(program: Program) -> list[str]:
    """What the arrays hold, and where."""
    efforts = [
        program.inputs[p.input] if p.slip is None else program.readings[p.slip]
        for p in program.friction
    ]
    lines = [
        "# What the arrays x, u and y of the equations hold, and what a run shows beside its states."
    ]
    parts = (("X", program.states), ("U", program.inputs), ("Y", program.readings))
    lines += [line for name, part in parts for line in _names(name, part)]
    lines += _names("SHOWN", tuple(dict.fromkeys([*program.outputs, *efforts])))
    lines += [
        "",
        "# Places in u of what is given, of what known laws give, of what laws have beyond tangents; in y of",
        "# law states' rates.",
    ]
    lines += [*_places("GIVEN", program.given), *_places("KNOWN", program.known.inputs)]
    lines += _places("BEYOND", program.beyond)
    return [*lines, *_places("LAW_RATES", program.law_rates)]


def _names(name: str, symbols: Sequence[Any]) -> list[str]:
    return names_tuple(name, [symbol.name for symbol in symbols])


def _places(name: str, numbers: Sequence[int]) -> list[str]:
    opening, closing = ("np.array([", "], dtype=int)") if not numbers else ("np.array([", "])")
    return listing(f"{name} = {opening}", [str(number) for number in numbers], closing)


def friction_tables(program: Program, slips: SlipRows) -> list[str]:
    """The friction ports: their names, and where they stand."""
    switches = names_tuple("SWITCHES", [str(port.name) for port in program.switches])
    return [
        *(["", "# Ports that are ideal switches.", *switches] if program.guarded else ()),
        "",
        "# Friction ports, the inputs they give, the slips they receive, by tangents of laws and as they",
        "# are, what tells how the factors of these move; is a resistance beside?",
        *names_tuple("FRICTION", [str(port.name) for port in program.friction]),
        *_places("FRICTION_INPUTS", [port.input for port in program.friction]),
        *_places("FRICTION_READINGS", [port.reading for port in program.friction]),
        *_places("FRICTION_RECEIVED", [port.received for port in program.friction]),
        *_places(
            "FRICTION_MOVING", [-1 if p.moving is None else p.moving for p in program.friction]
        ),
        *names_tuple("BESIDE", [slips.coupled(port) for port in range(len(program.friction))]),
    ]


def slip_rows(slips: SlipRows) -> list[str]:
    """What the ports receive, from which the ranks of what holds them are worked out."""
    note = "What ports receive, F x + D u, in residues modulo a prime; what they give, and laws these move."
    lines = [f"# {note}", "SLIPS = SlipRows("]
    for name, rows in (("F", slips.F), ("D", slips.D)):
        body = [line for row in rows for line in listing("{", _entries(row), "},", 8)]
        lines += [f"    {name}=(", *body, "    ),"]
    lines += listing("own=[", map(str, slips.own), "],", 4)
    lines += listing("moved=[", (str(tuple(one)) for one in slips.moved), "],", 4)
    return [*lines, f"    prime={slips.prime},", ")"]


def _entries(row: Mapping[int, int]) -> list[str]:
    return [f"{column}: {value}" for column, value in row.items()]


def step_settings(longest: float, ports: int) -> list[str]:
    """What there is to say of fixed steps; ``longest``: the longest stable one at the start [s]."""
    usual = round_step(min(TUNING.usual_step, longest / 2))
    return [
        "",
        f"# The longest step [s] that is stable at the start, in {modes_told(ports)}; the usual one.",
        f"LONGEST_STEP = {told_step(longest)!r}".replace("e+", "e"),
        f"STEP = {usual!r}",
    ]
