"""A run of a simulator done again, with accounts integrated on the way."""

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp

from bondgraph.equations import StateEquations
from bondgraph.errors import SignalError
from codegen.corners.located import with_corners
from codegen.energy.accounts import Account, Product
from codegen.energy.ledger import Integrated
from codegen.energy.stored import stored_energy
from codegen.energy.tally import Tally, vector_of
from codegen.inputs.signal import Signal
from codegen.model.exact_values import at_parameters
from codegen.model.snapshot import Mode, Snapshot
from codegen.model.sources import source_signals
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array, read_only
from codegen.numbers.lambdified import lambdified
from codegen.program.layout import places
from codegen.program.lower import lower
from codegen.record.columns import named_columns
from codegen.record.snapshots import snapshots
from codegen.runs.hybrid import run_hybrid
from codegen.runs.track import Settings


@dataclass(frozen=True)
class Run:
    """What a run was given; ``laws``: over those declared. ``start``: the vector at the first sample."""

    laws: Mapping[Any, object] | None
    parameters: Mapping[str, sp.Rational]
    times: Array
    start: Array
    signals: tuple[Signal, ...]
    settings: Settings
    #: The mode before the first sample.
    first: Mode

    def again(self, equations: StateEquations, whole: Sequence[Account]) -> Integrated:
        """The run once more, in Python, with accounts integrated."""
        model = closed_model(equations, self.laws, self.parameters)
        tally = tally_of(model, whole, self.times)
        begin, end = float(self.times[0]), float(self.times[-1])
        signals = [
            *self.signals,
            *source_signals(model.program, model.parameters, begin, end, found=True),
        ]
        with np.errstate(all="ignore"):
            run = run_hybrid(
                model, self.times, self.start, signals, self.settings, tally, self.first
            )
            shots = snapshots(model.within(run.track), self.times, signals, run.track)
        _, observer = named_columns(model, self.times, shots)
        rows = np.array(tally.rows)
        totals = read_only(rows[:, :-2] @ shares(whole))
        impacts, renewed = (read_only(rows[:, at]) for at in (-2, -1))
        return Integrated(totals, impacts, renewed, observer)


def closed_model(
    equations: StateEquations, laws: Mapping[Any, object] | None,
    parameters: Mapping[str, sp.Rational],
) -> ClosedModel:  # fmt: skip
    """The model of a run, with more signals told."""
    return ClosedModel(
        with_corners(lower(equations, laws, parameters, timed=True)), equations, parameters
    )


def tally_of(model: ClosedModel, whole: Sequence[Account], times: Array) -> Tally:
    """What integrates accounts through a run of a model."""
    at = places(model.program)
    products = [product for account in whole for product in account]
    one = [at[product.one] for product in products]
    other = [at[product.other] if product.other else None for product in products]
    stored, bent = _stored(model, products), _bent(model, products)
    return Tally(model, one, other, stored, held_in(model), times, bent)


def _bent(
    model: ClosedModel, products: Sequence[Product]
) -> dict[int, tuple[int, Callable[[float], float]]]:
    """Of powers of storages whose laws are turned round the place of what rules each, and what it holds."""
    at, found = places(model.program), dict[int, tuple[int, Callable[[float], float]]]()
    for port in model.equations.reduction.structure.ports:
        element, ruling = port.element, port.element.co_energy
        if (
            element.inverse is None
            or ruling is None
            or not (element.by_inverse or not port.integral)
        ):
            continue
        holds = lambdified([ruling], at_parameters(element.inverse, model.parameters))
        names = {port.given.name, port.received.name}
        for k, product in enumerate(products):
            if {product.one, product.other} == names:
                found[k] = at[ruling.name], holds
    return found


def _stored(model: ClosedModel, products: Sequence[Product]) -> Array:
    """Which products are those of storages."""
    ports = model.equations.reduction.structure.ports
    names = {name.name for p in ports if p.element.kind.stores for name in (p.given, p.received)}
    return np.array([p.one in names and p.other in names for p in products], dtype=bool)


def shares(whole: Sequence[Account]) -> Array:
    """From products to accounts."""
    rows = [
        np.eye(1, len(whole), k) * product.share
        for k, account in enumerate(whole)
        for product in account
    ]
    return np.vstack(rows) if rows else np.zeros((0, len(whole)))


def held_in(model: ClosedModel) -> Callable[[float, Snapshot], float]:
    """What all storages with an energy of their own hold together at an instant."""
    energies = []
    ports = model.equations.reduction.structure.ports
    found: dict[Hashable, None] = dict.fromkeys(
        p.element.owner or p.element.name for p in ports if p.element.kind.stores
    )
    for node in found:
        try:
            energy = stored_energy(model.equations, node, model.parameters)
        except SignalError:
            continue
        energies.append(energy)
    total, at = sp.Add(*energies), places(model.program)
    names = sorted(total.free_symbols, key=str)
    function = lambdified(names, total)

    def held(t: float, now: Snapshot) -> float:
        vector = vector_of(now)
        known = [vector[at[name.name]] if name.name in at else t for name in names]
        return float(function(*known))

    return held
