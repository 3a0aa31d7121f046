"""Directional derivatives of units, and the dependencies that they tell."""

from pathlib import Path

import numpy as np
import pytest
from oracles.called import Unit
from oracles.units import Case, belt, divider, duffing, figure_11
from references.build import bond_graph

import bondgraph as bg

VERSIONS = ["2.0", "3.0"]


pytestmark = pytest.mark.usefixtures("compiled_quickly")


def test_slopes_of_an_affine_mode_are_exact(slider: Unit, tmp_path: Path) -> None:
    affine = Unit(divider(), slider.version, tmp_path, inputs={"V": 1.0})
    made = affine.started("ModelExchange")
    # C_1 V' = (C_1 + C_2) v_2' + v_2/R, of which s = v_2 - C_1/(C_1 + C_2) V is integrated.
    found = affine.slopes(made, ["der(integrated(v_2))", "v_2"], ["V"], [2.0])
    share = 0.3 / 0.5
    assert found == pytest.approx([-2.0 * share / (1.4 * 0.5), 2.0 * share], rel=1e-15)
    affine.free(made)


@pytest.mark.parametrize("version", VERSIONS)
def test_slopes_of_a_nonlinear_model_are_its_derivatives(version: str, tmp_path: Path) -> None:
    unit = Unit(duffing(), version, tmp_path, inputs={})
    made = unit.started("ModelExchange")
    m, k, c, q = 1.3, 4.0, 9.0, 1.1
    found = unit.slopes(made, ["der(v)", "der(q_s)"], ["q_s"], [1.0])
    assert found == pytest.approx([-(k + 3 * c * q**2) / m, 0.0], rel=1e-8, abs=1e-9)
    found = unit.slopes(made, ["der(v)", "der(q_s)"], ["v", "F"], [3.0, 1.0])
    assert found == pytest.approx([1 / m, 3.0], rel=1e-8)
    # Asking leaves the unit as it was.
    assert unit.get(made, "v", "q_s") == pytest.approx([-0.4, 1.1], rel=1e-15)
    unit.free(made)


@pytest.mark.parametrize("version", VERSIONS)
def test_slopes_where_a_crank_accelerates_have_the_change_of_its_inertia(
    version: str, tmp_path: Path
) -> None:
    """(J + m q^2) w' = T - m q q' w^2 with q = r sin(theta), as a whole by theta."""
    nodes = [bg.Se("drive", "T"), bg.One("shaft"), bg.I("J", "J", flow="w"),
             bg.Df("angle", integrate="theta"), bg.TF("yoke", "r*sin(theta)"), bg.One("slider"),
             bg.I("m", "m", priority=-1)]  # fmt: skip
    bonds = "drive>shaft>J shaft>angle shaft>yoke>slider>m"
    J, m, r, T, w, theta = 0.1, 2.0, 0.3, 0.4, 2.0, 0.7
    case = Case(bg.derive(bond_graph(nodes, bonds), []), {"J": J, "m": m, "r": r}, None,
                {"w": w, "theta": theta}, {"T": T}, 1.0)  # fmt: skip
    unit = Unit(case, version, tmp_path, inputs={"T": T})
    made = unit.started("ModelExchange")
    inertia = J + m * r**2 * np.sin(theta) ** 2
    twice = m * r**2 * np.sin(2 * theta)
    rate = (T - twice / 2 * w**2) / inertia
    slope = (-m * r**2 * np.cos(2 * theta) * w**2 - twice * rate) / inertia
    found = unit.slopes(made, ["der(w)", "der(theta)"], ["theta"], [1.0])
    assert found == pytest.approx([slope, 0.0], rel=1e-8, abs=1e-9)
    unit.free(made)


@pytest.mark.parametrize("make", [belt, divider, duffing, figure_11])
def test_what_a_variable_depends_on_is_told(make, tmp_path: Path) -> None:
    """No slope along anything that its dependencies leave out."""
    unit = Unit(make(), "3.0", tmp_path, inputs={})
    description = unit.description
    made = unit.started("ModelExchange")
    states = [one.variable.derivative.name for one in description.derivatives]
    knowns = states + [v.name for v in description.modelVariables if v.causality == "input"]
    for one in (*description.outputs, *description.derivatives):
        told = None if one.dependencies is None else {v.name for v in one.dependencies}
        for known in knowns:
            (slope,) = unit.slopes(made, [one.variable.name], [known], [1.0])
            assert abs(slope) < 1e-9 or told is None or known in told, (one.variable.name, known)
    assert any(one.dependencies is not None for one in description.derivatives)
    unit.free(made)


def test_dependencies_are_no_more_than_structure_asks_for(tmp_path: Path) -> None:
    unit = Unit(duffing(), "3.0", tmp_path, inputs={})
    told = {one.variable.name: one.dependencies for one in unit.description.derivatives}
    assert [one.name for one in told["der(q_s)"]] == ["v"]
