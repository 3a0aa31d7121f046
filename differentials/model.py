"""A differential ready to run: equations, the laws that close its ports, and the defaults it needs."""

from collections.abc import Hashable, Mapping
from dataclasses import dataclass

import bondgraph as bg
from bondgraph.nodes.laws import law
from differentials.laws import coulomb_clutch, linear_tire
from differentials.parameters import Parameter, defaults
from differentials.topologies import Differential, differential, graph


@dataclass(frozen=True)
class Model:
    """The model that simulations use: with halfshafts wherever the paper has them.

    ``laws``: node to law. ``starts``: the parameter that holds each wheel's speed in steady motion.
    """

    differential: Differential
    equations: bg.StateEquations
    laws: Mapping[Hashable, object]
    starts: tuple[str, ...]
    parameters: Mapping[str, Parameter]


def model(name: str, laws: Mapping[str, object] | None = None, backlash: bool = False) -> Model:
    """The full model of a differential with Coulomb clutches and linearised tires.

    ``laws``: other laws for clutches or tires, by node. ``backlash``: see `graph`.

    Raises `BondGraphError` for unknown names and for laws that can't be used.
    """
    chosen = differential(name)
    closed: dict[Hashable, object] = {
        node: coulomb_clutch(level) for node, level in chosen.clutches.items()
    }
    closed |= {f"tire_{j}": linear_tire(j) for j in range(1, chosen.wheels + 1)}
    for node in laws or {}:
        if node not in closed:
            raise bg.StructureError(
                f"{name} has no clutch or tire {node!r}; there are {', '.join(map(str, closed))}"
            )
    closed.update(laws or {})
    full = graph(name, halfshafts=chosen.full, backlash=backlash)
    equations = bg.derive(full, outputs=[*chosen.clutches, *chosen.observed])
    starts = tuple(f"omega_t{j}_0" for j in range(1, chosen.wheels + 1))
    names = _symbols(equations, closed) - {*starts, *chosen.clutches.values()}
    return Model(chosen, equations, closed, starts, defaults(name, sorted(names)))


def _symbols(equations: bg.StateEquations, laws: Mapping[Hashable, object]) -> set[str]:
    """The names that the matrices and the laws use and no signal has."""
    found = set(equations.parameters)
    for node, value in [*equations.laws.items(), *laws.items()]:
        found |= law(value, f"law at {node!r}").free_symbols
    return {symbol.name for symbol in found - set(equations.signals)}
