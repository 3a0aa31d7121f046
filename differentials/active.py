"""The active differentials of Fig. 7: one with limited slip, three that vector torque."""

from differentials.parts import (
    Part,
    assemble,
    brake,
    clutch,
    double_planetary,
    gear,
    inertia,
    planetary,
    shaft,
)
from differentials.pieces import (
    SIDES,
    Side,
    Variant,
    bevel_core,
    final_drive,
    outputs,
    referred,
    rigid_input,
    wheels,
)

FRONT: tuple[Side, ...] = ((3, "front_left"), (4, "front_right"))
"""The outputs of the four wheel drive's passive front differential; 1 and 2 are at the rear."""


def alsd(variant: Variant) -> Part:
    """The active limited slip differential, Fig. 7a: a clutch between the case and the right output."""
    return assemble(
        bevel_core(variant),
        clutch("clutch", "tau_f", "omega_f", driving="case", driven="right"),
        wheels(SIDES, variant),
    )


def superposition_tvd(variant: Variant) -> Part:
    """The torque vectoring differential with superposition clutches, Fig. 7b.

    Each clutch lies between a gear on the case, of output over input speed h_j, and the right output.
    """
    return assemble(
        bevel_core(variant, case=("I_c", "I_gc")),
        *(
            clutch(f"clutch_{j}", f"tau_f{j}", f"omega_f{j}", "case", "right", speedup=f"h{j}")
            for j, _ in SIDES
        ),
        wheels(SIDES, variant),
    )


def stationary_tvd(variant: Variant) -> Part:
    """The torque vectoring differential with stationary clutches, Fig. 7c.

    Per side a double planetary gear between case and output, its carrier braked.
    """
    sides = [
        assemble(
            shaft(f"carrier_{j}"),
            inertia(f"I_c{j}", f"I_c{j}", at=f"carrier_{j}", priority=-1),
            double_planetary(f"planetary_{j}", f"h{j}", "case", side, carrier=f"carrier_{j}"),
            brake(f"clutch_{j}", f"tau_f{j}", f"omega_f{j}", at=f"carrier_{j}"),
        )
        for j, side in SIDES
    ]
    return assemble(
        bevel_core(variant, case=("I_c", "I_s1", "I_s2"), own=("I_", "I_r")),
        *sides,
        wheels(SIDES, variant),
    )


def four_wheel_drive_tvd(variant: Variant) -> Part:
    """The four wheel drive with torque vectoring at the rear, Fig. 7d; the front one is passive.

    A gear speeds the rear ring shaft up by g; per rear wheel a planetary gear, its sun braked.
    """
    sides = [
        assemble(
            shaft(f"sun_{j}"),
            inertia(f"I_s{j}", f"I_s{j}", at=f"sun_{j}", priority=-1),
            planetary(f"planetary_{j}", f"h{j}", sun=f"sun_{j}", ring="ring", carrier=side),
            brake(f"clutch_{j}", f"tau_f{j}", f"omega_f{j}", at=f"sun_{j}"),
        )
        for j, side in SIDES
    ]
    return assemble(
        rigid_input(),
        outputs(SIDES, variant, own=("I_c",)),
        outputs(FRONT, variant),
        final_drive(FRONT, ratio="i_f"),
        *referred(("I_cf",), "case", variant),
        shaft("ring", "omega_r"),
        gear("speedup", "i_r/g", driving="input", driven="ring"),
        *referred(("I_ir", "I_r1", "I_r2"), "ring", variant),
        *sides,
        wheels((*SIDES, *FRONT), variant),
    )
