"""What storages give back: the rates of momenta and displacements over states, inputs and their rates."""

import sympy as sp

from bondgraph.algebra.exact import add_scaled
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
    one = reduction.structure.ports[port]
    inverse, motion = one.element.inverse, reduction.motion
    if inverse is None or motion is None:
        raise CausalityError(f"the law at {one.element.name!r} has no inverse")
    # In integral causality the variable that the inverse is of is the state itself.
    if not one.integral:
        ruled = _ruled(reduction, port)
        terms = [entry * reduction.names[j] for j, entry in ruled.F.items()]
        terms += [entry * reduction.inputs[j] for j, entry in ruled.D.items()]
        inverse = inverse.xreplace({one.received: sp.Add(*terms)})
    motion.add_total_rate(result, inverse, one.element.name)


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
