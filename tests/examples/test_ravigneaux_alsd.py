"""The ALSD behind a Ravigneaux gear: Willis's equations, and the plain ALSD in either ratio."""

import sympy as sp

import bondgraph as bg
import differentials
from examples import ravigneaux_alsd

h_s, h_l, i, I_i, I_l, I_k, I_w1, I_w2 = sp.symbols("h_s h_l i I_i I_l I_k I_w1 I_w2")
Q = sp.Matrix(sp.symbols("omega_k omega_1 omega_2"))
CASE, CARRIER = (Q[1] + Q[2]) / 2, Q[0]
#: Willis for the plain set, and for the set with paired planets.
LARGE = (1 + h_l) * CARRIER - h_l * CASE
SMALL = h_s * CASE - (h_s - 1) * CARRIER
EQUATIONS = bg.derive(ravigneaux_alsd.graph(), outputs=["low", "high", "clutch"])


def test_inertia_follows_from_kinetic_energy() -> None:
    energy = (
        I_w1 * Q[1] ** 2 + I_w2 * Q[2] ** 2 + I_k * CARRIER**2 + I_i * SMALL**2 + I_l * LARGE**2
    )
    assert EQUATIONS.states == tuple(Q)
    assert (sp.Matrix(EQUATIONS.A) - sp.hessian(energy / 2, list(Q))).expand().is_zero_matrix


def test_slips_are_the_braked_speeds_and_the_clutch_columns_their_negatives() -> None:
    slips = sp.Matrix([CARRIER, LARGE, CASE - Q[2]])
    assert (sp.Matrix(EQUATIONS.F) - slips.jacobian(Q)).expand().is_zero_matrix
    columns = [EQUATIONS.inputs.index(sp.Symbol(f"tau_{name}")) for name in ("low", "high", "f")]
    assert (EQUATIONS.B[:, columns] + EQUATIONS.F.T).expand().is_zero_matrix


def test_with_a_brake_held_it_is_the_alsd_with_that_ratio() -> None:
    paper = differentials.equations("alsd")
    for brake, ratio in (("low", h_s), ("high", (h_s + h_l) / (1 + h_l))):
        held = bg.linearize(EQUATIONS, stuck=[brake])
        assert held.states == paper.states
        wheels = sp.Matrix(held.A).subs({I_l: 0, I_k: 0})
        assert (wheels - sp.Matrix(paper.A).subs(i, ratio)).applyfunc(sp.cancel).is_zero_matrix
        drive = held.B[:, held.inputs.index(sp.Symbol("tau_e"))]
        assert (drive - paper.B[:, 0].subs(i, ratio)).applyfunc(sp.cancel).is_zero_matrix


def test_the_shift_goes_from_one_ratio_to_the_other() -> None:
    run = ravigneaux_alsd.run()
    ratio = run["omega_e"] / run["omega_c"]
    assert abs(ratio[250] - 3.2) < 1e-9
    assert abs(ratio[-1] - (3.2 + 2.1) / 3.1) < 1e-9
    assert [(event.kind, event.port) for event in run.events] == [
        ("slip", "low"),
        ("stick", "high"),
    ]
    assert abs(run["tau_t1"][-1] - run["tau_t2"][-1]) < 1e-3
