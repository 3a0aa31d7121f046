"""Which law closes which port, and in which order laws can be evaluated."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import networkx as nx
import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.analyse.acting import acting
from bondgraph.analyse.closures import merged_laws
from bondgraph.equations import StateEquations
from bondgraph.errors import ParameterError, StructureError
from bondgraph.nodes.laws import SLIP, DryFriction, ExpressionLaw, Law
from bondgraph.reduce.readings import depends_on_signals
from codegen.program.jumps import Jump, Smooth, jumps_of
from codegen.program.sliding import Slider, sliders_of


@dataclass(frozen=True)
class Closing:
    """The laws by the input they give, sorted by what they depend on.

    ``known``: of time, parameters and external inputs. ``order``: groups of the others in the order of
    their evaluation, with whether each is a loop; the first ``early`` come before friction, the rest only
    read what it gives. ``friction``: inputs given by dry friction, and by ideal switches, which let go
    give nothing. ``coupled``: laws that depend on friction and act back on it, solved together with it.
    ``law_states``: each law's own state and the reading that is its rate.
    """

    #: The equations, with every signal that a law reads among their readings.
    equations: StateEquations
    laws: Mapping[sp.Symbol, Law]
    port_names: Mapping[sp.Symbol, Hashable]
    received: Mapping[sp.Symbol, sp.Symbol]
    law_states: Mapping[sp.Symbol, sp.Symbol]
    external: tuple[sp.Symbol, ...]
    known: tuple[sp.Symbol, ...]
    order: tuple[tuple[tuple[sp.Symbol, ...], bool], ...]
    early: int
    friction: tuple[sp.Symbol, ...]
    coupled: tuple[sp.Symbol, ...]
    #: Whether friction efforts act back at once on friction, by way of slips, levels or other laws.
    joint: bool
    #: Dry friction that gives a flow; what its halves give is among ``friction``.
    sliders: tuple[Slider, ...] = ()
    #: Jumps of laws; their mixtures are among ``friction``.
    jumps: tuple[Jump, ...] = ()
    smooth: tuple[Smooth, ...] = ()


def close_ports(
    equations: StateEquations,
    overrides: Mapping[Hashable, object],
    parameters: set[str],
    watched: frozenset[sp.Symbol] = frozenset(),
) -> Closing:
    """Merge declared and given laws, sort their names, and find an order of evaluation.

    ``watched``: names that are asked for beside those that laws read.
    """
    by_port = merged_laws(equations, overrides)
    _check_assumptions(equations, by_port)
    read = {name for closed in by_port.values() for name in closed.free_symbols} | watched
    equations = equations.with_readings({*read, *equations.integrals.values()})
    equations, jumps, smooth = jumps_of(equations, by_port, parameters)
    equations, sliders = sliders_of(equations, by_port)
    ports = {port.element.name: port for port in equations.ports}
    _check_parameters(equations, by_port, parameters)
    for name, port in ports.items():
        # An open input that parameters name is held at that number.
        if name not in by_port and port.given.name in parameters:
            by_port[name] = ExpressionLaw(port.given)
    switching = {port.given for port in equations.ports if port.element.kind.switches}
    by_port |= {name: DryFriction(0) for name, p in ports.items() if p.given in switching}
    laws: dict[sp.Symbol, Law] = {}
    for name, closed in by_port.items():
        if laws.setdefault(ports[name].given, closed) != closed:
            raise StructureError(f"input {ports[name].given} is closed by two different laws")
    owner = {ports[name].given: name for name in by_port}
    received = {given: ports[name].received for given, name in owner.items()}
    _put_in_jumps(jumps, smooth, laws, owner, received)
    for slider in sliders:
        _put_in_halves(slider, laws, owner, received)
        switching |= {half.given for half in slider.halves}
    states = {
        closed.state: received[given]
        for given, closed in laws.items()
        if isinstance(closed, ExpressionLaw) and closed.state is not None
    }
    states = {**states, **equations.integrals}
    sorted_laws = _sort(equations, laws, set(states), parameters, switching, received)
    known, order, early, friction, coupled, joint = sorted_laws
    return Closing(
        equations,
        laws,
        owner,
        received,
        states,
        _external(equations, laws, watched, set(states), parameters),
        known,
        order,
        early,
        friction,
        coupled,
        joint,
        sliders,
        jumps,
        smooth,
    )


def _put_in_jumps(
    jumps: Iterable[Jump],
    smooth: Iterable[Smooth],
    laws: dict[sp.Symbol, Law],
    owner: dict[sp.Symbol, Hashable],
    received: dict[sp.Symbol, sp.Symbol],
) -> None:
    """Smooth laws instead of those that jump, and of each jump the friction that it is."""
    for one in smooth:
        for table in (laws, owner, received):
            del table[one.port.given]
        laws[one.given], received[one.given] = one.law, one.port.received
        owner[one.given] = one.port.element.name
    for jump in jumps:
        laws[jump.mixture], laws[jump.offset] = DryFriction(1), ExpressionLaw(jump.law)
        received |= dict.fromkeys([jump.mixture, jump.offset], jump.depends)
        owner |= dict.fromkeys([jump.mixture, jump.offset], jump.node)


def _put_in_halves(
    slider: Slider,
    laws: dict[sp.Symbol, Law],
    owner: dict[sp.Symbol, Hashable],
    received: dict[sp.Symbol, sp.Symbol],
) -> None:
    """A law of each half and of the level, instead of the slider's own."""
    port = slider.port
    del laws[port.given], owner[port.given], received[port.given]
    laws[slider.level], received[slider.level] = ExpressionLaw(slider.law), port.received
    for half in slider.halves:
        laws[half.given], received[half.given] = DryFriction(0), half.received
    owner |= dict.fromkeys([slider.level, *(half.given for half in slider.halves)], slider.name)


def _check_assumptions(equations: StateEquations, laws: Mapping[Hashable, Law]) -> None:
    """Refuse a law whose symbol only looks like another: same name, other assumptions."""
    known = {name.name: name for name in (*equations.parameters, *equations.signals)}
    for port, closed in laws.items():
        for name in sorted(closed.free_symbols, key=str):
            if known.setdefault(name.name, name) != name:
                raise StructureError(
                    f"law at {port!r}: the symbol {name} is used elsewhere with different "
                    "assumptions; use one symbol for one name, or plain text"
                )


def _check_parameters(
    equations: StateEquations, laws: Mapping[Hashable, Law], parameters: set[str]
) -> None:
    """Refuse a parameter that names a signal, or an input that a law gives already."""
    closed = {port.given for port in equations.ports if port.element.name in laws}
    own = {part.state for part in laws.values() if isinstance(part, ExpressionLaw) and part.state}
    own |= set(equations.integrals)
    signals = set(equations.signals) - set(equations.inputs)
    taken = {*signals, *closed, *own, TIME}
    for name in sorted(taken, key=str):
        if name.name in parameters:
            raise ParameterError(f"parameter {name} names a signal of the model; rename it")


def _external(
    equations: StateEquations,
    laws: Mapping[sp.Symbol, Law],
    watched: frozenset[sp.Symbol],
    law_states: set[sp.Symbol],
    parameters: set[str],
) -> tuple[sp.Symbol, ...]:
    """Inputs nothing in the model gives: open ports and sources first, then what else is asked for.

    What delays give comes last of the ports.
    """
    known = {*equations.signals, *equations.inputs, *law_states, TIME}
    names = watched.union(*(closed.free_symbols for closed in laws.values()))
    asked = {name for name in names - known if name.name not in parameters}
    late = {one.given for one in equations.delays}
    ports = sorted((name for name in equations.inputs if name not in laws), key=late.__contains__)
    return (*ports, *sorted(asked, key=str))


Sorted = tuple[
    tuple[sp.Symbol, ...],
    tuple[tuple[tuple[sp.Symbol, ...], bool], ...],
    int,
    tuple[sp.Symbol, ...],
    tuple[sp.Symbol, ...],
    bool,
]


def _sort(
    equations: StateEquations,
    laws: Mapping[sp.Symbol, Law],
    law_states: set[sp.Symbol],
    parameters: set[str],
    switching: set[sp.Symbol],
    received: Mapping[sp.Symbol, sp.Symbol],
) -> Sorted:
    held = {name for name, law in laws.items() if law == ExpressionLaw(name)}
    held = {name for name in held if name.name in parameters}
    signals = (set(equations.signals) | law_states) - (set(equations.inputs) - set(laws)) - held
    friction = tuple(name for name in laws if isinstance(laws[name], DryFriction))
    known = tuple(name for name in laws if not depends_on_signals(laws[name], signals))
    needs: nx.DiGraph[sp.Symbol] = nx.DiGraph()
    needs.add_nodes_from(name for name in laws if name not in known)
    # What a switch gives let go is nothing, whatever it receives.
    for name in needs:
        for source in _reads(equations, laws, name) if name not in switching else ():
            if source in needs:
                needs.add_edge(source, name)
    after: set[sp.Symbol] = set().union(*(nx.descendants(needs, name) for name in friction))
    moving = after & _acting(
        equations, laws, needs, [received[name] for name in friction], received
    )
    moving |= set().union(*(nx.ancestors(needs, name) for name in {*friction, *moving}))
    coupled = tuple(name for name in laws if name in after & moving and name not in friction)
    late = after - set(friction) - set(coupled)
    early = _groups(needs.subgraph(set(needs) - after - set(friction)), list(laws))
    order = (*early, *_groups(needs.subgraph(late), list(laws)))
    solved = {*friction, *coupled}
    joint = bool(coupled) or any(a in solved and b in friction for a, b in needs.edges)
    return known, order, len(early), friction, coupled, joint


def _acting(
    equations: StateEquations,
    laws: Mapping[sp.Symbol, Law],
    needs: "nx.DiGraph[sp.Symbol]",
    slips: Sequence[sp.Symbol],
    received: Mapping[sp.Symbol, sp.Symbol],
) -> set[sp.Symbol]:
    """The inputs that act on slips, by way of the states of laws, too, whose rates are what these receive."""
    owners = {name for name, law in laws.items() if isinstance(law, ExpressionLaw) and law.state}
    asked = list(slips)
    while True:
        found = acting(equations, asked)
        found |= set().union(*(nx.ancestors(needs, name) for name in found if name in needs))
        more = [received[name] for name in laws if name in owners & found]
        if not (more := [name for name in more if name not in asked]):
            return found
        asked += more


def _reads(
    equations: StateEquations, laws: Mapping[sp.Symbol, Law], name: sp.Symbol
) -> set[sp.Symbol]:
    """The inputs a law's value depends on, by name or through the readings it uses."""
    closed = laws[name]
    used = closed.free_symbols
    # Which way it slips the mode says: without a curve what it gives does not hang on how fast.
    if isinstance(closed, DryFriction) and SLIP in closed.curve.free_symbols:
        used = used | {port.received for port in equations.ports if port.given == name}
    result = {symbol for symbol in used if symbol in laws}
    for symbol in used & set(equations.readings):
        reading = equations.readings[symbol]
        # A reading of x' depends on whatever drives the storages: on every input, to be safe.
        result |= set(laws) if reading.H else {equations.inputs[j] for j in reading.D}
    return result


def _groups(
    needs: "nx.DiGraph[sp.Symbol]", order: Sequence[sp.Symbol]
) -> tuple[tuple[tuple[sp.Symbol, ...], bool], ...]:
    """Laws that determine one another together, each group after those it needs."""
    position = {name: at for at, name in enumerate(order)}
    condensed = nx.condensation(needs)
    members = {
        group: tuple(sorted(condensed.nodes[group]["members"], key=position.__getitem__))
        for group in condensed
    }
    in_turn = nx.lexicographical_topological_sort(
        condensed, lambda group: position[members[group][0]]
    )
    return tuple(
        (
            members[group],
            len(members[group]) > 1 or needs.has_edge(members[group][0], members[group][0]),
        )
        for group in in_turn
    )
