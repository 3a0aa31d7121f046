"""What the table says of each cell: that the route goes, or why it is refused."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True)
class Refusal:
    """Kinds that routes refuse. ``says``: a pattern of the message; ``genuine``: for good, else not yet."""

    kinds: tuple[str, ...]
    routes: tuple[str, ...]
    genuine: bool
    reason: str
    says: str


REFUSALS = (
    Refusal(
        ("stribeck", "asymmetric", "level_of_state", "curve_of_state", "ruled_by_load", "bollard",
         "behind_moving_ratio", "nonlinear_resistance", "nonlinear_storage", "crank", "inverted_storage",
         "energy_field", "piecewise", "table", "play", "soft_stop", "bent_level", "ruled_flow",
         "reset_bent", "one_way_damper", "warmed", "valve", "filled", "filled_behind", "braked_while_filled",
         "shifted", "gyrated", "heated", "reaction", "accumulators", "unlike_springs",
         "hardening_inertia", "cells", "curved_cells", "gapped_springs", "orifice", "rubbing_nonlinear",
         "staircase", "per_turn",
         "tabled_resistance", "tabled_storage", "engine_map", "tabled_ratio", "tabled_curve",
         "tabled_level", "meshed_shafts", "joined_cells", "geared_behind", "bouncing_nonlinear",
         "clamped", "led_back", "limited", "dead_zone", "looked_up",
         "loop_of_nonlinear_laws"),
        ("C, exact",), True,
        "Matrix exponentials need rates that are affine in each mode, and here a law or a ratio bends them. "
        "`method=\"auto\"`, which users take, locates events with step control instead.",
        "not affine",
    ),
    Refusal(
        ("saturating", "thermostat", "braked"), ("C, exact",), True,
        "Exact steps in C set states by affine maps, and here what a controller sets has cases or bounds. "
        "`method=\"auto\"` locates events with step control instead; exact steps in numpy go.",
        "not affine",
    ),
    Refusal(
        ("selector", "launch", "begun", "chained", "ticked"), ("C, exact",), True,
        "A guard counts in one mode alone, and each mode chooses what the model does: no matrix has that. "
        "`method=\"auto\"` locates events with step control instead.",
        "not affine",
    ),
    Refusal(
        ("past", "line", "pushed_late"), ("linearize",), True,
        "What a delay gives hangs on a whole stretch of the past: there are no finitely many states about a "
        "point, and no A, J and B. A `bg.TransferFunction` stands for it as closely as its user wants.",
        "a delay has no finite number of states",
    ),
    Refusal(
        ("together", "bridge", "two_dogs", "resting"), ("C, exact",), True,
        "Redundant ports (two brakes at rest, two dogs, two jumps, four diodes without a current) share a "
        "load so that the largest part of what one can bear is the least: which one that is changes with "
        "loads and levels, so it is not one affine map of a mode. `method=\"auto\"` locates events with step "
        "control instead.",
        "not affine|not one affine map",
    ),
)  # fmt: skip


def _cells() -> Mapping[tuple[str, str], Refusal]:
    return MappingProxyType(
        {(kind, route): one for one in REFUSALS for kind in one.kinds for route in one.routes}
    )


REFUSED = _cells()
"""By kind and route; all others go."""
