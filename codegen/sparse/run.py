"""Runs of sparse models: tens of thousands of states."""

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from bondgraph.errors import SignalError, SimulationError
from bondgraph.nodes.tasks import Transition
from codegen.called.function import followed
from codegen.energy.audit import Audit
from codegen.inputs.signal import Signal
from codegen.numbers.arrays import Array, read_only
from codegen.record.result import Result
from codegen.runs.arguments import (
    checked_times,
    initial_values,
    named_numbers,
    settings_of,
    signals_for,
)
from codegen.runs.methods import EXACT
from codegen.sparse.model import SparseModel
from codegen.sparse.steps import SparseSystem, integrate
from codegen.tuning import TUNING

NO_POWERS = "a sparse run knows no powers; derive the graph and run a simulator for them"


@dataclass(frozen=True)
class Recorded:
    """A run of which the states, inputs and outputs were recorded, and what storages of states ``held``."""

    columns: Mapping[str, Array]
    held: Mapping[str, tuple[str, float]]

    def names(self) -> tuple[str, ...]:
        """What is held, beside the columns."""
        return tuple(self.held)

    def nodes(self) -> tuple[Hashable, ...]:
        """None: no events happen."""
        return ()

    def transitions(self) -> tuple[Transition, ...]:
        """None: it has no state machines."""
        return ()

    def signal(self, name: str) -> Array:
        """What a state's storage holds; refuses else: what was not recorded cannot be worked out."""
        if name in self.held:
            state, value = self.held[name]
            return value * self.columns[state]
        raise KeyError(f"{name!r} was not recorded; name its node in outputs of sparse_model")

    def bond(self, tail: Hashable, head: Hashable) -> tuple[Array, Array]:
        """Refuses, as `signal`."""
        raise KeyError(f"bond {tail!r} -> {head!r} was not recorded; name its nodes in outputs")

    def power(self, node: Hashable) -> Array:
        """Refuses, as `signal`."""
        raise KeyError(f"the power at {node!r} was not recorded; name the node in outputs")

    def energy(self, node: Hashable) -> Array:
        """Refuses, as `signal`."""
        raise KeyError(f"the energy of {node!r} was not recorded; its state was")

    def work(self, node: Hashable) -> Array:
        """Refuses: powers are not recorded."""
        raise SignalError(f"the work at {node!r} was not recorded: {NO_POWERS}")

    def integral(self, name: str) -> Array:
        """Refuses, as `work`."""
        raise SignalError(f"the integral of {name!r} was not recorded: {NO_POWERS}")

    def audit(self) -> Audit:
        """Refuses, as `work`."""
        raise SignalError(f"the power balance was not recorded: {NO_POWERS}")


def run_sparse(
    model: SparseModel,
    time: ArrayLike,
    initial: Mapping[str, float] | None = None,
    inputs: Mapping[str, object] | None = None,
    method: str = "auto",
    rtol: float = TUNING.sparse_rtol,
    atol: float = TUNING.sparse_atol,
) -> Result:
    """Integrate a sparse model over the given times [s] and sample states, inputs and outputs at them.

    ``initial`` and ``inputs`` as for `Simulator.run`; of what storages hold those of states. ``method``:
    "DOP853", "Radau" (stiff models, and long runs), or "auto". Memory is that of the samples and of the
    factors of A and J.

    Raises `SignalError` for unusable arguments, `SimulationError` if the run can't go on.

    >>> import bondgraph as bg, networkx as nx
    >>> from codegen import sparse_model
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("force", "F"), bg.One("mass"), bg.I("m", "m", flow="v"), bg.R("damper", "b")])
    >>> g.add_edges_from([("force", "mass"), ("mass", "m"), ("mass", "damper")])
    >>> model = sparse_model(g, {"m": 2, "b": 3})
    >>> run_sparse(model, [0, 1, 100], inputs={"F": 6})["v"].round(7).tolist()
    [0.0, 1.5537397, 2.0]
    """
    times, settings = checked_times(time), settings_of(method, rtol, atol)
    if method == EXACT:
        raise SignalError("sparse models are integrated; let method be auto, DOP853 or Radau")
    state = initial_values(_by_states(model, {} if initial is None else initial), model.states)
    asked = tuple(name for name in model.inputs if name not in model.known)
    told = followed({} if inputs is None else inputs, times)
    given = dict(zip(asked, signals_for(told, asked), strict=True))
    signals = [given[name] if name in given else model.known[name] for name in model.inputs]
    _check_steps(model, signals, times)
    with np.errstate(all="ignore"):
        system = SparseSystem(model.A, model.J)
        driven = system.solve(model.E.toarray()) if model.E.nnz else np.zeros(model.E.shape)
        vectors = _vectors(
            model, system, driven, times, state, signals, settings.method, rtol, atol
        )
        columns = _columns(model, system, driven, times, vectors, signals)
    recorded = Recorded(MappingProxyType(columns), model.held)
    return Result(
        times, model.states, asked, model.outputs, (), MappingProxyType(columns), recorded, recorded
    )


def _by_states(model: SparseModel, initial: Mapping[str, float]) -> Mapping[str, float]:
    """Initial values with what storages hold turned into the states that hold it."""
    if not isinstance(initial, Mapping):
        return initial
    told = named_numbers(initial, (*model.states, *model.held))
    found = {name: value for name, value in told.items() if name not in model.held}
    for name in told.keys() & model.held.keys():
        state, value = model.held[name]
        if state in found:
            raise SignalError(f"initial {name}: it is {value:.9g}*{state}, which is told, too")
        found[state] = told[name] / value
    return found


def _vectors(
    model: SparseModel, system: SparseSystem, driven: Array, times: Array, state: Array,
    signals: Sequence[Signal], method: str, rtol: float, atol: float,
) -> Array:  # fmt: skip
    """What is integrated, ``v = x - A^-1 E u``, at every sample."""
    t, end = float(times[0]), float(times[-1])
    v = state - driven @ np.array([signal(t) for signal in signals])
    forcing = model.B + model.J @ driven if model.E.nnz else model.B
    found: list[Array] = []
    while t < end:
        stop = min([end, *(signal.following(t) for signal in signals)])
        pieces = [signal.piece(t) for signal in signals]

        def forced(time: float, pieces: list = pieces) -> Array:  # type: ignore[type-arg]
            return np.asarray(forcing @ np.array([piece(time) for piece in pieces]))

        fastest = max((piece.fastest for piece in pieces), default=0.0)
        solver = system.stepper(forced, t, v, stop, method, rtol, atol, fastest)
        v = integrate(solver, times[len(found) :], stop, found.append)
        t = stop
    found.append(v)
    return np.array(found)


def _columns(
    model: SparseModel, system: SparseSystem, driven: Array, times: Array, vectors: Array,
    signals: Sequence[Signal],
) -> dict[str, Array]:  # fmt: skip
    """States, inputs and outputs by name."""
    u = np.array([[signal(t) for signal in signals] for t in times.tolist()]).reshape(
        len(times), -1
    )
    x = vectors + u @ driven.T
    y = (model.F @ x.T + model.D @ u.T).T
    if model.H.nnz or model.K.nnz:
        pieces = [[signal.piece(t) for signal in signals] for t in times.tolist()]
        du = np.array([
            [piece.derivative(t) for piece in row] for t, row in zip(times.tolist(), pieces, strict=True)
        ]).reshape(len(times), -1)  # fmt: skip
        dx = system.solve(np.asarray(model.J @ x.T + model.B @ u.T + model.E @ du.T))
        y = y + (model.H @ dx + model.K @ du.T).T
    columns: dict[str, Array] = {}
    for names, table in ((model.states, x), (model.inputs, u), (model.outputs, y)):
        for at, name in enumerate(names):
            columns.setdefault(name, read_only(np.ascontiguousarray(table[:, at])))
    return columns


def _check_steps(model: SparseModel, signals: Sequence[Signal], times: Array) -> None:
    """Refuse steps of inputs whose rate an output shows: it would be an impulse."""
    shows = set(model.K.nonzero()[1].tolist())
    if model.H.nnz:
        shows |= set(model.E.nonzero()[1].tolist())
    for at in sorted(shows):
        step = signals[at].first_jump(float(times[0]), float(times[-1]))
        if step is not None:
            raise SimulationError(
                f"input {model.inputs[at]!r} steps at t = {step:g}, where an output shows its rate and "
                "would be an impulse; smooth it with Lag or Ramp"
            )
