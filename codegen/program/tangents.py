"""What held ports receive, written along the tangents of the laws that they see at once.

A port that holds needs the rate of what it receives, ``y = F x + d v``. Where v is what a law of states
gives, ``v = L(x, z, w, t)``, the same value is ``y = (F + d L_x) x + d b`` with ``b = L - L_x x``, what the
law has beyond its tangent, and the rate is ``(F + d L_x) x' + d (L_z z' + L_w w' + L_t)``: the last bracket
is ``b' + L_x' x``. So all factors of x' stand in one row, and what holds a port acts by way of laws, too.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import sympy as sp

from bondgraph.algebra.expressions import TIME
from bondgraph.nodes.laws import ExpressionLaw
from bondgraph.reduce.record import Reading, ReadingSum
from codegen.program.closing import Closing
from codegen.program.sliding import unused
from codegen.program.slopes import NoSlopeError, slope
from codegen.program.totals import Totals
from codegen.program.widened import widened


@dataclass(frozen=True)
class Tangents:
    """``along``: such a reading, by the input that the port gives; ``moved``: its last bracket.

    ``beyond``: the inputs that were added for it, which no result shows.
    """

    along: Mapping[sp.Symbol, sp.Symbol]
    moved: Mapping[sp.Symbol, Reading]
    beyond: tuple[sp.Symbol, ...]
    #: Of jumps that hang on laws readings with other factors where those have theirs, for ranks alone.
    shapes: Mapping[sp.Symbol, sp.Symbol]


@dataclass(frozen=True)
class _Tangent:
    """``slopes``: along x; ``beyond``: the input that is the rest; ``moved``: how that moves on by itself."""

    slopes: Mapping[int, sp.Expr]
    beyond: sp.Symbol
    moved: Reading


def with_tangents(closing: Closing) -> tuple[Closing, Tangents]:
    """The laws over equations that know these readings."""
    seen = {given: columns for given in closing.friction if (columns := _seen(closing, given))}
    if not seen:
        return closing, Tangents({}, {}, (), {})
    made = _Tangents(closing)
    found = {j: one for j in sorted(set().union(*seen.values())) if (one := made.of(j)) is not None}
    told = made.told()
    readings, along = dict(told.equations.readings), dict[sp.Symbol, sp.Symbol]()
    moved, shapes = dict[sp.Symbol, Reading](), dict[sp.Symbol, sp.Symbol]()
    jumps = {jump.mixture for jump in closing.jumps}
    for given, columns in seen.items():
        mine = {j: found[j] for j in columns if j in found}
        if mine:
            received = closing.received[given]
            along[given] = unused(f"along_{received}", made.taken)
            row = closing.equations.readings[received]
            readings[along[given]], moved[given] = _along(row, mine, told.equations.inputs)
            if given in jumps:
                shapes[given] = unused(f"shape_{received}", made.taken)
                readings[shapes[given]] = _shape(readings[along[given]], len(shapes))
    equations = replace(told.equations, readings=MappingProxyType(readings))
    return replace(told, equations=equations), Tangents(along, moved, tuple(made.added), shapes)


def _seen(closing: Closing, given: sp.Symbol) -> list[int]:
    """The columns of laws that a port sees at once, where what holds it can bind states.

    A resistance beside a port lets it hold at once, which takes no slope, unless others see that as well.
    """
    equations = closing.equations
    row = equations.readings[closing.received[given]]
    laws = {name for names, _ in closing.order for name in names}
    answering = {equations.inputs.index(name) for name in (*closing.friction, *closing.coupled)}
    own = {equations.inputs.index(name) for name in (given, *closing.coupled)}
    others = [equations.readings[closing.received[one]] for one in closing.friction if one != given]
    direct = bool(own & set(row.D))
    jumps = any(given == jump.mixture for jump in closing.jumps)
    if not (row.F or jumps) or (
        direct and not any(answering & set(row.D) & set(o.D) for o in others)
    ):
        return []
    return [j for j in row.D if equations.inputs[j] in laws]


def _shape(row: Reading, number: int) -> Reading:
    """The row with numbers as factors that no other row has: which ports bind states together."""
    return Reading({j: sp.Integer(sp.prime(31 * number + j + 5)) for j in row.F}, row.D, {}, {})


def _along(
    row: Reading, tangents: Mapping[int, _Tangent], inputs: Sequence[sp.Symbol]
) -> tuple[Reading, Reading]:
    """A row along the tangents of laws, and how that moves on beside its factors times rates."""
    others = {j: entry for j, entry in row.D.items() if j not in tangents}
    result, moved = ReadingSum(Reading(row.F, others, row.H, row.K)), ReadingSum()
    for j, tangent in tangents.items():
        beyond = {inputs.index(tangent.beyond): sp.Integer(1)}
        result.add(Reading(tangent.slopes, beyond, {}, {}), row.D[j])
        moved.add(tangent.moved, row.D[j])
    return result.whole(), moved.whole()


class _Tangents:
    """The tangents of laws, and the inputs that they are written with: each once."""

    def __init__(self, closing: Closing) -> None:
        equations = closing.equations
        self._closing, self._totals = closing, Totals(closing)
        self.taken = {*equations.signals, *equations.inputs, *equations.readings}
        self.taken |= {*equations.parameters, *closing.law_states, *closing.external}
        self.taken |= set().union(*(law.free_symbols for law in closing.laws.values()))
        self.added: dict[sp.Symbol, ExpressionLaw] = {}
        self._known: list[sp.Symbol] = []
        self._owner: dict[sp.Symbol, sp.Symbol] = {}
        self._copies: dict[sp.Symbol, sp.Symbol] = {}

    def of(self, column: int) -> _Tangent | None:
        """That of what a law gives; None where it has none, which holding is refused for."""
        closing, equations = self._closing, self._closing.equations
        law = equations.inputs[column]
        try:
            total = self._totals.of(law)
            signals = {*equations.states, *equations.inputs, *closing.external}
            signals |= {*closing.law_states, TIME}
            slopes = {
                name: factor for name in sorted(total.free_symbols & signals, key=str)
                if (factor := slope(total, name, signals)) != 0
            }  # fmt: skip
        except NoSlopeError:
            return None
        by_x = {name: slopes.pop(name) for name in equations.states if name in slopes}
        straight = sp.Add(*(factor * name for name, factor in by_x.items()))
        places = {equations.states.index(name): factor for name, factor in by_x.items()}
        constant = not any(factor.free_symbols & signals for factor in by_x.values())
        rest = sp.expand(total - straight) if constant else law
        if not rest.free_symbols & {law, *equations.states, *closing.law_states}:
            # The rest is known, and so is its rate.
            beyond = self._add(law, self._of_inputs(rest), known=True)
            return _Tangent(places, beyond, Reading({}, {}, {}, {}))
        return _Tangent(places, self._add(law, law - straight), self._moved(law, slopes))

    def _of_inputs(self, expr: sp.Expr) -> sp.Expr:
        """What known laws give put in: they are evaluated at once."""
        laws = self._closing.laws
        known = {
            name: law.expression for name in self._closing.known
            if isinstance(law := laws[name], ExpressionLaw)
        }  # fmt: skip
        return expr.xreplace(known)

    def _moved(self, law: sp.Symbol, slopes: Mapping[sp.Symbol, sp.Expr]) -> Reading:
        """``L_z z' + L_w w' + L_t``; inputs for names that are none, and for the time, are added."""
        equations, result = self._closing.equations, ReadingSum()
        for name, factor in slopes.items():
            rate = self._closing.law_states.get(name)
            if rate is not None:
                result.add(equations.readings[rate], factor)
                continue
            if name not in equations.inputs:
                name = self._copy(law, name)
            column = [*equations.inputs, *self.added].index(name)
            result.add(Reading({}, {}, {}, {column: sp.Integer(1)}), factor)
        return result.whole()

    def _copy(self, law: sp.Symbol, name: sp.Symbol) -> sp.Symbol:
        if name not in self._copies:
            self._copies[name] = self._add(law, name, known=True)
        return self._copies[name]

    def _add(self, law: sp.Symbol, value: sp.Expr, known: bool = False) -> sp.Symbol:
        added = unused(f"beyond_{value if value.is_Symbol else law}", self.taken)
        self.added[added], self._owner[added] = ExpressionLaw(value), law
        self._known += [added] if known else []
        return added

    def told(self) -> Closing:
        """The laws with the inputs that were added, which drive nothing."""
        closing, equations = self._closing, self._closing.equations
        late = [name for name in self.added if name not in self._known]
        return replace(
            closing,
            equations=widened(equations, (*equations.inputs, *self.added), {}, equations.readings),
            laws={**closing.laws, **self.added},
            port_names={**closing.port_names, **{a: closing.port_names[b] for a, b in self._owner.items()}},
            received={**closing.received, **{a: closing.received[b] for a, b in self._owner.items()}},
            known=(*closing.known, *self._known),
            order=(*closing.order, *(((name,), False) for name in late)),
        )  # fmt: skip
