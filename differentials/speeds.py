"""What a differential's F alone tells: at which speeds its clutches do not slip."""

from collections.abc import Mapping
from types import MappingProxyType

import sympy as sp

import bondgraph as bg
from bondgraph.algebra.tidy import tidy


def zero_slip_ratios(equations: bg.StateEquations) -> Mapping[sp.Symbol, sp.Expr]:
    """Per slip the speed ratio at which it changes sign: a wheel's speed over that of the others.

    The wheel is the first that the slip depends on, the others turn alike. Of a torque vectoring
    differential this is the allowable wheel speed difference (AWSD): beyond that ratio a clutch
    transfers torque the other way, so the faster wheel can't be driven any more.

    Raises `SignalError` for a slip that is no function of the speeds alone, or of one speed alone.

    >>> from differentials.topologies import equations as paper
    >>> ratios = zero_slip_ratios(paper("superposition_tvd"))
    >>> {str(slip): ratio for slip, ratio in ratios.items()}
    {'omega_f1': (2 - h1)/h1, 'omega_f2': (2 - h2)/h2}
    """
    if equations.D.todok() or equations.G.todok():
        raise bg.SignalError("a slip shows inputs; the ratio is a matter of speeds alone")
    found: dict[sp.Symbol, sp.Expr] = {}
    for at, slip in enumerate(equations.outputs):
        entries = [entry for _, entry in sorted(equations.F.row(at).todok().items())]
        if len(entries) < 2:
            raise bg.SignalError(f"{slip} depends on {len(entries)} speed(s); a ratio needs two")
        found[slip] = tidy(-sp.Add(*entries[1:]) / entries[0])
    return MappingProxyType(found)
