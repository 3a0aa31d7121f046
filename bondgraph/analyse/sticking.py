"""`holding_efforts`: what holds ports that stick, over states, inputs and the rates of inputs."""

from collections.abc import Hashable, Iterable, Mapping, Sequence
from types import MappingProxyType

import sympy as sp

from bondgraph.algebra.exact import Row, add_scaled
from bondgraph.algebra.tidy import tidy
from bondgraph.analyse.constrained import echelon, multiplied
from bondgraph.analyse.holding import balances_of, listed, solve_for, split, stuck_ports
from bondgraph.analyse.input_rates import InputRates
from bondgraph.analyse.turned import turned
from bondgraph.equations import StateEquations
from bondgraph.errors import DependentSourceError, StructureError
from bondgraph.nodes.laws import DryFriction, ExpressionLaw
from bondgraph.reduce.rates import resolved
from bondgraph.reduce.record import Reading, ReadingSum
from bondgraph.reduce.structure import Port


def holding_efforts(
    equations: StateEquations, stuck: Iterable[Hashable]
) -> Mapping[sp.Symbol, sp.Expr]:
    """What holds the ports of ``stuck`` (nodes, switches too), over states, other inputs and their rates.

    A port that gives its effort gives what keeps its slip at zero, jointly with the others: from
    ``F_s A^-1 (J x + B u + E u') + D_s u' = 0``, or, where a resistance lies beside them, from
    ``F_s x + D_s u = 0`` (Deur, Hancock, Assadian 2008, eq. (8) and the stiction torques of Fig. 9). One
    that gives its flow (friction directly on a spring) has a slip of zero, and what holds it is the effort
    that it receives. An open port on a spring is taken so too; the spring is then a state. Switches and
    expressions that give a flow give what keeps their effort at zero. The rate of an input u is the symbol
    ``d_u``, as in `explicit`; that of a known law its own slope, other names in it being constant.

    Raises `StructureError` for unknown ports and for redundant ones, whose efforts are not unique;
    `DependentSourceError` where inputs alone rule a slip, where a port that sticks drives a dependent
    storage, and where the rate of what a law gives cannot be told.

    >>> import bondgraph as bg, networkx as nx
    >>> g = nx.DiGraph()
    >>> g.add_nodes_from([bg.Se("push", "P"), bg.One("block"), bg.I("m", "m"), bg.R("ground", effort="F")])
    >>> g.add_edges_from([("push", "block"), ("block", "m"), ("block", "ground")])
    >>> dict(holding_efforts(bg.derive(g), ["ground"]))
    {F: P}
    """
    told = stuck if isinstance(stuck, str) or not isinstance(stuck, Iterable) else [*stuck]
    equations = _with_springs(equations, told)
    ports = stuck_ports(equations, told, {one.name: one.port for one in equations.plain_switches})
    if equations.varying:
        raise StructureError(
            "values of this graph change in time, and with them what a port must give: hold it in a run"
        )
    return MappingProxyType(_Sticking(equations, ports).holding())


def _with_springs(equations: StateEquations, told: object) -> StateEquations:
    """With open ports that stick and drive dependent storages turned, as friction over them would be."""
    names = told if isinstance(told, list) else []
    free = [p.element.name for p in equations.ports if p.element.law is None]
    return turned(equations, {name: DryFriction(0) for name in names if name in free})


def _gives_slip(equations: StateEquations, port: Port) -> bool:
    """Whether it sticks by a flow of zero: what gives its flow and is no switch and under no expression."""
    law = equations.laws.get(port.element.name)
    return port.element.kind.resists and port.gives == "flow" and not isinstance(law, ExpressionLaw)


class _Sticking:
    """Ports that stick in equations: ``held`` by what they give, ``sliders`` by what they receive."""

    def __init__(self, equations: StateEquations, ports: Sequence[Port]) -> None:
        self._ports = ports
        self._sliders = [port for port in ports if _gives_slip(equations, port)]
        self._held = [port for port in ports if port not in self._sliders]
        self._rates = InputRates(equations, [port.element.name for port in ports])
        self._equations = self._rates.equations
        place = self._equations.inputs.index
        self._columns = [place(port.given) for port in self._held]
        self._zero = {place(port.given) for port in self._sliders}
        A, balances = balances_of(self._equations)
        self._system = A, [self._without(row) for row in balances]

    def holding(self) -> dict[sp.Symbol, sp.Expr]:
        """What holds each port, by the symbol of what it gives or, of a slider, receives."""
        direct, bound, _ = split([self._received(port) for port in self._held], self._columns)
        self._check(bound)
        rows = [*direct, *(self._settled(Reading({}, {}, row.F, row.D)) for row in bound)]
        solved = solve_for(
            [self._flat(row) for row in rows],
            self._columns,
            len(self._equations.states),
            self._held,
        )
        found = {p.given: row for p, row in zip(self._held, solved, strict=True)}
        found |= {port.received: self._slider(port, solved) for port in self._sliders}
        symbols = [p.received if p in self._sliders else p.given for p in self._ports]
        return {symbol: self._sum(found[symbol]) for symbol in symbols}

    def _slider(self, port: Port, solved: Sequence[Row]) -> Row:
        """What a slider receives, what holds the others put in."""
        row, n = self._flat(self._received(port)), len(self._equations.states)
        inside = {at: row.D.get(j, sp.Integer(0)) for at, j in enumerate(self._columns)}
        total: Row = dict(row.F)
        total |= {n + j: e for j, e in row.D.items() if j not in self._columns}
        add_scaled(total, multiplied(inside, solved), sp.Integer(1))
        return total

    def _received(self, port: Port) -> Reading:
        return self._settled(self._equations.readings[port.received])

    def _settled(self, row: Reading) -> Reading:
        """Over states, inputs and the rates of open ones, and of known laws by the time alone."""
        first = self._opened(row)
        late = self._opened(Reading({}, {}, first.H, {}))
        total = ReadingSum(Reading(first.F, first.D, {}, first.K))
        total.add(late, sp.Integer(1))
        if total.H or any(j in self._columns for j in total.K):
            raise self._driving()
        return total.whole()

    def _opened(self, row: Reading) -> Reading:
        return self._without(self._rates.opened(resolved(*self._system, self._without(row))))

    def _without(self, row: Reading) -> Reading:
        """With slips of zero at the sliders."""
        D, K = ({j: e for j, e in part.items() if j not in self._zero} for part in (row.D, row.K))
        return Reading(row.F, D, row.H, K)

    def _flat(self, row: Reading) -> Reading:
        """With rates of inputs as further inputs."""
        count = len(self._equations.inputs)
        return Reading(row.F, {**row.D, **{count + j: e for j, e in row.K.items()}}, {}, {})

    def _driving(self) -> DependentSourceError:
        return DependentSourceError(
            f"what holds {listed(self._ports)} depends on the rate of what drives a dependent storage; "
            "put a storage or a resistance between, or simulate it"
        )

    def _check(self, bound: Sequence[Reading]) -> None:
        """Refuse slips that no state rules, and those that would need the rate of a rate."""
        if any(row.K for row in bound):
            raise self._driving()
        states, inputs = len(self._equations.states), len(self._equations.inputs)
        matrix = sp.zeros(len(bound), states + inputs)
        for i, row in enumerate(bound):
            for j, entry in (*row.F.items(), *((states + j, e) for j, e in row.D.items())):
                matrix[i, j] = entry
        if any(pivot >= states for pivot in echelon(matrix)[1]):
            raise DependentSourceError(
                f"inputs alone rule what is to be held at {listed(self._held)}, so that no port can hold "
                "it; leave one of them free, or put a storage between"
            )

    def _sum(self, row: Row) -> sp.Expr:
        equations = self._equations
        rates = [self._rates.symbol(name) for name in equations.inputs]
        variables = [*equations.states, *equations.inputs, *rates]
        return tidy(sp.Add(*(entry * variables[at] for at, entry in sorted(row.items()))))
