"""Work, integrals and the power balance of a run that is over, from the same run done again."""

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache, cached_property
from types import MappingProxyType
from typing import NamedTuple, Protocol

import numpy as np
import sympy as sp

from bondgraph.equations import StateEquations
from bondgraph.errors import SignalError, nearest
from codegen.energy.accounts import Account, Accounts, Product, accounts, with_signals
from codegen.energy.audit import Audit, turned_over
from codegen.model.exact_values import at_parameters
from codegen.numbers.arrays import Array

GAVE, TOOK, LOST = "gave", "took", "lost"
"""The sides of a balance."""


def sides(equations: StateEquations) -> dict[Hashable, str | None]:
    """The side of each node of the graph; None for those that conserve power."""
    found: dict[Hashable, str | None] = {}
    ports = equations.reduction.structure.places
    for name, element in equations.elements.items():
        side = TOOK if element.kind.stores else GAVE if element.kind.supplies else LOST
        conserves = name not in ports or element.kind.detects
        found[element.owner or name] = None if conserves else side
    return found


class Energetic(Protocol):
    """What tells energies at the samples of a run."""

    def energy(self, node: Hashable) -> Array:
        """What a storage holds."""


class Integrated(NamedTuple):
    """A run with accounts integrated: S x K, what jumps and resets took, what storages hold, at samples."""

    totals: Array
    impacts: Array
    resets: Array
    observer: Energetic


Again = Callable[[StateEquations, Sequence[Account]], Integrated]
"""Does a run again, with equations that know all signals of the accounts."""


@dataclass(frozen=True)
class Ledger:
    """What a run is asked about energy; nothing is integrated before it is asked.

    ``names``: the signals that a program has beside those of its graph.
    """

    equations: StateEquations
    names: tuple[str, ...]
    again: Again
    parameters: Mapping[str, sp.Expr] = field(default_factory=lambda: MappingProxyType({}))

    def work(self, node: Hashable) -> Array:
        """What a one-port absorbs, or a source supplies, up to each sample."""
        products = self._accounts.of(node)
        whole, found = self._balance
        columns = [whole.index((product,)) for product in products]
        return np.asarray(found.totals[:, columns].sum(axis=1), dtype=float)

    def integral(self, name: str) -> Array:
        """A signal, or what a linear storage holds, integrated up to each sample.

        Raises `SignalError` for a signal that there is not, and what a storage holds by another law.
        """
        held = self.equations.held.get(sp.Symbol(name))
        if held is None:
            return self._integrated(name).copy()
        expr = at_parameters(sp.expand(held), self.parameters)
        terms = {one: expr.coeff(one) for one in sorted(expr.free_symbols, key=str)}
        if any(not value.is_number for value in terms.values()) or expr.subs(
            dict.fromkeys(terms, 0)
        ):
            raise SignalError(
                f"{name} is {held}, no sum of signals: its integral is not worked out; read it with an "
                "integrating detector, or sum its samples"
            )
        return np.asarray(sum(float(v) * self._integrated(n.name) for n, v in terms.items()))

    def audit(self) -> Audit:
        """The power balance from the first sample to the last."""
        gave, took, lost = dict[Hashable, float](), dict[Hashable, float](), dict[Hashable, float]()
        held, told = dict[Hashable, float](), sides(self.equations)
        for node, side in told.items():
            if side == TOOK:
                took[node], held[node] = self._taken(node)
            elif side is not None:
                (gave if side == GAVE else lost)[node] = float(self.work(node)[-1])
        rest = tuple(node for node, side in told.items() if side is None)
        jumps = [float(taken[-1]) for taken in self._balance[1][1:3]]
        turned = turned_over((gave, took, lost), jumps, held)
        return Audit(gave, took, lost, rest, jumps[0], turned, jumps[1])

    def _taken(self, node: Hashable) -> tuple[float, float]:
        """What a storage took, and the magnitudes of what it holds at both ends."""
        whole, found = self._balance
        try:
            energy = found.observer.energy(node)
        except SignalError:
            # A law that reads other signals has no energy of its own; what it took it took by its power.
            return float(self.work(node)[-1]), 0.0
        own, moving = self._accounts.parts(node), self._accounts.moved
        moved = [moving[part] for part in own if part in moving]
        gained = sum(float(found.totals[-1, whole.index(account)]) for account in moved)
        return float(energy[-1] - energy[0]) + gained, float(abs(energy[0]) + abs(energy[-1]))

    @cached_property
    def _integrated(self) -> Callable[[str], Array]:
        """Integrates a signal when it is first asked for, and no second time."""
        return cache(self._integral)

    def _integral(self, name: str) -> Array:
        known = {*self.names, *map(str, self.equations.signals)}
        if name not in known:
            raise SignalError(
                f"no signal {name!r}{nearest(name, known)}; there are {', '.join(sorted(known))}"
            )
        made = with_signals(self._accounts, [name])
        return self.again(made.equations, [(Product(1.0, name, ""),)]).totals[:, 0]

    @cached_property
    def _accounts(self) -> Accounts:
        return accounts(self.equations)

    @cached_property
    def _balance(self) -> tuple[tuple[Account, ...], Integrated]:
        made = self._accounts
        whole = (*made.power.values(), *made.moved.values())
        return whole, self.again(made.equations, whole)
