"""The passive differential of Figs. 2 to 4, with the inputs and halfshafts the paper compares."""

from differentials.parts import (
    Part,
    assemble,
    clutch,
    compliant_shaft,
    engine,
    halfshaft,
    inertia,
    shaft,
    wheel,
)
from differentials.pieces import (
    SIDES,
    Variant,
    bevel_core,
    final_drive,
    outputs,
    rigid_input,
    wheels,
)


def passive(variant: Variant) -> Part:
    """Fig. 2a, eq. (6), and with halfshafts Fig. 4, eq. (12): the input inertia is dependent."""
    return assemble(bevel_core(variant), wheels(SIDES, variant))


def passive_input_clutch(variant: Variant) -> Part:
    """Fig. 2b: a clutch between engine and differential; eq. (7) slipping, eq. (8) locked."""
    return assemble(
        _engine_shaft(),
        shaft("input", "omega_i"),
        final_drive(),
        outputs(SIDES, variant),
        clutch("clutch", "tau_f", "omega_f", driving="engine_shaft", driven="input"),
        wheels(SIDES, variant),
    )


def passive_input_shaft(variant: Variant) -> Part:
    """Fig. 2c, eq. (9): a compliant input shaft, with backlash where asked for."""
    gap = "gap" if variant.backlash else None
    return assemble(
        _engine_shaft(),
        shaft("input", "omega_i"),
        final_drive(),
        outputs(SIDES, variant),
        compliant_shaft(
            "input_shaft", "engine_shaft", "input", "k_is", "b_is", gap, "tau_is", "tau_kis"
        ),
        wheels(SIDES, variant),
    )


def passive_halfshafts(variant: Variant) -> Part:
    """Fig. 3, eqs. (10), (11): two halfshafts that carry the same torque, so one spring is dependent."""
    return assemble(
        rigid_input(),
        final_drive(),
        *(shaft(side, f"omega_{number}") for number, side in SIDES),
        *(shaft(f"wheel_{number}") for number, _ in SIDES),
        *(halfshaft(number, side, f"wheel_{number}", f"k_{number}") for number, side in SIDES),
        *(wheel(j, f"wheel_{j}", f"I_w{j}", f"omega_t{j}") for j, _ in SIDES),
    )


def _engine_shaft() -> Part:
    """The engine on a shaft of its own, whose speed is a state."""
    return assemble(
        shaft("engine_shaft"),
        engine("engine", "tau_e", at="engine_shaft"),
        inertia("I_i", "I_i", at="engine_shaft", speed="omega_e"),
    )
