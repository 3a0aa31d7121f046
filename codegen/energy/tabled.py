"""Integrals of laws that look into tables: those of tables over one axis, of linear arguments."""

import sympy as sp

from bondgraph.algebra.lookups import INTEGRAL, Handle, Look


def integral_of(expr: sp.Expr, name: sp.Symbol) -> sp.Expr | None:
    """The integral from 0 to the name itself; None where there is no closed form.

    >>> from bondgraph.algebra.lookup_table import LookupTable
    >>> q, spring = sp.Symbol("q"), LookupTable("spring", [0, 1, 3], [0, 2, 2])
    >>> energy = integral_of(3*spring(2*q) + q, q)
    >>> float(energy.subs(q, 1)), float(energy.subs(q, 2))
    (5.0, 12.5)
    """
    total = sp.Integer(0)
    for term in sp.Add.make_args(sp.expand(expr)):
        looks = [part for part in sp.Mul.make_args(term) if isinstance(part, Look)]
        if not term.has(Look):
            found = sp.integrate(term, (name, 0, name))
        elif len(looks) == 1 and not (term / looks[0]).has(Look):
            found = _of_look(looks[0], term / looks[0], name)
        else:
            return None
        if found is None or found.has(sp.Integral):
            return None
        total += found
    return total


def _of_look(look: Look, factor: sp.Expr, name: sp.Symbol) -> sp.Expr | None:
    """A factor that does not change times a table over one axis."""
    orders, argument = look.handle.orders, look.places[0]
    if name in factor.free_symbols or len(orders) != 1 or orders == INTEGRAL:
        return None
    if name not in argument.free_symbols:
        return factor * look * name
    rate = sp.diff(argument, name)
    if name in rate.free_symbols or argument.has(Look):
        return None
    whole = Handle(look.handle.table, INTEGRAL if orders == (0,) else (orders[0] - 1,))
    ends = (argument, argument.subs(name, 0))
    return (
        factor
        / rate
        * sp.Add(*(sign * Look(whole, end) for sign, end in zip((1, -1), ends, strict=True)))
    )
