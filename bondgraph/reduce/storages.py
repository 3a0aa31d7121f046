"""What storages give back: the rates of momenta and displacements over states, inputs and their rates."""

import sympy as sp

from bondgraph.algebra.exact import FixedRow, add_scaled
from bondgraph.errors import CausalityError
from bondgraph.reduce.record import Reading, ReadingSum
from bondgraph.reduce.sorting import Reduction, field_row


def stored_rate(reduction: Reduction, port: int) -> Reading:
    """The rate of a linear storage's momentum or displacement, ``(sum_j M_ij v_j)'``.

    v_j is the state of a port with integral causality; of a dependent one it is what states and inputs
    make it. Where the momentum itself is the state, it is that. The sum has more than one term in fields
    alone.
    """
    if port in reduction.energies:
        return Reading({}, {}, {reduction.columns_of_states[port]: sp.Integer(1)}, {})
    result = ReadingSum()
    element = reduction.structure.ports[port].element
    if element.inverse is not None and reduction.motion is not None:
        _add_inverse_rate(reduction, port, result)
        return result.whole()
    for other, value in field_row(reduction, port):
        if other in reduction.columns_of_states:
            ruled = Reading({reduction.columns_of_states[other]: sp.Integer(1)}, {}, {}, {})
        else:
            ruled = _ruled(reduction, other)
        add_scaled(result.H, ruled.F, value)
        add_scaled(result.K, ruled.D, value)
    if reduction.motion is not None:
        # What the products gain goes to H and K itself, so their entries are listed first.
        products = [(reduction.names[j], entry) for j, entry in result.H.items()]
        products += [(reduction.inputs[j], entry) for j, entry in result.K.items()]
        for symbol, entry in products:
            reduction.motion.add_rate(result, entry, symbol)
    return result.whole()


def _add_inverse_rate(reduction: Reduction, port: int, result: ReadingSum) -> None:
    """The rate of what a nonlinear storage holds, as a function of what its law gives."""
    name, motion = reduction.structure.ports[port].element.name, reduction.motion
    if motion is None:
        raise CausalityError(f"the law at {name!r} has no inverse")
    motion.add_total_rate(result, stored(reduction, port), name)


def stored(reduction: Reduction, port: int) -> sp.Expr:
    """The momentum or displacement in a storage, over states and inputs; `stored_rate` is its rate."""
    if port in reduction.energies:
        return reduction.energies[port].symbol
    one = reduction.structure.ports[port]
    inverse = one.element.inverse
    if inverse is None:
        return sp.Add(*(m * _moving(reduction, at) for at, m in field_row(reduction, port)))
    # In integral causality the variable that the inverse is of is the state itself.
    return inverse if one.integral else inverse.xreplace({one.received: _moving(reduction, port)})


def stored_behind(reduction: Reduction, row: FixedRow) -> sp.Expr:
    """What a signal shows of what dependent storages hold, over states and inputs: its rate is part of it."""
    found = [(entry, d) for d, entry in row.items() if d in reduction.dependent]
    return sp.Add(*(entry * stored(reduction, d) for entry, d in found))


def _moving(reduction: Reduction, port: int) -> sp.Expr:
    """The flow of an inertia, or the effort of a compliance."""
    if port in reduction.columns_of_states:
        return reduction.names[reduction.columns_of_states[port]]
    ruled = _ruled(reduction, port)
    terms = [entry * reduction.names[j] for j, entry in ruled.F.items()]
    return sp.Add(*terms, *(entry * reduction.inputs[j] for j, entry in ruled.D.items()))


def _ruled(reduction: Reduction, port: int) -> Reading:
    """What a dependent storage receives, ruled by states and inputs alone."""
    structure = reduction.structure
    row = structure.rows[port]
    free = {*reduction.dependent, *reduction.resistive}
    strangers = [i for i in row if i in free]
    if strangers:
        names = [structure.ports[i].element.name for i in (port, *strangers)]
        raise CausalityError(
            f"storages and resistances {names} determine each other although one of them could "
            "have integral causality; please report this graph"
        )
    return reduction.reading(row)
