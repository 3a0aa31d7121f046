"""What a program is made of: straight-line code, patterns of matrices, groups of laws."""

from collections.abc import Container, Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.algebra.lookups import Handle
from bondgraph.declare.inner import inner_names
from bondgraph.equations import StateEquations
from bondgraph.inverses.inverse import Turning
from bondgraph.nodes.tasks import Called, Transition
from bondgraph.tables.record import Sampled
from codegen.standalone.switchings import Clock, Reset, Switching

TEMPORARY = "c"
"""Temporaries are c0, c1, ...; names that are taken are passed over."""


@dataclass(frozen=True)
class Block:
    """Straight-line code: results from arguments, by way of named temporaries."""

    arguments: tuple[sp.Symbol, ...]
    assignments: tuple[tuple[sp.Symbol, sp.Expr], ...]
    results: tuple[sp.Expr, ...]

    @property
    def operations(self) -> int:
        """Additions, products and functions, each assignment once."""
        return sum(int(sp.count_ops(value)) for value in self.values)

    @property
    def values(self) -> list[sp.Expr]:
        """Every expression in it."""
        return [*(value for _, value in self.assignments), *self.results]


@dataclass(frozen=True)
class Pattern:
    """Where the nonzero entries of a matrix stand, in the order of the results that hold them."""

    shape: tuple[int, int]
    rows: tuple[int, ...]
    columns: tuple[int, ...]


@dataclass(frozen=True)
class Group:
    """Laws evaluated together: the inputs they give; ``loop`` if they depend on one another."""

    inputs: tuple[int, ...]
    ports: tuple[Hashable, ...]
    #: For each law the reading that its port receives.
    readings: tuple[int, ...]
    loop: bool
    values: Block


@dataclass(frozen=True)
class FrictionPort:
    """A port that is held or let go: its node, the input it gives and the reading it receives.

    ``switch``: of an ideal switch, when it changes over; None where it is dry friction. ``moving``: the
    reading that tells how fast the slip changes by its factors, None where these are constant.
    ``plain``: the reading that it receives as the graph has it, where ``reading`` is the same along the
    tangents of laws; else None. ``level``, ``slip``: of one way of friction that gives a flow (backwards
    follows forwards), the input that is its level and the reading that is its whole slip. ``offset``: of
    a jump of a law, which is friction, too, the input that is part of what it hangs on. ``hung``: of one of
    second order, which receives how fast that changes, the guard that is what it hangs on. ``transition``:
    of a switch that a state machine takes one by, that.
    """

    name: Hashable
    input: int
    reading: int
    switch: Switching | None = None
    moving: int | None = None
    level: int | None = None
    slip: int | None = None
    plain: int | None = None
    offset: int | None = None
    hung: int | None = None
    transition: Transition | None = None

    @property
    def received(self) -> int:
        """The reading that it receives as the graph has it."""
        return self.reading if self.plain is None else self.plain

    @property
    def in_c(self) -> tuple[int, int, int, int, int, int, int, int, int, int]:
        """The fields of its ``bg_switch``: kind, on while held?, side, first condition, way of slipping.

        Then those of a stop: the place of its displacement, how its gap opens with that, whether it is
        declared as one; of the jump of a law its order; of a transition which state machine's.
        """
        one = self.switch
        if one is None:
            return 0, 0, 0, self.hung or 0, 0, 0, 0, 0, self.order, 0
        kind = 3 if one.stops else 1 if one.side else 2
        place = max(one.place, 0)
        guard = max(one.guard, 0)
        told = one.opening, int(one.bound), 0, one.machine
        return kind, int(one.on), one.side, guard, self.way, place, *told

    @property
    def words(self) -> tuple[str, str, str]:
        """What it is when it comes to hold, lets go, and goes the other way at once; "" is not told."""
        return ("slide", "leave", "") if self.jumps else ("stick", "slip", "cross")

    @property
    def jumps(self) -> bool:
        """Whether it is the jump of a law."""
        return self.offset is not None

    @property
    def order(self) -> int:
        """Of the jump of a law which derivative of what it hangs on it moves, 1 or 2; of others 0."""
        return 0 if not self.jumps else 1 if self.hung is None else 2

    @property
    def slides(self) -> bool:
        """Whether it is one way in which dry friction slips that gives a flow."""
        return self.switch is not None and self.switch.slides

    @property
    def way(self) -> int:
        """Of such friction 1 for its way forwards, -1 for that backwards; 0 of other ports."""
        return -self.switch.side if self.switch is not None and self.switch.slides else 0


@dataclass(frozen=True)
class TableEnds:
    """The ends of a table that refuses what is outside, along one axis, among the corners.

    ``sides``: the places of those that tell the stretch, as `region_of` takes them; ``last``: the number of
    the stretch beyond the upper end.
    """

    name: str
    argument: sp.Expr
    ends: tuple[float, float]
    sides: tuple[int, ...]
    last: int


@dataclass(frozen=True)
class Corners:
    """Where laws have corners or jump: at the zeros of what these hang on.

    ``sides``: of each the name of its side, 1 where that is above zero, -1 below. ``nodes``: whose law it
    is. ``values``: what each hangs on, and 1 for each, by the laws as they are; ``on_sides``: the same with
    what they hang on, too, on one side of each of its own, and 0 for those that sides leave no part in.
    ``blocks``: those of a program, in their order, with laws on one side of each corner.
    """

    sides: tuple[sp.Symbol, ...]
    nodes: tuple[Hashable, ...]
    values: Block
    blocks: tuple[Block, ...]
    on_sides: Block
    #: What runs must not go beyond.
    ends: tuple[TableEnds, ...] = ()


@dataclass(frozen=True)
class Step:
    """A Python function that tells what the task of a clock sets: from values by name to values by name.

    ``reads`` and ``sets``: the places among the guards of what it reads, and of what it tells.
    """

    clock: int
    function: Called
    reads: Mapping[str, int]
    sets: Mapping[str, int]


@dataclass(frozen=True)
class Program:
    """Everything a simulator needs, as assignments; numbered as in the tuples of names.

    ``coefficients``: parameters to the nonzero entries of the matrices in ``layout``: A, J, B, E over
    states and inputs, and F, D, H, K with a row for each reading, ``F x + D u + H x' + K u'``.
    ``known``: laws of time, parameters and external inputs; ``known_rates`` their rates. ``groups``:
    the other laws in an order in which each can be evaluated, the first ``early`` of them before friction,
    which the rest only read. ``friction_values``: level, breakaway
    level, curve and curve at rest of each friction port in turn. ``coupled``: laws to be
    solved with the friction.
    """

    parameters: tuple[sp.Symbol, ...]
    states: tuple[sp.Symbol, ...]
    law_states: tuple[sp.Symbol, ...]
    #: For each law state the reading that is its rate.
    law_rates: tuple[int, ...]
    inputs: tuple[sp.Symbol, ...]
    #: Inputs that a run must be given, those of laws included.
    external: tuple[sp.Symbol, ...]
    #: Expressions of time and parameters that the last of these are; users do not give them.
    sources: tuple[sp.Expr, ...]
    #: The rates of external inputs, for known laws.
    external_rates: tuple[sp.Symbol, ...]
    readings: tuple[sp.Symbol, ...]
    outputs: tuple[sp.Symbol, ...]
    coefficients: Block
    layout: Mapping[str, Pattern]
    known: Group
    #: For each known law the external inputs that it uses.
    known_uses: tuple[tuple[int, ...], ...]
    known_rates: Block
    groups: tuple[Group, ...]
    early: int
    friction: tuple[FrictionPort, ...]
    friction_values: Block
    coupled: Group
    #: Whether the friction efforts have to be solved for together, with the coupled laws.
    joint: bool
    #: Readings that a step must not turn into an impulse: outputs, and what laws read.
    read: tuple[int, ...]
    #: Conditions of switches, to turn on and to turn off in turn: each changes over above zero.
    guards: Block
    #: What changes states over with them; these values come after the conditions.
    resets: tuple[Reset, ...]
    #: The instants at which tasks set what they set.
    clocks: tuple[Clock, ...]
    #: Python functions that tell what tasks set; only numpy calls them.
    steps: tuple[Step, ...]
    #: What impulses exchange where they move slopes in A: of each state, then of these readings.
    momenta: Block
    momenta_rows: tuple[int, ...]
    #: Of each delay in turn what it reads, how late it is [s], and what it gives before.
    delaying: Block
    #: Whether all conditions are affine, as long as everything else is.
    guards_affine: bool
    #: Whether all that tasks set is.
    ticks_affine: bool
    #: Whether coefficients change in time, with states, external inputs or the time itself.
    varying: bool
    #: Whether each friction mode is an affine system with constant coefficients, and no law reads what ports
    #: that are held or let go give.
    affine: bool
    #: Inputs that held ports' readings along tangents of laws are written with.
    beyond: tuple[int, ...]
    #: Inputs that are what laws with jumps give beside these.
    smooth: tuple[int, ...]
    #: Readings that jumps hang on.
    hung: tuple[int, ...]
    #: The equations over these inputs, which know all of these readings.
    equations: StateEquations = field(repr=False, compare=False)
    #: Where laws have corners, of a program that is run with these located; else None.
    corners: Corners | None = None

    @property
    def size(self) -> int:
        """The length of the integrated vector; at least 1, so that integrators have something."""
        return max(len(self.states) + len(self.law_states), 1)

    @property
    def late(self) -> bool:
        """Whether laws read what friction and switches give, which do not need these laws."""
        return self.early < len(self.groups)

    @property
    def blocks(self) -> tuple[Block, ...]:
        """Every block that a target evaluates."""
        laws = (group.values for group in (self.known, *self.groups, self.coupled))
        told = (self.known_rates, self.friction_values, self.guards, self.momenta)
        return (self.coefficients, *laws, *told)

    @cached_property
    def tables(self) -> tuple[Sampled, ...]:
        """What is looked into, by name."""
        found = {part.table for one in self._values() for part in one.atoms(Handle)}
        return tuple(sorted(found, key=lambda table: table.name))

    @cached_property
    def turnings(self) -> tuple[Turning, ...]:
        """The laws that are turned round by a search, by their names."""
        found = {part for one in self._values() for part in one.atoms(Turning)}
        return tuple(sorted(found, key=lambda turning: turning.code))

    def _values(self) -> Iterator[sp.Expr]:
        """All that is evaluated."""
        sided = () if self.corners is None else (self.corners.values, self.corners.on_sides)
        yield from (
            value for code in (*self.blocks, *sided, self.delaying) for value in code.values
        )
        yield from self.sources

    @property
    def sides(self) -> tuple[sp.Symbol, ...]:
        """The sides of corners that are located."""
        return () if self.corners is None else self.corners.sides

    @property
    def happening(self) -> tuple[Hashable, ...]:
        """Where events happen, as C counts it: at ports or state machines, then at nodes with corners."""
        corners = () if self.corners is None else self.corners.nodes
        ports = (port.name if one is None else one.machine.name for port, one in self._ports_taken)
        return (*ports, *corners)

    @property
    def taken(self) -> Mapping[int, str]:
        """By the places of ports the transitions of state machines that are taken as these turn on."""
        found = enumerate(self._ports_taken)
        return {at: one.words for at, (_, one) in found if one is not None}

    @property
    def transitions(self) -> tuple[Transition, ...]:
        """The transitions of state machines, in declaration order."""
        return tuple(port.transition for port in self.friction if port.transition is not None)

    @property
    def _ports_taken(self) -> list[tuple[FrictionPort, Transition | None]]:
        return [(port, port.transition) for port in self.friction]

    @cached_property
    def nodes(self) -> tuple[Hashable, ...]:
        """Where events may be asked for: the graph's nodes, and the ports of its fields."""
        ports = (port.element.name for port in self.equations.reduction.structure.ports)
        return tuple(dict.fromkeys([*self.equations.elements, *ports, *self.happening]))

    @property
    def corners_told(self) -> bool:
        """Whether states, external inputs and the time alone tell what corners hang on."""
        if self.corners is None or (not self.varying and self.layout["E"].rows):
            return False
        known = {*self.states, *self.law_states, *self.external, TIME}
        known |= {*self.parameters, *self.sides}
        read = {*self.corners.values.arguments, *self.corners.on_sides.arguments}
        return known >= read

    @cached_property
    def on_sides(self) -> "Program":
        """The same with laws on one side of each corner, which ``sides`` tell."""
        if self.corners is None:
            return self
        coefficients, known, *more = self.corners.blocks
        groups, (coupled, rates, friction, guards) = more[:-4], more[-4:]
        return replace(
            self, coefficients=coefficients, known=replace(self.known, values=known),
            groups=tuple(replace(g, values=v) for g, v in zip(self.groups, groups, strict=True)),
            coupled=replace(self.coupled, values=coupled), known_rates=rates,
            friction_values=friction, guards=guards,
            corners=replace(self.corners, values=self.corners.on_sides),
        )  # fmt: skip

    @property
    def moving(self) -> tuple[int, ...]:
        """The ports whose slips have factors that move."""
        return tuple(i for i, port in enumerate(self.friction) if port.moving is not None)

    @property
    def shown(self) -> tuple[int, ...]:
        """The readings that results show."""
        hidden = {port.moving for port in self.friction}
        hidden |= {port.received for port in self.friction if port.slides or port.jumps}
        hidden |= {*self.hung}
        hidden |= {port.reading for port in self.friction if port.plain is not None}
        return tuple(at for at in range(len(self.readings)) if at not in hidden)

    @property
    def shown_inputs(self) -> tuple[int, ...]:
        """The inputs that results show: not a slider's ways of slipping and level, nor ``beyond``."""
        hidden = {at for p in self.friction if p.slides for at in (p.input, p.level)}
        hidden |= {*self.beyond, *self.smooth}
        hidden |= {at for p in self.friction if p.jumps for at in (p.input, p.offset)}
        return tuple(at for at in range(len(self.inputs)) if at not in hidden)

    @cached_property
    def inner(self) -> frozenset[str]:
        """Names of parts of nodes of signals: results give them by name and do not list them."""
        return inner_names(self.equations.elements.values())

    @property
    def switches(self) -> tuple[FrictionPort, ...]:
        """The ports that are ideal switches, but for those by which state machines take transitions."""
        return tuple(p for p in self.told_by_guards if p.transition is None)

    @property
    def told_by_guards(self) -> tuple[FrictionPort, ...]:
        """The ports that are ideal switches, all of them."""
        return tuple(p for p in self.friction if p.switch is not None and not p.slides)

    @property
    def switched(self) -> bool:
        """Whether any port is a switch, or slips one way as one."""
        return any(port.switch is not None for port in self.friction)

    @property
    def hanging(self) -> tuple[tuple[int, int], ...]:
        """The ports that are jumps of second order, with the guards that they hang on."""
        return tuple((i, p.hung) for i, p in enumerate(self.friction) if p.hung is not None)

    @property
    def guarded(self) -> bool:
        """Whether more than slips and efforts tells what any port does."""
        return self.switched or bool(self.hanging)

    @property
    def stopped(self) -> bool:
        """Whether any port is a stop."""
        return any(port.switch is not None and port.switch.stops for port in self.friction)

    def before(self, on: Container[Hashable]) -> tuple[int, ...]:
        """The mode of each port before a run: these switches on, the others off, friction let go.

        What stops do their gaps tell; before they do, they are apart.
        """
        return tuple(
            1 if (one := port.switch) is None else one.sign(one.stops or port.name in on)
            for port in self.friction
        )

    @property
    def events(self) -> tuple[Reset, ...]:
        """What ports set as they change over, or as stops are hit."""
        return tuple(one for one in self.resets if one.port >= 0)

    @property
    def ticks(self) -> tuple[Reset, ...]:
        """What tasks set at instants of their own."""
        return tuple(one for one in self.resets if one.port < 0)

    @property
    def restitution_given(self) -> bool:
        """Whether parameters alone tell the restitutions of stops."""
        told = [one.switch.restitution for one in self.equations.switches if one.gap is not None]
        return all(one.free_symbols <= {*self.parameters} for one in told)

    @property
    def rated_inputs(self) -> frozenset[int]:
        """The inputs whose rates are known, or told by what moves a slip."""
        told = {port.input for port in self.friction}
        return frozenset({*self.given, *self.known.inputs, *told, *self.beyond})

    @property
    def given(self) -> list[int]:
        """The places among the inputs of those external inputs that are some."""
        return [self.inputs.index(name) for name in self.external if name in self.inputs]

    @cached_property
    def rated(self) -> bool:
        """Whether anything asks for the rates of the external inputs: where values move, any bond may."""
        moved = self.varying or bool(self.equations.reduction.energies)
        return moved or any(self.layout[letter].rows for letter in "EDHK")

    @property
    def asked(self) -> tuple[sp.Symbol, ...]:
        """The external inputs that are no known sources."""
        return self.external[: len(self.external) - len(self.sources)]

    @property
    def delayed(self) -> tuple[sp.Symbol, ...]:
        """Those of them that delays give, one after the other."""
        late = {one.given for one in self.equations.delays}
        return tuple(name for name in self.asked if name in late)

    @property
    def wanted(self) -> tuple[sp.Symbol, ...]:
        """The others, which a run is given by its user."""
        delayed = self.delayed
        return tuple(name for name in self.asked if name not in delayed)


def block(expressions: Sequence[sp.Expr], taken: Iterable[sp.Symbol] = ()) -> Block:
    """Straight-line code for expressions, each common subexpression computed once."""
    expressions = [sp.sympify(expr) for expr in expressions]
    used: set[sp.Symbol] = set()
    for expr in expressions:
        used |= expr.free_symbols
    avoided = {name.name for name in used} | {name.name for name in taken}
    temporaries = (name for name in sp.numbered_symbols(TEMPORARY) if name.name not in avoided)
    assignments, results = sp.cse(expressions, symbols=temporaries, order="none")
    arguments = tuple(sorted(used, key=str))
    return Block(arguments, tuple(assignments), tuple(results))


def stepped_in_python(program: Program) -> str:
    """Which task a Python function steps, for a refusal; an empty text where none does.

    >>> from codegen import lower
    >>> import bondgraph as bg
    >>> graph = bg.graph([bg.Function("r", "u"), bg.Controller("c", every=1, gives=["u"], step=dict)])
    >>> stepped_in_python(lower(bg.derive(graph)))
    "the step of controller 'c' is a Python function"
    """
    for step in program.steps:
        name = program.equations.tasks[step.clock].name
        return f"the step of controller {name!r} is a Python function"
    return ""
