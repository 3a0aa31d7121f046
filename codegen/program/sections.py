"""The sections of a program: matrices, groups of laws and their rates, ports that are held or let go."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from types import MappingProxyType

import sympy as sp

from bondgraph.algebra.exact import rows_of
from bondgraph.algebra.expressions import TIME
from bondgraph.equations import StateEquations
from bondgraph.nodes.laws import SLIP, DryFriction, ExpressionLaw, Law
from bondgraph.reduce.impulses import Momenta, momenta
from bondgraph.reduce.record import Reading
from codegen.program.closing import Closing
from codegen.program.records import FrictionPort, Group, Pattern, Step, block
from codegen.program.sliding import Slider, halves_of
from codegen.program.slopes import slope
from codegen.standalone.switchings import Clock, Reset, Switching


def coefficients(
    equations: StateEquations,
) -> tuple[list[sp.Expr], Mapping[str, Pattern]]:
    """The nonzero entries of all matrices in one list, and where each stands."""
    expressions: list[sp.Expr] = []
    layout: dict[str, Pattern] = {}
    for name in "AJBE":
        matrix = getattr(equations, name)
        entries = sorted(matrix.todok().items())
        expressions += [entry for _, entry in entries]
        layout[name] = _pattern(matrix.shape, [place for place, _ in entries])
    n, m, rows = len(equations.states), len(equations.inputs), list(equations.readings.values())
    for name, width in (("F", n), ("D", m), ("H", n), ("K", m)):
        found = [
            (i, j, entry)
            for i, reading in enumerate(rows)
            for j, entry in sorted(getattr(reading, name).items())
        ]
        expressions += [entry for *_, entry in found]
        layout[name] = _pattern((len(rows), width), [(i, j) for i, j, _ in found])
    return expressions, MappingProxyType(layout)


def exchanges(equations: StateEquations, told: Mapping[sp.Symbol, Reading]) -> Momenta:
    """What impulses exchange, of states and of readings; nothing where slopes in A stay as they are.

    ``equations``: before ports are closed; ``told``: the readings then.
    """
    if not equations.switches:
        return Momenta((), {})
    found = momenta(
        equations.switches, equations.reduction, rows_of(equations.A), equations.readings,
        {name: (one, equations.signals[name]) for name, one in told.items() if name in equations.signals},
    )  # fmt: skip
    return Momenta((), {}) if found is None else found


def _pattern(shape: tuple[int, int], places: Sequence[tuple[int, int]]) -> Pattern:
    return Pattern(shape, tuple(i for i, _ in places), tuple(j for _, j in places))


def group(
    closing: Closing, names: Sequence[sp.Symbol], loop: bool, taken: Iterable[sp.Symbol]
) -> Group:
    """Laws that are evaluated together, as a block."""
    inputs = tuple(closing.equations.inputs.index(name) for name in names)
    expressions = [expression(closing.laws[name]) for name in names]
    ports = tuple(closing.port_names[name] for name in names)
    known = list(closing.equations.readings)
    readings = tuple(known.index(closing.received[name]) for name in names)
    return Group(inputs, ports, readings, loop, block(expressions, taken))


def uses(closing: Closing, name: sp.Symbol) -> tuple[int, ...]:
    """Which external inputs a law uses."""
    used = closing.laws[name].free_symbols
    return tuple(at for at, external in enumerate(closing.external) if external in used)


def known_rates(closing: Closing, rates: Sequence[sp.Symbol]) -> list[sp.Expr]:
    """The rate of each known law: its slope in time and along the external inputs."""
    result = []
    for name in closing.known:
        law = expression(closing.laws[name])
        signals = {*closing.external, TIME}
        result.append(slope(law, TIME, signals))
        for external, rate in zip(closing.external, rates, strict=True):
            result[-1] += slope(law, external, signals) * rate
    return result


def expression(law: Law) -> sp.Expr:
    """What a law gives that is no friction."""
    if not isinstance(law, ExpressionLaw):
        raise TypeError(f"{law} is not an expression")
    return law.expression


def friction(
    closing: Closing,
    moving: Mapping[sp.Symbol, sp.Symbol],
    along: Mapping[sp.Symbol, sp.Symbol],
    shapes: Mapping[sp.Symbol, sp.Symbol],
) -> tuple[tuple[FrictionPort, ...], list[sp.Expr]]:
    """Ports that are held or let go; level, breakaway level, curve and curve at rest of each in turn.

    Those of switches, which have no limit and let go give nothing, are zero and one; of friction that
    gives a flow the limit is its level, so that it is seen not to be negative. ``moving``: of ports
    whose slips' factors move the reading that tells how fast, by the input that each gives; ``along``: the
    readings along tangents of laws; ``shapes``: those whose ranks count instead of jumps' own.
    """
    readings, inputs = list(closing.equations.readings), closing.equations.inputs
    switching, conditions = switches(closing)
    called = {port.given: port.element.switch for port in closing.equations.ports}
    sliders = {half.given: one for one in closing.sliders for half in one.halves}
    mixed = {jump.mixture: inputs.index(jump.offset) for jump in closing.jumps}
    second = (jump.mixture for jump in closing.jumps if jump.hangs is not None)
    hung = {name: len(conditions) + at for at, name in enumerate(second)}
    ports: list[FrictionPort] = []
    values: list[sp.Expr] = []
    for name in closing.friction:
        law = closing.laws[name]
        if not isinstance(law, DryFriction):
            continue
        received, switch, slider = closing.received[name], called.get(name), sliders.get(name)
        ports.append(
            FrictionPort(
                closing.port_names[name] if switch is None else switch.name,
                inputs.index(name),
                readings.index(along.get(name, received)),
                switching.get(name),
                readings.index(moving[name]) if name in moving else None,
                None if slider is None else inputs.index(slider.level),
                None if slider is None else readings.index(slider.port.given),
                readings.index(shapes.get(name, received)) if name in along else None,
                mixed.get(name),
                hung.get(name),
                None if switch is None else switch.transition,
            )
        )
        curves = [law.curve.subs(SLIP, slip) for slip in (sp.Abs(received), 0)]
        limit = law.breakaway * law.level if slider is None else _checked_level(closing, slider)
        values += [law.level, limit, *curves]
    return tuple(ports), values


def hung_on(closing: Closing) -> list[sp.Expr]:
    """What jumps of second order hang on: guards that follow the conditions of switches."""
    return [jump.hangs for jump in closing.jumps if jump.hangs is not None]


def _checked_level(closing: Closing, slider: Slider) -> sp.Expr:
    """A slider's level, which must not be negative; zero where it is known only with what friction gives."""
    equations = closing.equations
    late = {*closing.friction, *closing.coupled}
    late |= {name for names, _ in closing.order[closing.early :] for name in names}
    columns = {equations.inputs.index(name) for name in late}
    read = slider.whole.free_symbols
    told = {*read, slider.level} & late
    rows = [equations.readings[name].D for name in read & set(equations.readings)]
    return sp.Integer(0) if told or any(columns & set(row) for row in rows) else slider.whole


def switches(closing: Closing) -> tuple[dict[sp.Symbol, Switching], list[sp.Expr]]:
    """When each switch changes over, by the input that it gives; and the conditions of those that say.

    Of a stop these are its gap and its restitution.
    """
    found: dict[sp.Symbol, Switching] = {}
    conditions: list[sp.Expr] = []
    numbers: dict[Hashable, int] = {}
    for one in closing.equations.switches:
        on = one.held == "on"
        if one.gap is not None:
            own = list(closing.law_states).index(one.displacement)
            found[one.port.given] = Switching(
                on, one.side, len(conditions), place=len(closing.equations.states) + own,
                opening=one.opening, bound=one.switch.stops,
            )  # fmt: skip
            conditions += [one.gap, one.switch.restitution]
        elif one.side:
            found[one.port.given] = Switching(on, one.side)
        else:
            machine = 0
            if (taken := one.switch.transition) is not None:
                machine = numbers.setdefault(taken.machine.name, len(numbers) + 1)
            found[one.port.given] = Switching(on, 0, len(conditions), machine=machine)
            conditions += [one.on, one.off]
    for half in halves_of(closing.sliders).values():
        found[half.given] = Switching(True, -half.way, slides=True)
    return found, conditions


def reset_values(closing: Closing) -> list[sp.Expr]:
    """What states become as switches change over, in the order of `resets`."""
    equations = closing.equations
    told = [
        *(port.switch.resets for port in equations.switches),
        *(t.resets for t in equations.tasks),
    ]
    return [one.value for group in told for one in group]


def steps(closing: Closing, found: Sequence[Reset], first: int) -> tuple[Step, ...]:
    """The Python functions of tasks; what they read stands among the guards from ``first`` on."""
    made: list[Step] = []
    for clock, task in enumerate(closing.equations.tasks):
        if task.step is None:
            continue
        own = [one for one in found if one.port == -1 - clock]
        sets = {state.name: r.value for state, r in zip(task.states, own, strict=True)}
        reads = {name.name: first + at for at, name in enumerate(task.reads)}
        first += len(task.reads)
        made.append(Step(clock, task.step, MappingProxyType(reads), MappingProxyType(sets)))
    return tuple(made)


def read_by_steps(closing: Closing) -> list[sp.Expr]:
    """What they read, in the order of `steps`."""
    return [name for task in closing.equations.tasks if task.step for name in task.reads]


def resets(closing: Closing, ports: Sequence[FrictionPort], first: int) -> tuple[Reset, ...]:
    """Which state becomes which of these values, the ``first`` of which stands there, and when."""
    states = [*closing.equations.states, *closing.law_states]
    at = {port.input: place for place, port in enumerate(ports)}
    found: list[Reset] = []
    for one in closing.equations.switches:
        place = at[closing.equations.inputs.index(one.port.given)]
        switching = ports[place].switch
        assert switching is not None
        for reset in one.switch.resets:
            sign = switching.sign(reset.event == "on")
            value = first + len(found)
            found.append(Reset(place, sign, states.index(reset.state), value))
    for clock, task in enumerate(closing.equations.tasks):
        for reset in task.resets:
            found.append(Reset(-1 - clock, 0, states.index(reset.state), first + len(found)))
    return tuple(found)


def clocks(closing: Closing) -> tuple[Clock, ...]:
    """The instants of each task."""
    tasks = closing.equations.tasks
    return tuple(Clock(float(one.every), float(one.offset), float(one.unit)) for one in tasks)
