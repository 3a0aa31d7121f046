"""`linearize`: equations with laws closed at an operating point, symbolic, for small deviations."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, overload

import sympy as sp

from bondgraph.algebra.atoms import normal
from bondgraph.algebra.exact import FixedRow, Row, SingularError, cancelled, fixed
from bondgraph.algebra.expressions import TIME
from bondgraph.algebra.tidy import tidy_matrices
from bondgraph.analyse.closed_rows import ClosedRows
from bondgraph.analyse.closures import merged_laws
from bondgraph.analyse.constrained import Rows, locked
from bondgraph.analyse.instant import Instant
from bondgraph.analyse.linear_model import LinearModel
from bondgraph.analyse.modes import ToldModes, held_rows, told_modes
from bondgraph.analyse.moving_hold import turns
from bondgraph.analyse.sampled import SampledModel, check_told, sampled
from bondgraph.analyse.slopes import Point, operating_point, with_given
from bondgraph.analyse.turned import turned
from bondgraph.analyse.unknowns import Unknowns, unknowns_in
from bondgraph.derive import check_derived, derive_again
from bondgraph.equations import StateEquations
from bondgraph.errors import SignalError, SingularStorageError
from bondgraph.nodes.laws import DryFriction, ExpressionLaw, Law, slides
from bondgraph.nodes.machined import told_numbers
from bondgraph.reduce.rates import resolved
from bondgraph.reduce.record import Reading
from bondgraph.reduce.structure import Port


@overload
def linearize(
    equations: StateEquations, at: Mapping[Any, object] | None = None,
    laws: Mapping[Any, object] | None = None, inputs: Iterable[str] = (), stuck: Iterable[Hashable] = (),
    outputs: Iterable[str] | None = None, mode: Mapping[Any, str] | None = None,
    rates: Mapping[Any, object] | None = None, period: None = None,
) -> LinearModel: ...  # fmt: skip


@overload
def linearize(
    equations: StateEquations, at: Mapping[Any, object] | None = None,
    laws: Mapping[Any, object] | None = None, inputs: Iterable[str] = (), stuck: Iterable[Hashable] = (),
    outputs: Iterable[str] | None = None, mode: Mapping[Any, str] | None = None,
    rates: Mapping[Any, object] | None = None, *, period: float | str | sp.Rational,
) -> SampledModel: ...  # fmt: skip


def linearize(
    equations: StateEquations,
    at: Mapping[Any, object] | None = None,
    laws: Mapping[Any, object] | None = None,
    inputs: Iterable[str] = (),
    stuck: Iterable[Hashable] = (),
    outputs: Iterable[str] | None = None,
    mode: Mapping[Any, str] | None = None,
    rates: Mapping[Any, object] | None = None,
    period: float | str | sp.Rational | None = None,
) -> LinearModel | SampledModel:
    """The equations for small deviations, every law replaced by its slopes, every switch in one mode.

    ``at``: signal to value at the operating point, as far as slopes depend on it. Where A or what is held
    depends on what moves, and states accelerate at the point, how they do counts: their rates are those that
    the equations have there, with ``rates`` of open inputs, zero where left out. ``laws``: as for a
    simulator, over those declared. ``inputs``: names in laws and values that become inputs; what no signal
    has is a parameter. A law that reads no signal and no such input leaves its port an input. ``outputs``:
    names of signals, else the equations' outputs. ``mode``: node to its mode: "on" or "off" for every
    switch and controlled junction, of a stop also "apart" or "touch", the first where ``at`` tells that it
    is off its bound; "stick" or "slip" for dry friction, which slips unless told, to the side that ``at``
    tells; for a state machine one of its modes, where ``at`` does not tell its number. ``stuck``: nodes that
    stick. What is held takes a state with it, of the storage of lowest priority, earlier ones first.
    ``period`` [s]: of a loop with sampled controllers, for the model from one instant to the next; without
    one what they keep stays.

    Raises `SignalError` where a slope needs a value that ``at`` lacks or the law has a corner there,
    `StructureError` for a switch without a mode, for one that there is not, and for a stop that is told to
    touch off its bound, `DependentSourceError` where only sources rule what is to be held.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("pump", "p"), bg.One("pipe"), bg.I("fluid", "I_f", flow="q"),
    ...                   bg.R("orifice", law="c*q*abs(q)")])
    >>> g.add_edges_from([("pump", "pipe"), ("pipe", "fluid"), ("pipe", "orifice")])
    >>> linearize(bg.derive(g), at={"q": 3}).J
    Matrix([[-6*c]])
    """
    check_derived(equations)
    if equations.delays:
        name = equations.delays[0].given
        raise SignalError(
            f"delay {name}: a delay has no finite number of states, and no linear model of them; put a "
            f"bg.TransferFunction that stands for it in its place, or bg.Function({name.name!r}, ...) at rest"
        )
    mode, at = told_numbers(equations.machines, mode, at)
    stuck = tuple(stuck) if isinstance(stuck, Iterable) and not isinstance(stuck, str) else stuck
    equations = turned(_opened(equations, inputs), _with_held(equations, laws, stuck, mode))
    merged = merged_laws(equations, {} if laws is None else laws)
    told = told_modes(equations, merged, stuck, mode, at)
    closed = {name: law for name, law in merged.items() if name not in told.names}
    read = {name for law in closed.values() for name in law.free_symbols}
    read |= {name for port in told.held for name in _level(merged.get(port.element.name), port)}
    sets = [(reset, task) for task in equations.tasks for reset in task.resets]
    read |= {name for reset, _ in sets for name in reset.value.free_symbols}
    shown = _shown(equations, closed, outputs)
    equations = equations.with_readings({*read, *shown, *equations.integrals.values()})
    outer = _outer(equations, closed, read, inputs, told)
    # A point may tell what a law or a condition reads that the mode leaves out.
    told_of = {name for law in merged.values() for name in law.free_symbols} | read
    told_of |= {
        name for one in equations.switches for name in one.on.free_symbols | one.off.free_symbols
    }
    named = {*equations.signals, *equations.states, *equations.inputs, *equations.integrals}
    known = {*named, *equations.parameters, *told_of, TIME}
    by_input = {
        p.given: closed[p.element.name] for p in equations.ports if p.element.name in closed
    }
    own = {law.state for law in closed.values() if isinstance(law, ExpressionLaw) and law.state}
    moving = {*named, *own, *outer, TIME}
    point = with_given(operating_point(at, known), by_input | told.zeros, moving)
    unknowns, free = Unknowns(), told.free
    system = ClosedRows(equations, closed, outer, point, unknowns, free, told.held)
    instant = Instant(system, told.held, merged, _rates(system, rates, told), unknowns)
    held, bends = held_rows(system, told.held, merged), tuple[Reading, ...]()
    tied = held.tied
    if held.bound and turns(system, told.held, merged):
        held, bends = instant.hold.held, instant.hold.bends
    A, balances = system.dynamics()
    ys = tuple(system.put_in(system.signal(name)) for name in shown)
    if period is not None:
        check_told(equations.tasks)
        ys += tuple(system.value(reset.value, task.name) for reset, task in sets)
        shown += [reset.state for reset, _ in sets]
    model = Rows(system.states, tuple(map(fixed, A)), tuple(balances), ys)
    model, bound, bends = _filled(instant, model, held.bound, bends)
    if bound:
        order = _least_first(equations, len(system.states))
        model = locked(model, bound, bends, tied, order, told.holding)
    columns = {equations.inputs.index(port.given) for port in told.held}
    left = [j for j in system.left if j not in columns]
    found = _model(model, left, system.columns, tuple(shown))
    return found if period is None else sampled(found, equations.tasks, period)


def _opened(equations: StateEquations, inputs: Iterable[str]) -> StateEquations:
    """The equations whose values read those of these names that they know as parameters."""
    parameters = {name.name for name in equations.parameters}
    names = (
        [] if isinstance(inputs, str) else [str(name) for name in inputs if str(name) in parameters]
    )
    return derive_again(equations, {}, names) if names else equations


def _with_held(
    equations: StateEquations, laws: Mapping[Any, object] | None, stuck: object,
    mode: Mapping[Any, str] | None,
) -> dict[Any, object]:  # fmt: skip
    """The laws, and friction over open ports that stick without one: what holds them goes either way."""
    found = dict(laws) if isinstance(laws, Mapping) else {}
    told = [*stuck] if isinstance(stuck, tuple) else []
    told += (
        [name for name, word in mode.items() if word == "stick"]
        if isinstance(mode, Mapping)
        else []
    )
    for port in equations.ports:
        name = port.element.name
        named = {name, port.given, port.given.name} & found.keys()
        if name in told and not named and port.element.law is None:
            found[name] = DryFriction(0)
    return found


def _rates(system: ClosedRows, rates: Mapping[Any, object] | None, told: ToldModes) -> Point:
    """The rates of open inputs at the point, by name; `SignalError` for what is none."""
    given = {port.given for port in told.ports}
    given |= {port.given for port in system.equations.ports if port.element.name in system.closed}
    return operating_point(rates, [name for name in system.columns if name not in given], "rates")


def _filled(
    instant: Instant, model: Rows, bound: Sequence[Reading], bends: Sequence[Reading]
) -> tuple[Rows, tuple[Reading, ...], tuple[Reading, ...]]:
    """The same rows with what the point does not tell and its equations do."""
    inertia = [Reading({}, {}, row, {}) for row in model.A]
    values = instant.solved(
        unknowns_in([*inertia, *model.balances, *model.outputs, *bound, *bends])
    )
    if not values:
        return model, tuple(bound), tuple(bends)

    def filled(rows: Sequence[Reading]) -> tuple[Reading, ...]:
        return tuple(Reading(*({j: v for j, e in part.items() if (v := cancelled(e.xreplace(values))) != 0}
                               for part in row.parts)) for row in rows)  # fmt: skip

    A = tuple(row.H for row in filled(inertia))
    known = replace(model, A=A, balances=filled(model.balances), outputs=filled(model.outputs))
    return known, filled(bound), filled(bends)


def _level(law: Law | None, port: Port) -> frozenset[sp.Symbol]:
    """What the level reads of dry friction that gives a flow."""
    return law.free_symbols if slides(law, port.gives) else frozenset()


def _least_first(equations: StateEquations, size: int) -> list[int]:
    """The states in the order in which they become dependent: lowest priority first."""
    ports = [equations.reduction.structure.ports[port] for port in equations.reduction.states]
    priority = [port.element.priority for port in ports] + [0.0] * (size - len(ports))
    return sorted(range(size), key=lambda j: (priority[j], j))


def _outer(
    equations: StateEquations, closed: Mapping[Hashable, Law], read: set[sp.Symbol],
    inputs: Iterable[str], told: ToldModes,
) -> tuple[sp.Symbol, ...]:  # fmt: skip
    """The names in laws that are to be inputs; `SignalError` for one that can be none."""
    if isinstance(inputs, str):
        raise SignalError(f"inputs must be a list of names, not {inputs!r}")
    given = {port.given for port in equations.ports if port.element.name in closed}
    given |= {port.given for port in told.ports}
    states = {law.state for law in closed.values() if isinstance(law, ExpressionLaw)}
    states |= set(equations.integrals)
    asked = {sp.Symbol(str(normal(str(name)))) for name in inputs}
    for name in sorted(asked, key=str):
        if name in equations.inputs and name not in given:
            continue
        if name in {*equations.signals, *states, *equations.parameters, TIME}:
            raise SignalError(f"{name} can't be an input: it is a signal or the time")
        if name not in read:
            raise SignalError(f"no law reads an input {name}")
    return tuple(sorted(asked - set(equations.inputs), key=str))


def _shown(
    equations: StateEquations, closed: Mapping[Hashable, Law], outputs: Iterable[str] | None
) -> list[sp.Symbol]:
    if outputs is None:
        return list(equations.outputs)
    if isinstance(outputs, str):
        raise SignalError(f"outputs must be a list of signals, not {outputs!r}")
    own = {law.state for law in closed.values() if isinstance(law, ExpressionLaw) and law.state}
    own |= set(equations.integrals)
    shown = [sp.Symbol(str(normal(str(name)))) for name in outputs]
    for name in shown:
        if name not in equations.signals and name not in own:
            known = ", ".join(sorted(map(str, {*equations.signals, *own})))
            raise SignalError(f"no signal is called {name}; there are {known}")
    return shown


def _model(
    model: Rows, left: Sequence[int], columns: Sequence[sp.Symbol], outputs: tuple[sp.Symbol, ...]
) -> LinearModel:
    """Rows as matrices over the inputs that are left; what is let go gives zero."""
    place = {j: at for at, j in enumerate(left)}

    def over_inputs(rows: Sequence[FixedRow]) -> tuple[list[Row], int]:
        kept = [{place[j]: e for j, e in row.items() if j in place} for row in rows]
        return kept, len(left)

    n = len(model.states)
    ys = [_settled(model, y) for y in model.outputs]
    parts = [
        (model.A, n), ([row.F for row in model.balances], n),
        over_inputs([row.D for row in model.balances]), over_inputs([row.K for row in model.balances]),
        ([y.F for y in ys], n), over_inputs([y.D for y in ys]), over_inputs([y.K for y in ys]),
    ]  # fmt: skip
    matrices = dict(zip("AJBEFDG", tidy_matrices(parts), strict=True))
    return LinearModel(model.states, tuple(columns[j] for j in left), outputs, **matrices)


def _settled(model: Rows, y: Reading) -> Reading:
    try:
        return resolved(model.A, model.balances, y)
    except SingularError:
        raise SingularStorageError(
            "A is singular at this point, so the rates that an output shows are not determined"
        ) from None
