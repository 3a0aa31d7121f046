"""The constants at the head of generated Python: names, places in arrays, friction ports."""

from collections.abc import Mapping, Sequence
from typing import Any

from bondgraph.equations import StateEquations
from codegen.modes.stability import FARTHEST, IMAGINARY_LIMIT, NEAREST, REAL_LIMIT
from codegen.ports.slips import moved_laws
from codegen.program.records import Program
from codegen.python.sticking import beside_resistance
from codegen.python.text import listing, names_tuple
from codegen.runs.steps import round_step, told_step
from codegen.tuning import TUNING

Held = Mapping[tuple[int, ...], tuple[int, int]]
"""Ranks of sets of sticking ports, as `sticking_ranks` gives them."""


def flags(program: Program, equations: StateEquations, held: Held) -> dict[str, bool]:
    """Which sections of the fixed part the model needs; ``shared``: ports that are redundant, or rest though
    other inputs rule them; ``moved``: ports whose efforts move laws."""
    return {
        "friction": bool(program.friction),
        "shared": any(sum(ranks) < len(ports) for ports, ranks in held.items()),
        "joint": program.joint,
        "moved": any(moved for moved in moved_laws(program, equations)),
        "loops": program.joint or any(group.loop for group in program.groups),
        "varying": program.varying,
    }


def units(equations: StateEquations) -> dict[str, str]:
    """The units that elements tell, by the name of what they give."""
    units: dict[str, str] = {}
    known = {*equations.states, *equations.inputs}
    for element in equations.elements.values():
        for symbol in (element.given, element.effort, element.flow):
            if element.unit and symbol is not None and symbol in known:
                units.setdefault(symbol.name, f"[{element.unit}]")
    return units


def public(program: Program) -> list[str]:
    """The names a user of the module works with."""
    states = (*program.states, *program.law_states)
    parts = (("STATES", states), ("INPUTS", program.external), ("OUTPUTS", program.outputs))
    return [line for name, part in parts for line in _names(name, part)]


def places(program: Program) -> list[str]:
    """What the arrays hold, and where."""
    efforts = [program.inputs[port.input] for port in program.friction]
    given = [program.inputs.index(n) for n in program.external if n in program.inputs]
    lines = [
        "# What the arrays x, u and y of the equations hold, and what a run shows beside its states."
    ]
    parts = (("X", program.states), ("U", program.inputs), ("Y", program.readings))
    lines += [line for name, part in parts for line in _names(name, part)]
    lines += _names("SHOWN", tuple(dict.fromkeys([*program.outputs, *efforts])))
    lines += [
        "",
        "# Places in u of what is given and of what known laws give; in y of law states' rates.",
    ]
    lines += [*_places("GIVEN", given), *_places("KNOWN", program.known.inputs)]
    return [*lines, *_places("LAW_RATES", program.law_rates)]


def _names(name: str, symbols: Sequence[Any]) -> list[str]:
    return names_tuple(name, [symbol.name for symbol in symbols])


def _places(name: str, numbers: Sequence[int]) -> list[str]:
    opening, closing = ("np.array([", "], dtype=int)") if not numbers else ("np.array([", "])")
    return listing(f"{name} = {opening}", [str(number) for number in numbers], closing)


def friction_tables(program: Program, equations: StateEquations, held: Held) -> list[str]:
    """The friction ports, how sets of them are held, and the settings of loops."""
    lines, needed = [""], flags(program, equations, held)
    if program.friction:
        lines += [
            "# Friction ports, the inputs they give, the slips they receive; is a resistance beside?"
        ]
    lines += names_tuple("FRICTION", [str(port.name) for port in program.friction])
    if program.friction:
        lines += _places("FRICTION_INPUTS", [port.input for port in program.friction])
        lines += _places("FRICTION_READINGS", [port.reading for port in program.friction])
        beside = [str(one) for one in beside_resistance(program, equations)]
        lines += listing("BESIDE = np.array([", beside, "])")
        lines += [
            "# Sets of sticking ports that D_ss holds in part, or of which some are redundant: both ranks."
        ]
        lines += listing("HELD = {", [f"{ports}: {ranks}" for ports, ranks in held.items()], "}")
        lines += [
            "# A slip below this fraction of the terms that make it up counts as zero.",
            "ROUNDING = 1e-9",
            "# A friction level below zero by no more than this fraction of its terms counts as zero.",
            "LEVEL_ROUNDING = 1e-10",
        ]
    if needed["shared"]:
        lines += [
            "# Entries below this fraction of the largest are rounding where ports share a load.",
            "NOTHING = 1e-11",
        ]
    if program.joint:
        lines += ["# Laws that depend on friction, and what their ports receive."]
        lines += _places("COUPLED", program.coupled.inputs)
        lines += _places("COUPLED_READINGS", program.coupled.readings)
    if needed["moved"]:
        lines += [
            "# For each friction port the places in u of the laws that its effort moves at once."
        ]
        lines += listing("MOVED = [", [f"{[*one]}" for one in moved_laws(program, equations)], "]")
    if needed["loops"]:
        lines += [
            "",
            "# Loops of laws: what counts as solved, and the most steps of each kind of search.",
        ]
        lines += [
            "LOOP_RESIDUAL = 1e-9",
            "LOOP_STEPS = 60",
            "LOOP_HALVES = 60",
            "LOOP_BRACKETS = 200",
        ]
    return lines


def step_settings(longest: float) -> list[str]:
    """What there is to say of fixed steps; ``longest``: the longest stable one at the start [s]."""
    usual = round_step(min(TUNING.usual_step, longest / 2))
    return [
        "",
        "# The longest step [s] that is stable at the start, in every friction mode; the usual one.",
        f"LONGEST_STEP = {told_step(longest)!r}",
        f"STEP = {usual!r}",
        "# Whether each step is checked for stability, at two evaluations more; rounds of two before",
        "# the first, and before a refusal.",
        "CHECK_STEP = True",
        "FIRST_ROUNDS, REFUSED_ROUNDS = 4, 16",
        "# Where the method is stable: |step * rate| on the negative and on the imaginary axis, the",
        "# least and the largest. Differences in magnitudes of the states; rounds in the mean growth.",
        f"REAL_LIMIT, IMAGINARY_LIMIT = {abs(REAL_LIMIT)!r}, {IMAGINARY_LIMIT!r}",
        f"NEAREST, FARTHEST = {NEAREST}, {FARTHEST}",
        "DIFFERENCE, AVERAGED = 1e-7, 8",
    ]
