"""What `explicit` finds: the rates of states, what is left of loops of laws, and names of long parts."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import sympy as sp

from bondgraph.named import Named
from bondgraph.show.rates import rates_latex, rates_text
from bondgraph.show.ruled import Ruled


@dataclass(frozen=True, eq=False, repr=False)
class ExplicitRates(Mapping[sp.Symbol, sp.Expr]):
    """``x' = f(x, u, t)``, a mapping of each state to its rate; equal to any mapping that has the same.

    Rates are over states, open inputs, the time and parameters, and over names of `implicit` and `where`,
    which small models without nonlinear loops of laws have none of.

    Raises nothing of its own; `KeyError`, as mappings do, for a state that there is not.
    """

    rates: Mapping[sp.Symbol, sp.Expr]
    #: What a law gives to what it is: nonlinear equations ``name = expression`` that hold at once.
    implicit: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    #: Long parts by name, each over earlier ones: in rates and in the equations above.
    where: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    #: What nodes of signals with several ways are when: by their states, relays by their names.
    ruled: Mapping[sp.Symbol, Ruled] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "rates", Named(dict(self.rates)))
        for name in ("implicit", "where", "ruled"):
            object.__setattr__(self, name, MappingProxyType(dict(getattr(self, name))))

    def __reduce__(self) -> tuple[Any, ...]:
        """Copied and pickled by what it maps, as read-only mappings by themselves cannot be."""
        parts = (self.rates, self.implicit, self.where, self.ruled)
        return ExplicitRates, tuple(map(dict, parts))

    def __getitem__(self, state: sp.Symbol | str) -> sp.Expr:
        """The rate of a state, or of the one of that name; `KeyError` naming what there is."""
        return self.rates[state]

    def _ipython_key_completions_(self) -> list[str]:
        return [str(state) for state in self.rates]

    def __iter__(self) -> Iterator[sp.Symbol]:
        return iter(self.rates)

    def __len__(self) -> int:
        return len(self.rates)

    def __repr__(self) -> str:
        """The mapping, and beside it what else there is."""
        others = [f"{name}={dict(getattr(self, name))}" for name in ("implicit", "where")
                  if getattr(self, name)]  # fmt: skip
        return f"ExplicitRates({', '.join([str(dict(self.rates)), *others])})"

    def __str__(self) -> str:
        """One line for each rate, then equations that are left to be solved, then what names stand for."""
        return rates_text(self.rates, self.implicit, self.where, self.ruled)

    def latex(self) -> str:
        r"""The same in LaTeX, lines with ``&=`` for an ``aligned`` environment."""
        return rates_latex(self.rates, self.implicit, self.where, self.ruled)

    def _repr_latex_(self) -> str | None:
        if not self.rates:
            return None
        return rf"$$\begin{{aligned}} {self.latex()} \end{{aligned}}$$"
