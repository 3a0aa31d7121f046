"""`lower`: equations and laws as named assignments that every backend prints the same way."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import sympy as sp

from bondgraph import DryFriction, ParameterError, StateEquations, StructureError
from bondgraph.expressions import TIME
from bondgraph.laws import SLIP, ExpressionLaw, Law
from codegen.closing import Closing, close_ports
from codegen.model.affine import is_affine

TEMPORARY = "c"
"""Temporaries are c0, c1, ...; names that are taken are passed over."""


@dataclass(frozen=True)
class Block:
    """Straight-line code: results from arguments, by way of named temporaries."""

    arguments: tuple[sp.Symbol, ...]
    assignments: tuple[tuple[sp.Symbol, sp.Expr], ...]
    results: tuple[sp.Expr, ...]


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
    """A port with dry friction: its node, the input it gives and the reading it receives."""

    name: Hashable
    input: int
    reading: int


@dataclass(frozen=True)
class Program:
    """Everything a simulator needs, as assignments; numbered as in the tuples of names.

    ``coefficients``: parameters to the nonzero entries of the matrices in ``layout``: A, J, B, E over
    states and inputs, and F, D, H, K with a row for each reading, ``F x + D u + H x' + K u'``.
    ``known``: laws of time, parameters and external inputs; ``known_rates`` their rates. ``groups``:
    the other laws in an order in which each can be evaluated. ``friction_values``: level, breakaway
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
    friction: tuple[FrictionPort, ...]
    friction_values: Block
    coupled: Group
    #: Whether the friction efforts have to be solved for together, with the coupled laws.
    joint: bool
    #: Readings that a step must not turn into an impulse: outputs, and what laws read.
    read: tuple[int, ...]
    #: Conditions that end a run where one falls below zero.
    guards: Block
    #: Whether coefficients change in time, with states, external inputs or the time itself.
    varying: bool
    #: Whether each friction mode is an affine system with constant coefficients.
    affine: bool


def lower(
    equations: StateEquations,
    laws: Mapping[Any, object] | None = None,
    parameters: Iterable[str] = (),
    guards: Sequence[sp.Expr] = (),
) -> Program:
    """Sort names into parameters and inputs, order the laws, and share common subexpressions.

    ``laws``: node (or the input it gives) to the law that closes its port, over those declared.
    ``parameters``: the names that will be given numbers; any other name in a law is an input.
    ``guards``: expressions that end a run where one of them falls below zero.

    Raises `ParameterError` if the matrices use a name that is no parameter, `DependentSourceError`
    if a law would have to be differentiated.
    """
    given = set(parameters)
    missing = [name.name for name in equations.parameters if name.name not in given]
    if missing:
        raise ParameterError(
            f"missing parameter(s) {', '.join(missing)}; give each a number in parameters"
        )
    watched = frozenset[sp.Symbol]().union(*(guard.free_symbols for guard in guards))
    closing = close_ports(equations, {} if laws is None else laws, given, watched)
    equations = closing.equations
    _check_varying(closing)
    taken = _all_names(equations, closing) | watched
    expressions, layout = _coefficients(equations)
    friction, values = _friction(closing)
    readings = tuple(equations.readings)
    rates = _rate_names(closing.external, taken)
    return Program(
        parameters=tuple(sorted((n for n in taken if n.name in given), key=str)),
        states=equations.states,
        law_states=tuple(closing.law_states),
        law_rates=tuple(readings.index(name) for name in closing.law_states.values()),
        inputs=equations.inputs,
        external=closing.external,
        external_rates=rates,
        readings=readings,
        outputs=equations.outputs,
        coefficients=block(expressions, taken),
        layout=layout,
        known=_group(closing, closing.known, False, taken),
        known_uses=tuple(_uses(closing, name) for name in closing.known),
        known_rates=block(_rates(closing, rates), taken),
        groups=tuple(_group(closing, names, loop, taken) for names, loop in closing.order),
        friction=friction,
        friction_values=block(values, taken),
        coupled=_group(closing, closing.coupled, True, taken),
        joint=closing.joint,
        read=_read(closing),
        guards=block(guards, taken),
        varying=bool(equations.varying),
        affine=_is_affine(closing, values, given),
    )


def _check_varying(closing: Closing) -> None:
    """Refuse values that depend on what laws give, and friction whose slip is a varying sum of speeds."""
    equations = closing.equations
    for name in equations.varying:
        if name in closing.laws and name not in closing.known:
            raise StructureError(
                f"a value depends on {name}, which a law gives; let it use what that law reads"
            )
    for name in closing.friction:
        row = equations.readings[closing.received[name]]
        used = {
            s
            for part in (row.F, row.D, row.H, row.K)
            for e in part.values()
            for s in e.free_symbols
        }
        if used & set(equations.varying):
            raise StructureError(
                f"the slip at {closing.port_names[name]!r} is a sum of speeds whose factors change in time; "
                "dry friction needs constant ones there: put a stiff spring between, or use a smooth law"
            )


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


def _all_names(equations: StateEquations, closing: Closing) -> set[sp.Symbol]:
    names = {*equations.parameters, *equations.signals, *closing.laws}
    names |= {*closing.law_states, *closing.external, TIME}
    for law in closing.laws.values():
        names |= law.free_symbols
    return names


def _coefficients(
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


def _pattern(shape: tuple[int, int], places: Sequence[tuple[int, int]]) -> Pattern:
    return Pattern(shape, tuple(i for i, _ in places), tuple(j for _, j in places))


def _group(
    closing: Closing, names: Sequence[sp.Symbol], loop: bool, taken: Iterable[sp.Symbol]
) -> Group:
    inputs = tuple(closing.equations.inputs.index(name) for name in names)
    expressions = [_expression(closing.laws[name]) for name in names]
    ports = tuple(closing.port_names[name] for name in names)
    known = list(closing.equations.readings)
    readings = tuple(known.index(closing.received[name]) for name in names)
    return Group(inputs, ports, readings, loop, block(expressions, taken))


def _rate_names(names: Sequence[sp.Symbol], taken: set[sp.Symbol]) -> tuple[sp.Symbol, ...]:
    """A name for each external input's rate that nothing else has."""
    prefix = "d_"
    while any(sp.Symbol(f"{prefix}{name}") in taken for name in names):
        prefix += "_"
    return tuple(sp.Symbol(f"{prefix}{name}") for name in names)


def _uses(closing: Closing, name: sp.Symbol) -> tuple[int, ...]:
    used = closing.laws[name].free_symbols
    return tuple(at for at, external in enumerate(closing.external) if external in used)


def _read(closing: Closing) -> tuple[int, ...]:
    used = set(closing.equations.outputs)
    for law in closing.laws.values():
        used |= law.free_symbols
    return tuple(at for at, name in enumerate(closing.equations.readings) if name in used)


def _is_affine(closing: Closing, friction: list[sp.Expr], parameters: set[str]) -> bool:
    """Whether all laws are affine and none has to be solved for; curves must be constant."""
    if closing.equations.varying or closing.joint or any(loop for _, loop in closing.order):
        return False
    given = [law.expression for law in closing.laws.values() if isinstance(law, ExpressionLaw)]
    rubbing = [law for law in closing.laws.values() if isinstance(law, DryFriction)]
    constant = all(law.curve.is_number and law.breakaway.is_number for law in rubbing)
    return constant and is_affine([*given, *friction], parameters)


def _expression(law: Law) -> sp.Expr:
    if not isinstance(law, ExpressionLaw):
        raise TypeError(f"{law} is not an expression")
    return law.expression


def _rates(closing: Closing, rates: Sequence[sp.Symbol]) -> list[sp.Expr]:
    """The rate of each known law: its slope in time and along the external inputs."""
    result = []
    for name in closing.known:
        law = _expression(closing.laws[name])
        slope = sp.diff(law, TIME)
        for external, rate in zip(closing.external, rates, strict=True):
            slope += sp.diff(law, external) * rate
        result.append(slope)
    return result


def _friction(closing: Closing) -> tuple[tuple[FrictionPort, ...], list[sp.Expr]]:
    readings = list(closing.equations.readings)
    ports: list[FrictionPort] = []
    values: list[sp.Expr] = []
    for name in closing.friction:
        law = closing.laws[name]
        if not isinstance(law, DryFriction):
            continue
        received = closing.received[name]
        ports.append(
            FrictionPort(
                closing.port_names[name],
                closing.equations.inputs.index(name),
                readings.index(received),
            )
        )
        curves = [law.curve.subs(SLIP, slip) for slip in (sp.Abs(received), 0)]
        values += [law.level, law.breakaway * law.level, *curves]
    return tuple(ports), values
