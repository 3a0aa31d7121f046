"""The mode that a linear model is taken in: which ports are held, which give zero, and what holding takes."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from bondgraph.algebra.atoms import normal
from bondgraph.algebra.expressions import expression
from bondgraph.analyse.closed_rows import ClosedRows
from bondgraph.analyse.constrained import echelon
from bondgraph.analyse.holding import split, stuck_ports
from bondgraph.equations import StateEquations
from bondgraph.errors import StructureError
from bondgraph.nodes.laws import DryFriction, ExpressionLaw, Law, slides
from bondgraph.reduce.record import Reading
from bondgraph.reduce.structure import Port

WORDS = {True: ("on", "off"), False: ("stick", "slip")}
"""The modes of switches, and of other ports."""

STOPS = {"apart": "on", "touch": "off"}
"""The same of stops, in the words of their events."""

NEAR = 1e-9
"""A gap that is no longer, beside one and the displacement, does not tell whether a stop touches."""


@dataclass(frozen=True)
class ToldModes:
    """``held``: the ports that receive zero; ``free``: those let go, which give zero.

    Dry friction that gives a flow is held where it slips: its effort is its level.
    """

    held: tuple[Port, ...]
    free: tuple[Port, ...]

    @property
    def ports(self) -> tuple[Port, ...]:
        """Those whose inputs are none of the linear model's."""
        return self.held + self.free

    @property
    def names(self) -> frozenset[Hashable]:
        """Their nodes."""
        return frozenset(port.element.name for port in self.ports)

    @property
    def holding(self) -> str:
        """The held ports, for people."""
        return ", ".join(repr(port.element.name) for port in self.held)

    @property
    def zeros(self) -> dict[sp.Symbol, Law]:
        """What is zero at any operating point of this mode."""
        names = [port.received for port in self.held if port.element.kind.switches]
        return dict.fromkeys(
            [*names, *(port.given for port in self.free)], ExpressionLaw(sp.Integer(0))
        )


def told_modes(
    equations: StateEquations, laws: Mapping[Hashable, Law], stuck: Iterable[Hashable], mode: Any,
    at: Any,
) -> ToldModes:  # fmt: skip
    """Which ports are held and which let go, in the words of events.

    ``laws``: every closed port's. ``at``: the operating point, which tells of a stop off its bound that it is
    apart. Raises `StructureError` for a switch that is told no mode, for a word or a node that there is not,
    and for a port that is told two modes.
    """
    told = _with_places(equations, _checked(equations, mode), at)
    held = stuck_ports(equations, stuck)
    names = {port.element.name for port in held}
    for name, word in told.items():
        if word == "slip" and not isinstance(laws.get(name), DryFriction):
            raise StructureError(f"mode: {name!r} has no dry friction that could slip")
        if word == "slip" and name in names:
            raise StructureError(f"{name!r} is in stuck and slips in mode; leave one of them out")
    sticking = [name for name, word in told.items() if word == "stick" and name not in names]
    held += stuck_ports(equations, sticking)
    sliders = [p for p in equations.ports if slides(laws.get(p.element.name), p.gives)]
    resting = [port for port in sliders if port in held]
    held = [port for port in held if port not in sliders]
    held += [port for port in sliders if port not in resting]
    # No transition lasts.
    told |= {one.name: "off" for one in equations.switches if one.switch.transition is not None}
    missing = [one.name for one in equations.switches if one.name not in told]
    if missing:
        raise StructureError(_untold(equations, missing))
    closed = [one.port for one in equations.switches if told[one.name] == one.held]
    free = [one.port for one in equations.switches if told[one.name] != one.held]
    return ToldModes((*held, *closed), (*free, *resting))


def _untold(equations: StateEquations, missing: Sequence[Hashable]) -> str:
    """What to say of switches that were told no mode; stops have other words and one more way."""
    listed, verb = ", ".join(map(repr, missing)), "is" if len(missing) == 1 else "are"
    places = {one.name: one.displacement for one in equations.switches if one.guard == "stop"}
    if missing[0] not in places:
        return (
            f"a linear model is of one mode: tell whether {listed} {verb} on or off, such as "
            f"mode={{{missing[0]!r}: 'off'}}"
        )
    return (
        f"a linear model is of one mode: tell whether {listed} {verb} apart (on) or touching (off), such as "
        f"mode={{{missing[0]!r}: 'apart'}}; off its bound the number of {places[missing[0]]} in at tells"
    )


def _with_places(
    equations: StateEquations, told: dict[Hashable, str], at: Any
) -> dict[Hashable, str]:
    """The modes with those of stops of which the point tells that they are apart."""
    # What is no mapping is left to whoever looks at the point.
    told_there = at.items() if isinstance(at, Mapping) else ()
    values = {normal(str(name)): value for name, value in told_there}
    found = dict(told)
    for one in equations.switches:
        if one.gap is None or one.displacement is None:
            continue
        reads = one.gap.free_symbols | {one.displacement}
        point = {
            name: expression(values[name.name], f"operating point of {name}")
            for name in reads if name.name in values
        }  # fmt: skip
        gap, place = one.gap.subs(point), sp.sympify(point.get(one.displacement))
        if place is None or not (gap.is_real and gap.is_number and gap > NEAR * (1 + abs(place))):
            continue
        if found.setdefault(one.name, "on") == "off":
            raise StructureError(
                f"mode: {one.name!r} touches its bound ('off'), but at has {one.displacement} = {place}, "
                f"{gap} off it; say 'apart', or leave it out"
            )
    return found


def _checked(equations: StateEquations, mode: Any) -> dict[Hashable, str]:
    """Every node that is told a mode, and the mode, which is one that it has."""
    if mode is None:
        return {}
    if not isinstance(mode, Mapping):
        raise StructureError(
            f"mode must map nodes to 'on', 'off', 'stick' or 'slip', not be {mode!r}"
        )
    switches = {one.name for one in equations.plain_switches}
    stops = {one.name for one in equations.switches if one.switch.stops}
    told: dict[Hashable, str] = {
        name: STOPS[word] if name in stops and word in STOPS else word
        for name, word in mode.items()
    }
    resisting = {p.element.name for p in equations.ports if p.element.kind.resists}
    for name, word in told.items():
        if name not in switches | resisting:
            listed = ", ".join(map(repr, [one.name for one in equations.plain_switches]))
            raise StructureError(
                f"mode: {name!r} is no switch and no port that could stick; there are the switches "
                f"{listed or 'none'} and the ports {', '.join(map(repr, _listed(equations))) or 'none'}"
            )
        words = WORDS[name in switches]
        if word not in words:
            raise StructureError(
                f"mode: {name!r} can be {words[0]!r} or {words[1]!r}, not {word!r}"
            )
    return told


def _listed(equations: StateEquations) -> list[Hashable]:
    return [port.element.name for port in equations.ports if port.element.kind.resists]


@dataclass(frozen=True)
class HeldRows:
    """What is held, ``F x + D v = 0``, less what resistances rule at once.

    ``bound``: rows over states and other inputs; ``tied``: the columns of what then holds them. ``direct``:
    which of the ports tell at once what others, of the columns that are not tied, give.
    """

    bound: tuple[Reading, ...]
    tied: tuple[int, ...]
    direct: tuple[int, ...]


def held_rows(system: ClosedRows, ports: Sequence[Port], laws: Mapping[Hashable, Law]) -> HeldRows:
    """What held ports receive, as rows; where they see one another beside a resistance, what they give
    is put into the system.
    """
    columns = [system.equations.inputs.index(port.given) for port in ports]
    rows = [system.put_in(system.received(port, laws)) for port in ports]
    direct, bound, independent = split(rows, columns)
    D = sp.Matrix(len(direct), len(columns), lambda i, j: direct[i].D.get(columns[j], 0))
    _, pivots = echelon(D)
    if direct:
        system.give([columns[j] for j in pivots], direct, [ports[j] for j in pivots])
    without = [
        Reading(row.F, {j: e for j, e in row.D.items() if j not in columns}, row.H, row.K)
        for row in bound
    ]
    tied = [j for at, j in enumerate(columns) if at not in pivots]
    return HeldRows(tuple(without), tuple(tied), independent)
