"""The catalog of the paper's differentials: their graphs and equations by name."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import bondgraph as bg
from bondgraph.named import Named
from differentials import active, passive
from differentials.parts import Part
from differentials.pieces import Variant


@dataclass(frozen=True)
class Differential:
    """One topology: what it is called, where it comes from, and how its graph is built.

    ``clutches``: node of each clutch to the name of its hydraulic torque. ``wheels``: how many.
    ``full``: whether there is a model with halfshafts beside the rigid one. ``play``: which of its
    models can have backlash, "full", "rigid" or none. ``scenario``: the one that the paper shows it in, or
    that suits it. ``observed``: nodes whose signals a simulation records beside the slips.
    """

    name: str
    title: str
    source: str
    build: Callable[[Variant], Part]
    clutches: Mapping[str, str]
    wheels: int
    full: bool
    play: str
    scenario: str
    observed: tuple[str, ...]


def _row(
    name: str, title: str, source: str, build: Callable[[Variant], Part], scenario: str, *levels: str,
    wheels: int = 2, full: bool = True, play: str = "full", observed: tuple[str, ...] = ("input", "case"),
) -> Differential:  # fmt: skip
    nodes = ("clutch",) if len(levels) == 1 else tuple(f"clutch_{j}" for j in (1, 2))
    clutches = MappingProxyType(dict(zip(nodes[: len(levels)], levels, strict=True)))
    if full:
        observed += tuple(f"halfshaft_{j}" for j in range(1, wheels + 1))
    return Differential(
        name, title, source, build, clutches, wheels, full, play, scenario, observed
    )


_ALL = (
    _row(
        "passive", "passive differential", "Figs. 2a, 4, eqs. (6), (12)", passive.passive,
        "engine_step",
    ),
    _row(
        "passive_input_clutch", "passive differential with an input clutch", "Fig. 2b, eqs. (7), (8)",
        passive.passive_input_clutch, "input_clutch", "tau_h", full=False, play="",
        observed=("input", "case"),
    ),
    _row(
        "passive_input_shaft", "passive differential with a compliant input shaft", "Fig. 2c, eq. (9)",
        passive.passive_input_shaft, "engine_step", full=False, play="rigid",
        observed=("input", "case", "input_shaft"),
    ),
    _row(
        "passive_halfshafts", "passive differential with massless outputs on halfshafts",
        "Fig. 3, eqs. (10), (11)", passive.passive_halfshafts, "engine_step", full=False, play="",
        observed=("case", "left", "right", "halfshaft_1", "halfshaft_2"),
    ),
    _row(
        "alsd", "active limited slip differential (ALSD)", "Figs. 6a, 7a, Appendix B", active.alsd,
        "fig11", "tau_h",
    ),
    _row(
        "superposition_tvd", "torque vectoring differential with superposition clutches",
        "Figs. 6b, 7b, Appendix B", active.superposition_tvd, "fig13_superposition", "tau_h1", "tau_h2",
    ),
    _row(
        "stationary_tvd", "torque vectoring differential with stationary clutches",
        "Figs. 6c, 7c, Appendix B", active.stationary_tvd, "fig13", "tau_h1", "tau_h2",
    ),
    _row(
        "four_wheel_drive_tvd", "four wheel drive with a torque vectoring rear differential",
        "Figs. 6d, 7d, Appendix B", active.four_wheel_drive_tvd, "fig14", "tau_h1", "tau_h2", wheels=4,
        observed=("input", "case", "ring"),
    ),
)  # fmt: skip

catalog: Mapping[str, Differential] = Named({row.name: row for row in _ALL})
"""Name to differential, in the paper's order."""


def differential(name: str) -> Differential:
    """The catalog's differential of that name; `StructureError` with the names there are."""
    if name not in catalog:
        raise bg.StructureError(
            f"no differential is called {name!r}; there is {', '.join(catalog)}"
        )
    return catalog[name]


def graph(name: str, halfshafts: bool = False, lumped: bool = True, backlash: bool = False) -> Part:
    """A differential's bond graph, rigid or with compliant halfshafts.

    ``lumped=False`` keeps inertias that Appendix B lumps as elements of their own, all dependent.
    ``backlash=True`` puts a gap into the halfshafts, or into the compliant input shaft (Fig. 5).

    Raises `StructureError` for a variant that the differential does not have.

    >>> dict(graph("alsd").nodes["clutch"])["kind"]
    'R'
    """
    chosen = differential(name)
    if halfshafts and not chosen.full:
        raise bg.StructureError(
            f"{name} ({chosen.source}) has no model with halfshafts of its own; the paper extends "
            "'passive' and the active differentials by them"
        )
    if backlash and chosen.play != ("full" if halfshafts else "rigid"):
        also = " without halfshafts=True" if chosen.play == "full" else ""
        raise bg.StructureError(
            f"{name}{also} has no shaft that could have backlash; there is backlash in the halfshafts "
            "of full models and in the shaft of 'passive_input_shaft'"
        )
    return chosen.build(Variant(halfshafts, lumped, backlash))


def equations(name: str, halfshafts: bool = False) -> bg.StateEquations:
    """A differential's equations; F shows the clutches' slips, as in the paper.

    Raises what `graph` raises.

    >>> equations("alsd").F
    Matrix([[1/2, -1/2]])
    """
    return bg.derive(graph(name, halfshafts), outputs=list(differential(name).clutches))
