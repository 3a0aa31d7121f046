"""`switched_simulator`: graphs with switches, from the graph to what runs it in one call."""

from collections.abc import Hashable, Iterable, Mapping
from dataclasses import dataclass
from os import PathLike
from typing import Any

from numpy.typing import ArrayLike

from bondgraph.derive import derive
from bondgraph.errors import StructureError
from codegen.engine.fallback import tell
from codegen.model.starts import by_states
from codegen.record.resting import tell_resting
from codegen.record.result import Result
from codegen.runs.arguments import named_numbers
from codegen.runs.completion import tell_completed
from codegen.runs.dependent import dependent_variables, over_states
from codegen.simulate import simulator
from codegen.simulator import Simulator
from codegen.stepping.stepper import Stepper
from codegen.streaming.streamed import Streamed
from codegen.tuning import TUNING


@dataclass(frozen=True)
class SwitchedSimulator:
    """A graph with switches and numbers for its parameters: a `Simulator` whose switches are named.

    ``states``: those of the simulator, then the co-energy variables of storages that depend on them, by
    which a start can be told as well. ``inputs``: what the model must be given. ``switches``: the names of
    switches and controlled junctions.
    """

    simulator: Simulator

    @property
    def states(self) -> tuple[str, ...]:
        """Co-energy variables of independent storages, states that laws own, those of dependent ones."""
        return (*self.simulator.states, *dependent_variables(self.simulator.closed))

    @property
    def inputs(self) -> tuple[str, ...]:
        """What a run must be given."""
        return self.simulator.inputs

    @property
    def switches(self) -> tuple[Hashable, ...]:
        """The names of switches and controlled junctions, in declaration order."""
        return self.simulator.switches

    def run(
        self,
        time: ArrayLike,
        initial: Mapping[str, float] | None = None,
        inputs: Mapping[str, object] | None = None,
        initially_on: Iterable[Hashable] = (),
        method: str = "auto",
        rtol: float = TUNING.rtol,
        atol: float = TUNING.atol,
        events: bool = True,
    ) -> Result:
        """Integrate over the given times [s]; see `Simulator.run`."""
        # Not by its `run`, so that warnings are told of who calls this.
        told = self._told(initial)
        done = self.simulator.run_telling(
            tell, time, told, inputs, method, rtol, atol, initially_on, events
        )
        tell_completed(done.completed)
        tell_resting(self.simulator.closed, done)
        return done

    def stream(
        self,
        path: str | PathLike[str],
        time: ArrayLike,
        initial: Mapping[str, float] | None = None,
        inputs: Mapping[str, object] | None = None,
        *,
        signals: Iterable[str] | None = None,
        initially_on: Iterable[Hashable] = (),
        method: str = "auto",
        rtol: float = TUNING.rtol,
        atol: float = TUNING.atol,
        events: bool = True,
    ) -> Streamed:
        """Run into a file, sample by sample; see `Simulator.stream`."""
        return self.simulator.stream(
            path, time, self._told(initial), inputs, signals=signals, method=method, rtol=rtol,
            atol=atol, initially_on=initially_on, events=events,
        )  # fmt: skip

    def stepper(
        self,
        initial: Mapping[str, float] | None = None,
        inputs: Mapping[str, object] | None = None,
        *,
        time: float = 0.0,
        method: str = "auto",
        rtol: float = TUNING.rtol,
        atol: float = TUNING.atol,
        initially_on: Iterable[Hashable] = (),
    ) -> Stepper:
        """The graph at ``time`` [s], to be stepped from outside; see `Simulator.stepper`."""
        told = self._told(initial)
        made = self.simulator.stepping(told, inputs, time, method, rtol, atol, initially_on)
        tell_completed(made.completed)
        return made

    def _told(self, initial: Mapping[str, float] | None) -> dict[str, float]:
        """A start by states alone."""
        closed = self.simulator.closed
        begun = {} if initial is None else by_states(closed.equations, closed.parameters, initial)
        return over_states(closed, named_numbers(begun, self.states))


def switched_simulator(
    graph: Any,
    parameters: Mapping[str, object],
    laws: Mapping[Any, object] | None = None,
    outputs: Iterable[Hashable] | None = None,
    backend: str = "numpy",
) -> SwitchedSimulator:
    """A simulator of a graph with switches and controlled junctions: `derive`, then `simulator`.

    ``parameters``, ``laws`` and ``backend`` as for `simulator`, ``outputs`` as for `derive`.

    Raises `StructureError` for a graph without switches, and what `derive` and `simulator` raise.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.One("first"), bg.I("m_1", 1, flow="v_1"), bg.Zero("gap"),
    ...                   bg.Sw("slack", on="1 - t"), bg.One("second"), bg.I("m_2", 3, flow="v_2")])
    >>> g.add_edges_from([("first", "m_1"), ("first", "gap"), ("gap", "slack"), ("gap", "second"),
    ...                   ("second", "m_2")])
    >>> run = switched_simulator(g, {}).run([0.0, 2.0], initial={"v_1": 4.0})
    >>> run["v_1"].round(9).tolist(), run["v_2"].round(9).tolist()
    ([4.0, 1.0], [0.0, 1.0])
    >>> [(event.time, event.port, event.kind, round(event.impulse, 9)) for event in run.events]
    [(1.0, 'slack', 'off', 3.0)]
    """
    equations = derive(graph, outputs)
    if not any(port.element.switch for port in equations.ports):
        raise StructureError("the graph has no switches; derive it and make a simulator of that")
    return SwitchedSimulator(simulator(equations, parameters, laws, backend))
