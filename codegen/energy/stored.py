"""What a storage holds, as an expression over the signals of its graph."""

from collections.abc import Hashable, Mapping, Sequence

import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.algebra.lookups import Look
from bondgraph.equations import StateEquations
from bondgraph.errors import SignalError, StructureError
from bondgraph.nodes.laws import ExpressionLaw
from bondgraph.reduce.structure import Port
from codegen.energy.tabled import integral_of
from codegen.model.exact_values import at_parameters


def stored_energy(
    equations: StateEquations, node: Hashable, parameters: Mapping[str, sp.Rational]
) -> sp.Expr:
    """The energy in an I or C or a field of them, 0 where its state is 0.

    Of its co-energy variables, or its energy function; values over states, integrals, inputs and time.

    Raises `StructureError` for what is no storage, `SignalError` for one without an energy of its own.
    """
    ports = equations.reduction.structure.ports
    found = [p for p in ports if node in (p.element.name, p.element.owner)]
    if not found or not found[0].element.kind.stores:
        raise StructureError(f"{node!r} is not an I or a C; only storages have an energy")
    first = found[0].element
    if first.row and first.name == node:
        raise StructureError(
            f"{node!r} is one port of {first.owner!r}; the whole field has an energy"
        )
    if isinstance(first.law, ExpressionLaw):
        return _of_law(equations, found, first.law, parameters)
    return at_parameters(_of_values(found), parameters)


def _of_values(ports: Sequence[Port]) -> sp.Expr:
    """Half the value times the square of the co-energy variable; of fields the quadratic form."""
    ruling = {p.element.name: p.element.co_energy for p in ports}
    terms = []
    for port in ports:
        element = port.element
        for other, entry in element.row or ((element.name, element.constant),):
            terms.append(entry * ruling[element.name] * ruling[other] / 2)
    return sp.Add(*terms)


def _of_law(
    equations: StateEquations, ports: Sequence[Port], law: ExpressionLaw,
    parameters: Mapping[str, sp.Rational],
) -> sp.Expr:  # fmt: skip
    """The energy function, or the integral of a law over its own state from 0."""
    element = ports[0].element
    if element.energy is not None:
        return at_parameters(_held(element.energy, ports), parameters)
    state = law.state
    if state is None or law.free_symbols & {*equations.signals, TIME}:
        raise SignalError(
            f"{element.name!r}: its law reads other signals, so it has no energy of its own; "
            "ask for its work"
        )
    exact = at_parameters(law.expression, parameters)
    real = sp.Dummy("q", real=True)
    shape = exact.xreplace({state: real}).rewrite(sp.Piecewise)
    integral = integral_of(shape, real) if shape.has(Look) else _from_zero(shape, real)
    if integral is None or integral.has(sp.Integral) or integral.free_symbols - {real}:
        raise SignalError(f"{element.name!r}: no closed form of the energy; ask for its work")
    # The inverse has parameters of its own.
    return at_parameters(_held(integral.xreplace({real: state}), ports), parameters)


def _from_zero(shape: sp.Expr, real: sp.Dummy) -> sp.Expr:
    """A law's integral from 0 on: by rules where they do, which for broken powers all else takes minutes."""
    if not shape.has(sp.Piecewise):
        found = sp.integrate(shape, real, manual=True)
        start = found.subs(real, 0)
        if not found.has(sp.Integral) and start.is_finite:
            return found - start
    return sp.integrate(shape, (real, 0, real))


def _held(energy: sp.Expr, ports: Sequence[Port]) -> sp.Expr:
    """An energy over what runs know: the state of a dependent storage is what its inverse tells."""
    told = {
        p.element.law.state: p.element.inverse
        for p in ports
        if isinstance(p.element.law, ExpressionLaw)
        and p.element.inverse is not None
        and (not p.integral or p.element.by_inverse)
    }
    return energy.xreplace(told)
