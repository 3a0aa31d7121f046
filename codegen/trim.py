"""`trim`: a steady state, with friction and switches as they would be in it."""

from collections.abc import Hashable, Mapping

from bondgraph.errors import StructureError
from bondgraph.nodes.laws import ExpressionLaw
from bondgraph.nodes.machined import told_numbers
from codegen.instants.equilibrium import equilibrium
from codegen.model.snapshot import Snapshot
from codegen.modes.closed import ClosedModel
from codegen.modes.steady import choices
from codegen.simulate import bare_simulator
from codegen.simulator import Simulator


def trim(
    simulator: Simulator,
    inputs: Mapping[str, float] | None = None,
    initial: Mapping[str, float] | None = None,
    mode: Mapping[Hashable, str] | None = None,
) -> dict[str, float]:
    """A point at which all states rest under constant inputs: every signal's value by name.

    What sampled controllers keep rests where they set it to what it is; delays give what they read.

    ``initial``: states to start the search from. ``mode``: what friction and switches do there, in the
    words of events, such as ``{"dog": "off", "brake": "stick"}``; of a state machine in which mode it stays,
    which ``initial`` tells else; of others a mode is found that is
    consistent, from the one that the start shows; so of laws that jump, which no word names. Sticking and
    sliding are preferred where both would do. The result is what `linearize` takes as ``at``, and ``mode``
    what it takes as that.

    Raises `SignalError` and `StructureError` for unusable arguments, `SimulationError` if no steady state
    was found, with the ports that would leave it.

    >>> import bondgraph as bg, networkx as nx
    >>> from codegen import simulator
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("pump", "p"), bg.One("pipe"), bg.I("fluid", "I_f", flow="q"),
    ...                   bg.R("orifice", law="c*q*abs(q)")])
    >>> g.add_edges_from([("pump", "pipe"), ("pipe", "fluid"), ("pipe", "orifice")])
    >>> point = trim(simulator(bg.derive(g), {"I_f": 1, "c": 2}), {"p": 18}, {"q": 1})
    >>> round(point["q"], 9)
    3.0
    """
    if not isinstance(simulator, Simulator):
        raise StructureError(
            f"trim takes what codegen.simulator returns, not a {type(simulator).__name__}"
        )
    simulator = _timeless(simulator)
    model = simulator.closed
    mode, initial = told_numbers(model.program.equations.machines, mode, initial)
    choices(model, mode)
    pieces, start = simulator.steady(inputs or {}, initial or {})
    return _named(model, equilibrium(model, pieces, start, mode))


def _timeless(simulator: Simulator) -> Simulator:
    """The same model with what delays read at once in place of what they give: at rest that is one."""
    closed = simulator.closed
    if not closed.program.delayed:
        return simulator
    late = {one.given: ExpressionLaw(one.value) for one in closed.equations.delays}
    at_once = {name.name: late[name] for name in closed.program.delayed}
    laws = {**(simulator.laws or {}), **at_once}
    return bare_simulator(closed.equations, closed.parameters, laws)


def _named(model: ClosedModel, now: Snapshot) -> dict[str, float]:
    program = model.program
    given, shown = program.shown_inputs, program.shown
    groups = (
        (program.states, now.x), (program.law_states, now.z),
        ([program.inputs[j] for j in given], now.u[list(given)]), (program.asked, now.external),
        ([program.readings[i] for i in shown], now.y[list(shown)]),
    )  # fmt: skip
    values: dict[str, float] = {}
    for names, row in groups:
        for name, value in zip(names, row.tolist(), strict=False):
            values.setdefault(name.name, value)
    return values
