"""The paper's differentials as graphs over parts, and the catalog of them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import bondgraph as bg
from differentials.parts import (
    Part,
    assemble,
    bevel,
    clutch,
    engine,
    gear,
    halfshaft,
    inertia,
    shaft,
    tire,
)


@dataclass(frozen=True)
class Differential:
    """One topology: what it is called, where it comes from, and how its graph is built.

    ``clutches``: node of each clutch to the name of its hydraulic torque. ``wheels``: how many.
    ``observed``: nodes whose signals a simulation records beside the slips.
    """

    name: str
    title: str
    source: str
    build: Callable[[bool, bool], Part]
    clutches: Mapping[str, str]
    wheels: int
    observed: tuple[str, ...]


def alsd(halfshafts: bool, lumped: bool) -> Part:
    """The active limited slip differential, Fig. 7a: a clutch between the case and the right output."""
    return assemble(
        _bevel_core(halfshafts, lumped),
        clutch("clutch", "tau_f", "omega_f", driving="case", driven="right"),
        _wheels(("left", "right"), halfshafts),
    )


def _bevel_core(halfshafts: bool, lumped: bool) -> Part:
    """The passive differential, Fig. 2a, whose input inertia is the dependent one."""
    parts = [
        shaft("input", "omega_e"),
        engine("engine", "tau_e", at="input"),
        inertia("I_i", "I_i", at="input", priority=-1),
        shaft("case", "omega_c"),
        gear("final_drive", "i", driving="input", driven="case"),
        shaft("left"),
        shaft("right"),
        bevel("bevel", case="case", left="left", right="right"),
        *_outputs(("left", "right"), halfshafts, lumped),
    ]
    if not lumped:
        parts.append(inertia("I_c", "I_c", at="case", priority=-1))
    return assemble(*parts)


def _outputs(sides: tuple[str, ...], halfshafts: bool, lumped: bool) -> list[Part]:
    """The inertias at the outputs: with halfshafts the outputs' own, without them the wheels'.

    Lumped, ``I_w<j>`` holds both (Appendix B); else the output's own stands beside, dependent.
    """
    parts = []
    for number, side in enumerate(sides, start=1):
        speed = f"omega_{number}"
        own, wheel = f"I_{number}", f"I_w{number}"
        if halfshafts:
            parts.append(inertia(own, own, at=side, speed=speed))
            continue
        parts.append(inertia(wheel, wheel, at=side, speed=speed))
        if not lumped:
            parts.append(inertia(own, own, at=side, priority=-1))
    return parts


def _wheels(sides: tuple[str, ...], halfshafts: bool) -> Part:
    """Tires at the outputs, by way of halfshafts and wheels in the full model, eqs. (15), (16)."""
    numbered = list(enumerate(sides, start=1))
    if not halfshafts:
        return assemble(*(tire(number, at=side) for number, side in numbered))
    shafts = [
        halfshaft(number, inner=side, outer=f"wheel_{number}", k="k", b="b")
        for number, side in numbered
    ]
    wheels = [
        assemble(
            shaft(f"wheel_{number}"),
            inertia(f"I_w{number}", "I_w", at=f"wheel_{number}", speed=f"omega_t{number}"),
        )
        for number, _ in numbered
    ]
    return assemble(
        *shafts, *wheels, *(tire(number, at=f"wheel_{number}") for number, _ in numbered)
    )


catalog: Mapping[str, Differential] = MappingProxyType(
    {
        "alsd": Differential(
            name="alsd",
            title="active limited slip differential (ALSD)",
            source="Figs. 6a, 7a, Appendix B",
            build=alsd,
            clutches=MappingProxyType({"clutch": "tau_h"}),
            wheels=2,
            observed=("input", "case", "halfshaft_1", "halfshaft_2"),
        ),
    }
)
"""Name to differential."""


def differential(name: str) -> Differential:
    """The catalog's differential of that name; `StructureError` with the names there are."""
    if name not in catalog:
        raise bg.StructureError(
            f"no differential is called {name!r}; there is {', '.join(catalog)}"
        )
    return catalog[name]


def graph(name: str, halfshafts: bool = False, lumped: bool = True) -> Part:
    """A differential's bond graph, rigid or with compliant halfshafts.

    ``lumped=False`` keeps the case and output inertias as elements of their own, all dependent.
    """
    return differential(name).build(halfshafts, lumped)


def equations(name: str, halfshafts: bool = False) -> bg.StateEquations:
    """A differential's equations; F shows the clutches' slips, as in the paper.

    >>> equations("alsd").F
    Matrix([[1/2, -1/2]])
    """
    return bg.derive(graph(name, halfshafts), outputs=list(differential(name).clutches))
