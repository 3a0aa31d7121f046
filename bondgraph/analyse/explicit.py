"""`explicit`: every state's rate as one expression, laws put in; in co-energy or energy states."""

from collections.abc import Hashable, Mapping
from typing import Any

import sympy as sp

from bondgraph.algebra.exact import Row, solve
from bondgraph.algebra.expressions import TIME
from bondgraph.algebra.tidy import tidy
from bondgraph.analyse.closures import merged_laws
from bondgraph.analyse.holding import balances_of
from bondgraph.analyse.input_rates import rate_symbol
from bondgraph.analyse.turned import turned
from bondgraph.declare.laws import ExpressionLaw
from bondgraph.equations import StateEquations
from bondgraph.errors import AlgebraicLoopError, StructureError
from bondgraph.named import Named
from bondgraph.reduce.motion import slope_of
from bondgraph.reduce.rates import resolved
from bondgraph.reduce.record import Reading

LARGEST = 40
"""The inverse of a larger A is too long to be read, and grows as its determinant does."""


class Rates(Named[sp.Symbol, sp.Expr]):
    """Each state to its rate; ``print`` and notebooks show them as equations."""

    def __str__(self) -> str:
        from bondgraph.show.formulas import rates_text

        return rates_text(self)

    def _repr_pretty_(self, printer: Any, cycle: bool) -> None:
        printer.text(str(self))

    def _repr_latex_(self) -> str | None:
        from bondgraph.show.formulas import rates_latex

        return rates_latex(self)


def explicit(
    equations: StateEquations, laws: Mapping[Any, object] | None = None, energy: bool = False
) -> Rates:
    """``x' = f(x, u, t)``: each state, those of laws and detectors included, to its rate.

    A mapping, which notebooks and ``print`` show as equations; ``found["v"]`` is the rate of v.

    ``laws``: as for a simulator. Ports with dry friction and switches stay inputs, by what they give. The
    rate of an input u is the symbol ``d_u``. ``energy``: in momenta ``p_<node>`` and displacements
    ``q_<node>`` instead of the flows and efforts of linear storages, whose values must then be constant.

    Raises `StructureError` above 40 states, `AlgebraicLoopError` where laws determine one another at once.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("force", "F"), bg.One("j"), bg.I("m", "m", flow="v"),
    ...                   bg.C("k", law="k*q_k**3")])
    >>> g.add_edges_from([("force", "j"), ("j", "m"), ("j", "k")])
    >>> found = explicit(bg.derive(g))
    >>> dict(found)
    {v: (F - k*q_k**3)/m, q_k: v}
    >>> print(found)
    v' = (F - k*q_k^3)/m
    q_k' = v
    """
    if len(equations.states) > LARGEST:
        raise StructureError(
            f"an explicit form of {len(equations.states)} states is no expression for people (at most "
            f"{LARGEST}); the equations themselves stay sparse: A, J, B, E"
        )
    equations = turned(equations, laws)
    system = _Explicit(equations, laws)
    found = system.rates()
    if energy:
        found = _in_energy_states(equations, found)
    return Rates({state: tidy(rate) for state, rate in found.items()})


class _Explicit:
    """Signals over states and open inputs, laws put in one after the other."""

    def __init__(self, equations: StateEquations, laws: Mapping[Any, object] | None) -> None:
        merged = merged_laws(equations, {} if laws is None else laws)
        ports = {port.element.name: port for port in equations.ports}
        closed = {n: law for n, law in merged.items() if isinstance(law, ExpressionLaw)}
        read = {name for law in closed.values() for name in law.free_symbols}
        self._laws = {ports[name].given: law for name, law in closed.items()}
        self._owner: dict[sp.Symbol, Hashable] = {ports[n].given: n for n in closed}
        self._own = {law.state: ports[n].received for n, law in closed.items() if law.state}
        self._own |= dict(equations.integrals)
        self._equations = equations.with_readings({*read, *self._own.values()})
        self._own_names = {*equations.states, *equations.inputs}
        self._known: dict[sp.Symbol, sp.Expr] = {}

    def rates(self) -> dict[sp.Symbol, sp.Expr]:
        """x' by ``A^-1``, the rates of laws' and detectors' states by what they receive."""
        equations = self._equations
        A, balances = balances_of(equations)
        n, m = len(equations.states), len(equations.inputs)
        right: list[Row] = []
        for row in balances:
            line = dict(row.F) | {n + j: e for j, e in row.D.items()}
            right.append(line | {n + m + j: e for j, e in row.K.items()})
        solved = solve(A, right) if n else []
        found = {
            state: self._sum(Reading(
                {j: e for j, e in row.items() if j < n},
                {j - n: e for j, e in row.items() if n <= j < n + m}, {},
                {j - n - m: e for j, e in row.items() if j >= n + m},
            ))
            for state, row in zip(equations.states, solved, strict=True)
        }  # fmt: skip
        return found | {state: self.over_states(name, ()) for state, name in self._own.items()}

    def over_states(self, name: sp.Symbol, above: tuple[sp.Symbol, ...]) -> sp.Expr:
        """A signal over states, open inputs, their rates and the time."""
        if name in self._known:
            return self._known[name]
        if name in above:
            owners = ", ".join(repr(self._owner[n]) for n in above if n in self._owner)
            raise AlgebraicLoopError(
                f"the laws at {owners} determine one another at once, so there is no explicit form; "
                "put a storage between, or run a simulator, which solves them"
            )
        below = (*above, name)
        if name in self._laws:
            law = self._laws[name].expression
            value = law.xreplace({s: self.over_states(s, below) for s in law.free_symbols})
        elif name in self._equations.readings and name not in self._own_names:
            reading = resolved(*balances_of(self._equations), self._equations.readings[name])
            value = self._sum(reading, below)
        else:
            value = name
        self._known[name] = value
        return value

    def _sum(self, row: Reading, above: tuple[sp.Symbol, ...] = ()) -> sp.Expr:
        states, inputs = self._equations.states, self._equations.inputs
        moving = {*self._equations.varying}
        terms = [entry * states[j] for j, entry in row.F.items()]
        terms += [entry * self.over_states(inputs[j], above) for j, entry in row.D.items()]
        terms += [entry * self._input_rate(inputs[j]) for j, entry in row.K.items()]
        total = sp.Add(*terms)
        inner = (total.free_symbols & moving & set(inputs)) - {TIME}
        return total.xreplace({name: self.over_states(name, above) for name in inner})

    def _input_rate(self, name: sp.Symbol) -> sp.Expr:
        """``d_u`` of an open input; a known law's own slope in time and along what it reads."""
        if name not in self._laws:
            return rate_symbol(name)
        law = self._laws[name].expression
        inner = sorted(law.free_symbols & set(self._equations.inputs), key=str)
        slopes = [slope_of(law, other) * self._input_rate(other) for other in inner]
        return sp.Add(slope_of(law, TIME), *slopes) if TIME in law.free_symbols else sp.Add(*slopes)


def _in_energy_states(
    equations: StateEquations, rates: Mapping[sp.Symbol, sp.Expr]
) -> dict[sp.Symbol, sp.Expr]:
    """Rates of momenta and displacements, over these: ``pi = M x``."""
    if equations.varying:
        raise StructureError(
            "values of this graph change in time; its energy states are kept where storages have a law"
        )
    ports = equations.reduction.structure.ports
    M: list[Row] = []
    names: list[sp.Symbol] = []
    columns = {ports[port].element.name: at for at, port in enumerate(equations.reduction.states)}
    for port in equations.reduction.states:
        element = ports[port].element
        row = element.row or ((element.name, element.constant),)
        missing = [other for other, value in row if other not in columns and value != 0]
        if missing:
            raise StructureError(
                f"the field {element.owner!r} has dependent ports, so its momenta are no states of their own"
            )
        M.append({columns[other]: value for other, value in row if value != 0})
        letter = element.kind.letter
        names.append(sp.Symbol(f"{letter}_{str(element.name).replace('.', '_')}"))
    solved = solve(M, [{i: sp.Integer(1)} for i in range(len(M))]) if M else []
    inverse = [sp.Add(*(e * names[j] for j, e in row.items())) for row in solved]
    put_in = dict(zip(equations.states, inverse, strict=True))
    result: dict[sp.Symbol, sp.Expr] = {}
    for name, line in zip(names, M, strict=True):
        rate = sp.Add(*(value * rates[equations.states[j]] for j, value in line.items()))
        result[name] = rate.xreplace(put_in)
    others = {state: rate for state, rate in rates.items() if state not in put_in}
    return result | {state: rate.xreplace(put_in) for state, rate in others.items()}
