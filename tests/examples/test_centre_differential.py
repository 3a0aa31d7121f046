"""The centre differential against kinetic energy and virtual power, worked out without a bond graph."""

import sympy as sp

import bondgraph as bg
from examples import centre_differential

k, i_r, i_f, I_i, I_w = sp.symbols("k i_r i_f I_i I_w")
SPEEDS = sp.Matrix(sp.symbols("omega_1:5"))
REAR, FRONT = (SPEEDS[0] + SPEEDS[1]) / 2, (SPEEDS[2] + SPEEDS[3]) / 2
#: Willis: (1 + k) w_carrier = k w_ring + w_sun.
INPUT = (k * i_r * REAR + i_f * FRONT) / (1 + k)


def test_inertia_and_input_follow_from_energy_and_virtual_power() -> None:
    found = bg.derive(centre_differential.graph())
    energy = I_i * INPUT**2 / 2 + I_w * (SPEEDS.T @ SPEEDS)[0] / 2
    assert found.states == tuple(SPEEDS)
    assert (
        (sp.Matrix(found.A) - sp.hessian(energy, list(SPEEDS))).applyfunc(sp.cancel).is_zero_matrix
    )
    drive = sp.Matrix([sp.diff(INPUT, speed) for speed in SPEEDS])
    assert (found.B[:, 0] - drive).applyfunc(sp.cancel).is_zero_matrix
    assert found.B[:, 1:] == -sp.eye(4)


def test_the_tires_carry_the_split() -> None:
    """Ring over sun torque is k : 1, and each axle multiplies by its final drive."""
    run = centre_differential.run()
    rear, front = (run[f"tau_t{j}"][-1] + run[f"tau_t{j + 1}"][-1] for j in (1, 3))
    assert abs(rear / front - 1.5) < 1e-6
    assert abs(rear + front - 2.8 * 200) < 1e-4


def test_equal_axles_turn_the_input_as_one_gear() -> None:
    run = centre_differential.run()
    mean = sum(run[f"omega_{j}"] for j in (1, 2)) / 2, sum(run[f"omega_{j}"] for j in (3, 4)) / 2
    expected = 2.8 * (1.5 * mean[0] + mean[1]) / 2.5
    assert abs(run["omega_e"] - expected).max() < 1e-9
