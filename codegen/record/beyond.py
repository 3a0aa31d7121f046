"""Storages whose laws are turned round: what they receive must be something that their law gives."""

from typing import Protocol

import numpy as np

from bondgraph.errors import SimulationError
from bondgraph.nodes.elements import Element
from codegen.model.exact_values import at_parameters
from codegen.modes.closed import ClosedModel
from codegen.numbers.arrays import Array
from codegen.numbers.lambdified import lambdified


class Sampled(Protocol):
    """A run."""

    def __getitem__(self, name: str) -> Array:
        """A signal over its times."""

    @property
    def time(self) -> Array:
        """Of its samples [s]."""


def turned_storages(model: ClosedModel) -> tuple[Element, ...]:
    """The storages whose laws are turned round, of what they receive alone."""
    ports = model.equations.reduction.structure.ports
    found = []
    for port in ports:
        element = port.element
        turned = element.by_inverse or not port.integral
        if element.kind.stores and element.inverse is not None and turned:
            inverse = at_parameters(element.inverse, model.parameters)
            if inverse.free_symbols <= {element.co_energy}:
                found.append(element)
    return tuple(found)


def refuse_all_beyond(model: ClosedModel, done: Sampled) -> None:
    """Refuse a run in which a storage is given what its law gives in no state, as ``exp(p) - 1`` below -1.

    There its inverse has no value, though the inverse's slope, which is all that equations have, has one. It
    is looked at the samples.

    Raises `SimulationError`, naming the storage and the time.
    """
    for element in turned_storages(model):
        refuse_beyond(model, element, done.time, done[str(element.co_energy)])


def refuse_beyond(model: ClosedModel, element: Element, times: Array, values: Array) -> None:
    """The same of one storage, from its co-energy variable at these times [s]."""
    given = element.co_energy
    assert element.inverse is not None
    inverse = at_parameters(element.inverse, model.parameters)
    with np.errstate(all="ignore"):
        names = sorted(inverse.free_symbols, key=str)
        states = np.zeros(len(values)) + lambdified(names, inverse)(*[values for _ in names])
    beyond = np.isfinite(values) & ~np.isfinite(states)
    if beyond.any():
        at = int(np.argmax(beyond))
        raise SimulationError(
            f"at t = {times[at]:.9g} {given} is {values[at]:.6g}, which the law of {element.name!r} "
            "gives in no state; let the run begin where it does, or let the storage be independent"
        )
