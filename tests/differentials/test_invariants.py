"""What holds for every differential and variant: symmetries, energy, power, limits."""

import random

import pytest
import sympy as sp
from oracles.exported import variant_of
from sympy.polys.matrices import DomainMatrix

import bondgraph as bg
import differentials

Variant = tuple[str, bool, bool, bool]  # name, halfshafts, lumped, backlash
FULL = ("passive", "alsd", "superposition_tvd", "stationary_tvd", "four_wheel_drive_tvd")
RIGID = (*FULL, "passive_input_clutch", "passive_input_shaft", "passive_halfshafts")
BOTH = (True, False)
VARIANTS: list[Variant] = [
    *((name, False, lumped, False) for name in RIGID for lumped in BOTH),
    *((name, True, lumped, gap) for name in FULL for lumped in BOTH for gap in BOTH),
    *(("passive_input_shaft", False, lumped, True) for lumped in BOTH),
]
every = pytest.mark.parametrize("variant", VARIANTS, ids=str)

i, i_f, i_r, g, h1, h2, k, b, b_is = sp.symbols("i i_f i_r g h1 h2 k b b_is")
tau_e, tau_is, omega_e = sp.symbols("tau_e tau_is omega_e")
w1, w2, w3, w4 = sp.symbols("omega_1:5")
CASE, FRONT = (w1 + w2) / 2, (w3 + w4) / 2
RING = g * i_f / i_r * FRONT
SLIPS: dict[str, list[sp.Expr]] = {
    "alsd": [(w1 - w2) / 2],
    "passive_input_clutch": [omega_e - i * CASE],
    "superposition_tvd": [h1 * CASE - w2, h2 * CASE - w2],
    "stationary_tvd": [(h1 * CASE - w1) / (h1 - 1), (h2 * CASE - w2) / (h2 - 1)],
    "four_wheel_drive_tvd": [(1 + h1) * w1 - h1 * RING, (1 + h2) * w2 - h2 * RING],
}
TORQUES = {1: ["tau_f"], 2: ["tau_f1", "tau_f2"], 0: []}


def derived(variant: Variant) -> bg.StateEquations:
    return variant_of(*variant)


def zero(matrix: sp.Matrix) -> bool:
    return sp.Matrix(matrix).applyfunc(sp.cancel).is_zero_matrix is True


def vanishes(expression: sp.Expr) -> bool:
    """Whether a rational expression is zero; what is cancelled in its numerator need not be known."""
    return bool(sp.fraction(sp.together(expression))[0].expand() == 0)


def engine_speed(name: str) -> sp.Expr:
    if name.startswith("passive_"):
        return omega_e
    return i_f * FRONT if name == "four_wheel_drive_tvd" else i * CASE


def positive(matrix: sp.Matrix, seed: int, **fixed: object) -> dict[str, object]:
    """Exact random positive values; of the ratios some are above 1, some below, none is 1."""
    chosen = random.Random(seed)
    names = sorted(symbol.name for symbol in matrix.free_symbols)
    values = {name: sp.Rational(2 * chosen.randint(0, 60) + 1, 32) for name in names}
    return values | fixed


@every
def test_clutches_brake_their_slips(variant: Variant) -> None:
    """w_f = F w, and the clutches' columns of B are -F^T."""
    found = derived(variant)
    slips = SLIPS.get(variant[0], [])
    count = len(slips)
    assert [str(u) for u in found.inputs[: 1 + count]] == ["tau_e", *TORQUES[count]]
    assert zero(found.B[:, 1 : 1 + count] + found.F.T)
    assert zero(found.F * sp.Matrix(found.states) - sp.Matrix(count, 1, slips))
    assert not any(matrix.todok() for matrix in (found.E, found.D, found.G))


@every
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_is_symmetric_and_positive_definite(variant: Variant, seed: int) -> None:
    A = derived(variant).A
    assert zero(A - A.T)
    values = {sp.Symbol(name): value for name, value in positive(A, seed).items()}
    exact = sp.Matrix(A).xreplace(values)
    assert all(exact[:n, :n].det() > 0 for n in range(1, A.rows + 1))


@every
def test_j_exchanges_power_and_loses_some_in_dampers(variant: Variant) -> None:
    """J + J^T has no positive eigenvalue, is zero without damping; J itself only without springs."""
    name, halfshafts, _, backlash = variant
    J = sp.Matrix(derived(variant).J)
    lost = J + J.T
    assert zero(lost.subs({b: 0, b_is: 0}))
    assert all(c >= 0 for c in lost.subs(positive(lost, 4)).charpoly().all_coeffs())
    damped = not backlash and (halfshafts or name == "passive_input_shaft")
    assert zero(lost) is not damped
    assert zero(J) is not (damped or name == "passive_halfshafts")


def speed(name: str, outside: bool, inertia: str) -> sp.Expr:
    """How fast an inertia turns, by its symbol in the paper's Fig. 7."""
    own = {"I_i": engine_speed(name), "I_c": CASE, "I_gc": CASE}
    if name == "stationary_tvd":
        own |= {"I_s1": CASE, "I_s2": CASE, "I_c1": SLIPS[name][0], "I_c2": SLIPS[name][1]}
    if name == "four_wheel_drive_tvd":
        own |= {"I_s1": SLIPS[name][0], "I_s2": SLIPS[name][1], "I_cf": FRONT}
        own |= {"I_ir": RING, "I_r1": RING, "I_r2": RING}
    wheel = "t" if outside and inertia.startswith("I_w") else ""
    return own.get(inertia, sp.Symbol(f"omega_{wheel}{inertia[-1]}"))


@every
def test_a_holds_the_energy_of_every_inertia_and_spring(variant: Variant) -> None:
    """x^T A x is twice the energy, each storage with its speed or torque by the paper's kinematics."""
    name, energy = variant[0], sp.Integer(0)
    outside = variant[1] or name == "passive_halfshafts"
    for node, data in differentials.graph(*variant).nodes(data=True):
        if data["kind"] == "I":
            energy += sp.Symbol(data["value"]) * speed(name, outside, node) ** 2
        if data["kind"] == "C" and data.get("law") is None:
            common = "tau_k1" if name == "passive_halfshafts" else data["effort"]
            energy += bg.expression(data["value"], "compliance") * sp.Symbol(common) ** 2
    x = sp.Matrix(derived(variant).states)
    assert vanishes((x.T * derived(variant).A * x)[0] - energy)


@every
def test_power_balances(variant: Variant) -> None:
    """x^T (J x + B u) is the engine's power less what clutches, tires, dampers and gaps take."""
    name, halfshafts, _, backlash = variant
    slips = SLIPS.get(name, [])
    power = tau_e * engine_speed(name)
    power -= sum(sp.Symbol(t) * slip for t, slip in zip(TORQUES[len(slips)], slips, strict=True))
    if name == "passive_input_shaft":
        twist = omega_e - i * CASE
        power -= tau_is * twist if backlash else b_is * twist**2
    for j in range(1, 5 if name == "four_wheel_drive_tvd" else 3):
        inner, outer = sp.symbols(f"omega_{j} omega_t{j}")
        wheel = outer if halfshafts or name == "passive_halfshafts" else inner
        power -= sp.Symbol(f"tau_t{j}") * wheel
        if halfshafts:
            gap = sp.Symbol(f"tau_hs{j}") * (inner - outer)
            power -= gap if backlash else b * (inner - outer) ** 2
    found = derived(variant)
    x, u = sp.Matrix(found.states), sp.Matrix(found.inputs)
    assert vanishes((x.T * (found.J * x + found.B * u))[0] - power)


@pytest.mark.parametrize("name", [*FULL, "passive_halfshafts", "passive_input_shaft"])
@pytest.mark.parametrize("rate", [sp.Rational(7, 3), sp.Rational(-41, 5)])
def test_stiff_shafts_leave_the_rigid_model(name: str, rate: sp.Rational) -> None:
    """The speed that tau_e gives output and wheel 1 as k -> oo: the rigid model's with I_w1 = I_1 + I_w."""
    soft = derived((name, name in FULL, True, False))
    rigid = derived((name if name in FULL else "passive", False, True, False))
    values = positive(sp.diag(soft.A, soft.J, soft.B, rigid.A), 5, k=k, k_1=k, k_2=k, k_is=k)
    if name in FULL:
        values |= {f"I_w{j}": values.get(f"I_{j}", 0) + values["I_w"] for j in range(1, 5)}
    expected = transfer(rigid, values, rate)["omega_1"]
    found = [x for s, x in transfer(soft, values, rate).items() if s in ("omega_1", "omega_t1")]
    assert len(found) == (2 if name in FULL else 1)
    assert expected not in found
    assert [sp.limit(x, k, sp.oo) for x in found] == [expected] * len(found)


def transfer(found: bg.StateEquations, values: dict[str, object], s: object) -> dict[str, sp.Expr]:
    """Each state over tau_e: (s A - J)^-1 B."""
    both = sp.Matrix.hstack(s * found.A - found.J, found.B[:, :1]).subs(values)
    exact = DomainMatrix.from_Matrix(sp.Matrix(both)).to_field()
    solved = exact[:, :-1].lu_solve(exact[:, -1:]).to_Matrix()
    return dict(zip(map(str, found.states), solved, strict=True))


def test_one_differential_is_anothers_special_case() -> None:
    rigid = (derived((name, False, True, False)) for name in FULL)
    passive, alsd, superposition, stationary, four_wheel_drive = rigid
    assert superposition.A == alsd.A
    assert superposition.F.subs(h1, 1)[0, :] == alsd.F
    assert superposition.B.subs(h1, 1)[:, 1] == alsd.B[:, 1]
    assert zero(stationary.A.subs({"I_c1": 0, "I_c2": 0}) - alsd.A)
    front = sp.Matrix(passive.A).subs({"i": "i_f", "I_w1": "I_w3", "I_w2": "I_w4"})
    apart = sp.diag(*sp.symbols("I_w1 I_w2"), front)
    assert zero(four_wheel_drive.A.subs({"I_s1": 0, "I_s2": 0}) - apart)


REAR = {g: sp.Rational(21, 20), i_f: i, i_r: i * h1 / (1 + h1), h2: h1}


@pytest.mark.parametrize(
    ("name", "values", "expected"),
    [
        ("alsd", {}, ["1"]),
        ("superposition_tvd", {h1: sp.Rational(7, 8), h2: sp.Rational(9, 8)}, ["9/7", "7/9"]),
        ("stationary_tvd", dict.fromkeys((h1, h2), sp.Rational(9, 8)), ["9/7", "7/9"]),
        ("four_wheel_drive_tvd", REAR, ["21/20", "21/20"]),
    ],
)
def test_the_speed_ratios_without_slip(name: str, values: dict, expected: list) -> None:
    """The paper's 1.2857 = 9/7 from h1 = 0.875, and from h/(2 - h) at h = 1.125; the 4WD's g = 1.05."""
    found = differentials.zero_slip_ratios(differentials.equations(name))
    ratios = [sp.cancel(ratio.subs(values)) for ratio in found.values()]
    assert ratios == [sp.Rational(ratio) for ratio in expected]
