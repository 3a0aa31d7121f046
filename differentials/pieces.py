"""What several of the paper's differentials share: outputs, halfshafts with wheels, the bevel core."""

from collections.abc import Sequence
from dataclasses import dataclass

from differentials.parts import (
    Part,
    assemble,
    bevel,
    engine,
    gear,
    halfshaft,
    inertia,
    shaft,
    tire,
    wheel,
)

Side = tuple[int, str]
"""An output: the number that its symbols carry, and its shaft."""

SIDES: tuple[Side, ...] = ((1, "left"), (2, "right"))


@dataclass(frozen=True)
class Variant:
    """Which of a differential's graphs: rigid or with ``halfshafts``, inertias ``lumped`` or not.

    ``backlash``: with play in the halfshafts, or in the input shaft where that is compliant.
    """

    halfshafts: bool = False
    lumped: bool = True
    backlash: bool = False


def outputs(sides: Sequence[Side], variant: Variant, own: Sequence[str] = ("I_",)) -> Part:
    """The output shafts with their inertias: with halfshafts the outputs' own, else the wheels' too.

    ``own``: what an output's inertia consists of, by the symbols' first letters. Lumped, ``I_<j>`` or,
    rigid, ``I_w<j>`` holds it all (Appendix B); else each is an element, all but one dependent.
    """
    parts = [shaft(side) for _, side in sides]
    for number, side in sides:
        names = [f"{prefix}{number}" for prefix in own]
        if variant.lumped:
            names = [f"I_{number}"] if variant.halfshafts else []
        if not variant.halfshafts:
            names = [f"I_w{number}", *names]
        state, *dependent = names
        parts.append(inertia(state, state, at=side, speed=f"omega_{number}"))
        parts += [inertia(name, name, at=side, priority=-1) for name in dependent]
    return assemble(*parts)


def wheels(sides: Sequence[Side], variant: Variant) -> Part:
    """Tires at the outputs, by way of halfshafts and wheels in the full model, eqs. (15), (16)."""
    if not variant.halfshafts:
        return assemble(*(tire(number, at=side) for number, side in sides))
    gap = "gap" if variant.backlash else None
    return assemble(
        *(shaft(f"wheel_{number}") for number, _ in sides),
        *(halfshaft(number, side, f"wheel_{number}", "k", "b", gap) for number, side in sides),
        *(wheel(number, f"wheel_{number}", "I_w", f"omega_t{number}") for number, _ in sides),
    )


def referred(names: Sequence[str], at: str, variant: Variant) -> list[Part]:
    """Inertias that are lumped into the input's: elements of their own only where asked for."""
    if variant.lumped:
        return []
    return [inertia(name, name, at=at, priority=-1) for name in names]


def rigid_input() -> Part:
    """The engine on the differential's input shaft, whose inertia is the dependent one (Fig. 2a)."""
    return assemble(
        shaft("input", "omega_e"),
        engine("engine", "tau_e", at="input"),
        inertia("I_i", "I_i", at="input", speed="omega_e", priority=-1),
    )


def final_drive(sides: Sequence[Side] = SIDES, ratio: str = "i") -> Part:
    """From the input shaft through the final drive and the bevel gear to two outputs (Fig. 1)."""
    (_, left), (_, right) = sides
    return assemble(
        shaft("case", "omega_c"),
        gear("final_drive", ratio, driving="input", driven="case"),
        bevel("bevel", case="case", left=left, right=right),
    )


def bevel_core(
    variant: Variant, case: Sequence[str] = ("I_c",), own: Sequence[str] = ("I_",)
) -> Part:
    """The passive differential without its tires, which the active ones extend.

    ``case``: the inertias that turn with the case, lumped into I_i; ``own``: see `outputs`.
    """
    return assemble(
        rigid_input(),
        final_drive(),
        outputs(SIDES, variant, own),
        *referred(case, "case", variant),
    )
