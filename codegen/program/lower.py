"""`lower`: equations and laws as named assignments that every backend prints the same way."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import sympy as sp

from bondgraph.algebra.expressions import TIME, callable_in_text
from bondgraph.equations import StateEquations
from bondgraph.errors import StructureError
from bondgraph.nodes.laws import DryFriction, ExpressionLaw
from codegen.program.affine import is_affine
from codegen.program.closing import Closing, close_ports
from codegen.program.gains import check_gains
from codegen.program.moving import with_moving_slips
from codegen.program.records import Program, block
from codegen.program.sections import (
    clocks,
    coefficients,
    exchanges,
    friction,
    group,
    hung_on,
    known_rates,
    read_by_steps,
    reset_values,
    resets,
    steps,
    switches,
    uses,
)
from codegen.program.tangents import with_tangents
from codegen.program.timed import Sources
from codegen.supplied import supplied


def lower(
    equations: StateEquations,
    laws: Mapping[Any, object] | None = None,
    parameters: Iterable[str] = (),
    timed: bool = False,
) -> Program:
    """Sort names into parameters and inputs, order the laws, and share common subexpressions.

    ``laws``: node (or the input it gives) to the law that closes its port, over those declared.
    ``parameters``: the names that will be given numbers; any other name in a law is an input, and so is
    one in a value beside a parameter.
    ``timed``: what holds the time and parameters alone becomes an input of its own, one of
    ``Program.sources``.

    Raises `ParameterError` if the matrices use a name that is no parameter, `DependentSourceError`
    if a law would have to be differentiated.
    """
    given = set(parameters)
    declared = equations = supplied(equations, laws, given)
    watched = _watched(equations)
    closing = close_ports(equations, {} if laws is None else laws, given, watched)
    closing, tangents = with_tangents(closing)
    closing, moving = with_moving_slips(closing, tangents.moved)
    equations = closing.equations
    _check_varying(closing)
    taken = _all_names(equations, closing) | watched
    expressions, layout = coefficients(equations)
    sources = Sources(closing, given, taken)
    guards = [*switches(closing)[1], *hung_on(closing)]
    first = len(guards)
    told = reset_values(closing)
    guards += [*told, *read_by_steps(closing)]
    own = first + len(told) - sum(len(task.resets) for task in equations.tasks)
    if timed:
        expressions = [sources.parted(entry) for entry in expressions]
        guards = [sources.parted(guard) for guard in guards]
        closing = sources.told(closing)
        taken |= set(closing.external)
    varying = any(name.name not in given for entry in expressions for name in entry.free_symbols)
    rubbing, values = friction(closing, moving, tangents.along, tangents.shapes)
    readings = tuple(equations.readings)
    found = resets(closing, rubbing, first)
    exchanged = exchanges(declared, equations.readings)
    external_rates = _rate_names(closing.external, taken)
    program = Program(
        parameters=tuple(sorted((n for n in taken if n.name in given), key=str)),
        states=equations.states,
        law_states=tuple(closing.law_states),
        law_rates=tuple(readings.index(name) for name in closing.law_states.values()),
        inputs=equations.inputs,
        external=closing.external,
        sources=tuple(sources.found),
        external_rates=external_rates,
        readings=readings,
        outputs=equations.outputs,
        coefficients=block(expressions, taken),
        layout=layout,
        known=group(closing, closing.known, False, taken),
        known_uses=tuple(uses(closing, name) for name in closing.known),
        known_rates=block(known_rates(closing, external_rates), taken),
        groups=tuple(group(closing, names, loop, taken) for names, loop in closing.order),
        early=closing.early,
        friction=rubbing,
        friction_values=block(values, taken),
        coupled=group(closing, closing.coupled, True, taken),
        joint=closing.joint,
        read=_read(closing),
        guards=block(guards, taken),
        resets=found,
        steps=steps(closing, found, first + len(told)),
        clocks=clocks(closing),
        momenta=block([*exchanged.states, *exchanged.readings.values()], taken),
        momenta_rows=tuple(readings.index(name) for name in exchanged.readings),
        delaying=block(_delaying(closing), taken),
        guards_affine=is_affine(guards[:own], given),
        ticks_affine=is_affine(guards[own:], given),
        varying=varying,
        affine=not (varying or moving) and _is_affine(closing, values, given),
        smooth=tuple(equations.inputs.index(one.given) for one in closing.smooth),
        hung=tuple(readings.index(one.depends) for one in closing.jumps),
        beyond=tuple(equations.inputs.index(name) for name in tangents.beyond),
        equations=equations,
    )
    check_gains(program)
    callable_in_text(program.tables, "laws and values")
    return program


def _watched(equations: StateEquations) -> frozenset[sp.Symbol]:
    """The names in conditions, restitutions and resets of switches, and in what tasks set."""
    told = (
        value for p in equations.ports if (s := p.element.switch)
        for value in (s.on, s.off, s.restitution, *(one.value for one in s.resets))
    )  # fmt: skip
    tasks = equations.tasks
    set_by_tasks = (value for t in tasks for value in (*(r.value for r in t.resets), *t.reads))
    late = (part for one in equations.delays for part in (one.value, one.time, one.start))
    return frozenset[sp.Symbol]().union(
        *(value.free_symbols for value in (*told, *set_by_tasks, *late))
    )


def _delaying(closing: Closing) -> list[sp.Expr]:
    """What each delay reads, how late it is and what it gives before, in the order of the inputs."""
    late = {one.given: one for one in closing.equations.delays}
    found = [late[name] for name in closing.external if name in late]
    return [part for one in found for part in (one.value, one.time, one.start)]


def _check_varying(closing: Closing) -> None:
    """Refuse values that depend on what laws give."""
    for name in closing.equations.varying:
        if name in closing.laws and name not in closing.known:
            raise StructureError(
                f"a value depends on {name}, which a law gives; let it use what that law reads"
            )


def _all_names(equations: StateEquations, closing: Closing) -> set[sp.Symbol]:
    names = {*equations.parameters, *equations.signals, *closing.laws}
    names |= {*closing.law_states, *closing.external, TIME}
    for law in closing.laws.values():
        names |= law.free_symbols
    return names


def _rate_names(names: Sequence[sp.Symbol], taken: set[sp.Symbol]) -> tuple[sp.Symbol, ...]:
    """A name for each external input's rate that nothing else has."""
    prefix = "d_"
    while any(sp.Symbol(f"{prefix}{name}") in taken for name in names):
        prefix += "_"
    return tuple(sp.Symbol(f"{prefix}{name}") for name in names)


def _read(closing: Closing) -> tuple[int, ...]:
    used = set(closing.equations.outputs)
    for law in closing.laws.values():
        used |= law.free_symbols
    return tuple(at for at, name in enumerate(closing.equations.readings) if name in used)


def _is_affine(closing: Closing, friction: list[sp.Expr], parameters: set[str]) -> bool:
    """Whether all laws are affine, those too that determine one another; curves must be constant."""
    if closing.joint:
        return False
    given = [law.expression for law in closing.laws.values() if isinstance(law, ExpressionLaw)]
    rubbing = [law for law in closing.laws.values() if isinstance(law, DryFriction)]
    constant = all(law.curve.is_number and law.breakaway.is_number for law in rubbing)
    return constant and is_affine([*given, *friction], parameters)
