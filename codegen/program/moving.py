"""Slips whose factors move: how fast they change beside their terms, as readings of their own.

Of ``y = F x + D u`` with factors that change in time the rate is ``F x' + D u' + F' x + D' u``; the last two
terms (``F' x`` behind a crank) are one more signal over states and inputs, their rates put in.
"""

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType

import sympy as sp

from bondgraph.errors import StructureError
from bondgraph.reduce.motion import Motion
from bondgraph.reduce.record import Reading, ReadingSum
from codegen.program.closing import Closing

PREFIX = "moving_"
"""What such a reading is called, with the slip; no result shows it."""


def with_moving_slips(
    closing: Closing, moved: Mapping[sp.Symbol, Reading]
) -> tuple[Closing, dict[sp.Symbol, sp.Symbol]]:
    """The laws over equations that know these readings; and these, by the input that each port gives.

    ``moved``: what laws that a slip sees add to that beside their tangents.

    Raises `StructureError` where a factor moves with what a law gives.
    """
    equations, motion = closing.equations, closing.equations.reduction.motion
    readings, found = dict(equations.readings), dict[sp.Symbol, sp.Symbol]()
    for given in closing.friction:
        received = closing.received[given]
        result = ReadingSum(moved.get(given))
        if motion is not None:
            factors = _rate_of_factors(closing, motion, equations.readings[received])
            _check(closing, given, factors)
            result.add(factors, sp.Integer(1))
        reading = result.whole()
        if not any(reading.parts):
            continue
        name = sp.Symbol(f"{PREFIX}{received}")
        while name in readings or name in equations.signals:
            name = sp.Symbol(f"{name}_")
        readings[name], found[given] = reading, name
    told = replace(equations, readings=MappingProxyType(readings))
    return replace(closing, equations=told), found


def _rate_of_factors(closing: Closing, motion: Motion, reading: Reading) -> Reading:
    equations = closing.equations
    answering = {*closing.friction, *closing.coupled}
    result = ReadingSum()
    for column, factor in sorted(reading.F.items()):
        motion.add_rate(result, factor, equations.states[column])
    for column, factor in sorted(reading.D.items()):
        name, part = equations.inputs[column], ReadingSum()
        motion.add_rate(part, factor, name)
        # What a port gives at once would multiply rates that it changes itself; `ExactSlips.bent` has these.
        if name not in answering or not (part.H or part.K):
            result.add(part.whole(), sp.Integer(1))
    return result.whole()


def _check(closing: Closing, given: sp.Symbol, reading: Reading) -> None:
    laws = set(closing.laws) - set(closing.known)
    used = {s for part in reading.parts for entry in part.values() for s in entry.free_symbols}
    for name in sorted(used & laws, key=str):
        raise StructureError(
            f"the slip at {closing.port_names[given]!r} is a sum of speeds whose factors change with {name}, "
            "which a law gives: put a storage between, or use a smooth law"
        )
