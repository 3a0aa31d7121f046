"""What a run's power is told by: of each one-port the products of signals that it is made of."""

from collections.abc import Hashable, Iterable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import NamedTuple

import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.equations import StateEquations
from bondgraph.errors import StructureError
from bondgraph.reduce.record import Reading, ReadingSum
from bondgraph.reduce.sorting import field_row, is_storage
from bondgraph.reduce.structure import Port


class Product(NamedTuple):
    """A share of the power: a number times one signal times another; times one signal if that is "".

    Signals are named; an integral is a product with nothing.
    """

    share: float
    one: str
    other: str


Account = tuple[Product, ...]
"""What is integrated as one."""


@dataclass(frozen=True)
class Accounts:
    """The one-ports of a graph and what each takes, or gives if it is a source.

    ``equations``: with every signal of the products among their readings. ``power``: into each one-port,
    out of a source; a field's is the sum of its ports'. ``moved``: into storages by the motion of their
    values, half the value's rate times the square of the co-energy variable. ``owners``: of a field's ports
    the field. Two-ports, junctions and detectors take nothing.
    """

    equations: StateEquations
    power: Mapping[Hashable, Account]
    moved: Mapping[Hashable, Account]
    owners: Mapping[Hashable, Hashable]

    def parts(self, node: Hashable) -> list[Hashable]:
        """The ports of a field; of anything else itself."""
        return [part for part, owner in self.owners.items() if owner == node] or [node]

    def of(self, node: Hashable) -> Account:
        """What makes up a one-port's power, or a field's; `StructureError` for anything else."""
        found = [self.power[part] for part in self.parts(node) if part in self.power]
        if not found:
            raise StructureError(
                f"{node!r} is not a one-port of the graph; only those have a power"
            )
        return tuple(product for account in found for product in account)


def accounts(equations: StateEquations) -> Accounts:
    """The accounts of a graph's one-ports."""
    ports = equations.reduction.structure.ports
    power = {port.element.name: (_power(port),) for port in ports}
    readings, moved = dict(equations.readings), {}
    for at, port in enumerate(ports):
        reading = _moved(equations, at)
        if reading is not None:
            name = _free(f"moved_{at}", equations)
            readings[name] = reading
            variable = port.given if port.integral else port.received
            moved[port.element.name] = (Product(0.5, variable.name, name.name),)
    products = [p for account in (*power.values(), *moved.values()) for p in account]
    told = replace(equations, readings=MappingProxyType(readings))
    return Accounts(
        told.with_readings({sp.Symbol(name) for p in products for name in (p.one, p.other)}),
        MappingProxyType(power),
        MappingProxyType(moved),
        MappingProxyType({p.element.name: p.element.owner for p in ports if p.element.owner}),
    )


def with_signals(made: Accounts, names: Iterable[str]) -> Accounts:
    """The same accounts, whose equations also know these signals."""
    return replace(made, equations=made.equations.with_readings(map(sp.Symbol, names)))


def _power(port: Port) -> Product:
    supplies = port.element.kind.supplies and port.inward == 1
    return Product(-1.0 if supplies else 1.0, port.given.name, port.received.name)


def _moved(equations: StateEquations, at: int) -> Reading | None:
    """``sum_j M_ij' v_j`` of a linear storage whose value moves; None for all others."""
    reduction = equations.reduction
    port, motion = reduction.structure.ports[at], reduction.motion
    linear = port.element.kind.stores and is_storage(port) and port.element.law is None
    if motion is None or not linear:
        return None
    result = ReadingSum()
    moving = False
    for other, value in field_row(reduction, at):
        moving |= bool(value.free_symbols & {*motion.rates, TIME})
        row = reduction.structure.rows[other]
        if other in reduction.columns_of_states:
            row = {other: sp.Integer(1)}
        ruled = reduction.reading(row)
        for row, names in ((ruled.F, reduction.names), (ruled.D, reduction.inputs)):
            for column, factor in row.items():
                gained = ReadingSum()
                motion.add_rate(gained, value, names[column])
                result.add(gained.whole(), factor)
    return result.whole() if moving else None


def _free(name: str, equations: StateEquations) -> sp.Symbol:
    """A name that nothing in the equations has."""
    taken = {str(s) for s in (*equations.signals, *equations.parameters, *equations.varying)}
    for law in equations.laws.values():
        taken |= {str(s) for s in law.free_symbols}
    while name in taken:
        name += "_"
    return sp.Symbol(name)
