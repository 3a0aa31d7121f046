"""Storages whose laws are turned round: what they receive must be something that their law gives."""

import numpy as np

from bondgraph.errors import SimulationError
from bondgraph.nodes.elements import Element
from codegen.model.exact_values import at_parameters
from codegen.modes.closed import ClosedModel
from codegen.numbers.lambdified import lambdified
from codegen.record.result import Result


def refuse_beyond(model: ClosedModel, done: Result) -> None:
    """Refuse a run in which a storage is given what its law gives in no state, as ``exp(p) - 1`` below -1.

    There its inverse has no value, though the inverse's slope, which is all that equations have, has one. It
    is looked at the samples.

    Raises `SimulationError`, naming the storage and the time.
    """
    for port in model.equations.reduction.structure.ports:
        element = port.element
        turned = element.by_inverse or not port.integral
        if element.kind.stores and element.inverse is not None and turned:
            _refuse(model, done, element)


def _refuse(model: ClosedModel, done: Result, element: Element) -> None:
    given = element.co_energy
    assert given is not None
    assert element.inverse is not None
    inverse = at_parameters(element.inverse, model.parameters)
    names = sorted(inverse.free_symbols, key=str)
    if set(names) - {given}:
        return
    values = done[given.name]
    with np.errstate(all="ignore"):
        states = np.zeros(len(values)) + lambdified(names, inverse)(*[values for _ in names])
    beyond = np.isfinite(values) & ~np.isfinite(states)
    if beyond.any():
        at = int(np.argmax(beyond))
        raise SimulationError(
            f"at t = {done.time[at]:.9g} {given} is {values[at]:.6g}, which the law of {element.name!r} "
            "gives in no state; let the run begin where it does, or let the storage be independent"
        )
