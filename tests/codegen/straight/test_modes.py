"""The straight-line functions of modes give what the evaluation gives, or leave it to that."""

import random
import warnings
from collections.abc import Iterator

import numpy as np
import pytest
from oracles.routes.kind import Kind
from oracles.routes.kinds import KINDS
from references.build import bond_graph
from references.random_mechanisms import NUMBERS, random_mechanism

import bondgraph as bg
from bondgraph.errors import SimulationError
from codegen import Constant, simulator
from codegen.inputs.pieces import constant_piece
from codegen.modes.closed import ClosedModel
from codegen.straight.sums import PARTS

MODES = 12
"""Of a model's modes so many are looked at."""


def _modes(model: ClosedModel) -> list[tuple[int, ...]]:
    count = len(model.switching)
    found = {(1,) * count, (0,) * count, (-1,) * count}
    found |= {tuple(0 if i == at else 1 for i in range(count)) for at in range(count)}
    return sorted(found)[:MODES]


def _instants(model: ClosedModel, seed: int, count: int) -> Iterator[tuple[float, ...]]:
    rng = np.random.default_rng(seed)
    for _ in range(count):
        given = rng.uniform(0.2, 2, size=(2, len(model.program.external)))
        yield float(rng.uniform(0, 1)), rng.uniform(-1, 1.5, size=model.size), *given


def _compared(model: ClosedModel, seed: int = 0, count: int = 6) -> int:
    """In how many modes straight-line functions agree with the evaluation at all points with values."""
    agreed = 0
    for mode in _modes(model):
        fast = model.straight.of(mode)
        if fast is None:
            continue
        points = 0
        for t, s, w, dw in _instants(model, seed, count):
            try:
                found = fast.of(*PARTS)(t, s.tolist(), w.tolist(), dw.tolist())
            except (ArithmeticError, TypeError, ValueError):
                found = None
            if found is None:
                continue
            with np.errstate(all="ignore"):
                now = model.evaluate(t, s, w, dw, mode)
            expected = np.concatenate([getattr(now, part) for part in PARTS])
            size = np.abs(expected).max() + 1
            assert np.abs(np.array(found) - expected).max() <= 1e-11 * size, mode
            rate = fast.of("rate")(t, s.tolist(), w.tolist(), dw.tolist())
            assert np.abs(np.array(rate) - now.rate).max() <= 1e-11 * size
            tables = fast.over(*(np.stack([part] * 2, axis=-1) for part in (t, s, w, dw)))
            if tables is not None:
                rows = np.concatenate([tables[part][1] for part in PARTS])
                assert np.abs(rows - expected).max() <= 1e-11 * size
            points += 1
        agreed += points > 0
    return agreed


def _model(kind: Kind) -> ClosedModel:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return simulator(kind.equations, kind.numbers, kind.laws or None).closed


@pytest.fixture(scope="module")
def models() -> dict[str, ClosedModel]:
    """All kinds whose modes are not affine."""
    found = {name: _model(make()) for name, make in KINDS.items()}
    return {name: model for name, model in found.items() if not model.program.affine}


def test_every_kind_agrees_with_the_evaluation(models: dict[str, ClosedModel]) -> None:
    agreed = {name: _compared(model) for name, model in models.items()}
    assert sum(agreed.values()) >= 20


def test_they_are_there_unless_laws_are_solved_with_friction(
    models: dict[str, ClosedModel],
) -> None:
    """By nothing else in the table; nor while what sticks does so by matrices that change."""
    slipping = {
        name: model.straight.of((1,) * len(model.switching)) for name, model in models.items()
    }
    without = {name for name, fast in slipping.items() if fast is None}
    assert without == {name for name, model in models.items() if model.program.joint}
    assert len(without) <= len(models) / 8
    for name, model in models.items():
        stuck = model.straight.of((0,) * len(model.switching))
        changes = model.program.varying and bool(model.switching)
        assert (stuck is None) == (model.program.joint or changes), name


SPRINGS = ("q_{0}/c", "q_{0}/c + q_{0}**3", "sinh(q_{0})", "q_{0}/sqrt(1 + q_{0}**2)",
           "abs(q_{0})*q_{0}", "min(q_{0}, c)", "Piecewise((q_{0}, q_{0} > 0), (2*q_{0}, True))")  # fmt: skip
DAMPERS = ("d*f_{0}", "sign(f_{0})*sqrt(abs(f_{0}))", "f_{0}*(1 + w0**2)", "max(d*f_{0}, -1)",
           "atan2(f_{0}, 2)", "d*f_{0}*sin(t)**2", "exp(f_{0}/9) - F/(2 + w0**2)")  # fmt: skip
RUBBING = (bg.DryFriction("2 + q_s0**2", curve="1 + exp(-slip**2)"), bg.DryFriction("1 + w0**2"))


def _random(seed: int) -> ClosedModel:
    """Masses in a row with springs, dampers and friction between them; some dampers face one another."""
    rng = random.Random(seed)
    nodes, bonds = [bg.Se("push", "F")], []
    count = rng.randint(1, 4)
    for i in range(count):
        nodes += [bg.One(f"v{i}"), bg.I(f"m{i}", f"{i + 1}*m", flow=f"w{i}")]
        bonds.append(f"v{i}>m{i}")
        spring = bg.C(f"s{i}", law=rng.choice(SPRINGS).format(f"s{i}"))
        nodes += [spring, bg.One(f"b{i}"), bg.R(f"d{i}", law=rng.choice(DAMPERS).format(f"d{i}"))]
        if i:
            nodes.append(bg.Zero(f"z{i}"))
            bonds.append(f"v{i}>z{i}>v{i - 1} z{i}>b{i} b{i}>s{i} b{i}>d{i}")
        else:
            bonds.append("push>v0 v0>b0 b0>s0 b0>d0")
        kind = rng.random()
        if kind < 0.4:
            nodes.append(bg.R(f"f{i}", law=rng.choice(RUBBING)))
            bonds.append(f"v{i}>f{i}")
        elif kind < 0.7:
            # Two laws in a row, which are solved together.
            nodes += [bg.Zero(f"o{i}"), bg.R(f"r{i}", law=f"f_r{i} + f_r{i}**3", gives="effort"),
                      bg.R(f"q{i}", law=f"tanh(e_q{i}) + e_q{i}", gives="flow")]  # fmt: skip
            bonds.append(f"v{i}>o{i} o{i}>r{i} o{i}>q{i}")
    equations = bg.derive(bond_graph(nodes, " ".join(bonds)))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return simulator(equations, {"m": 1.3, "c": 0.4, "d": 0.7}).closed


@pytest.mark.parametrize("seed", range(25))
def test_random_nonlinear_graphs_agree(seed: int) -> None:
    model = _random(seed)
    assert not model.program.varying
    assert _compared(model, seed) >= 1


@pytest.mark.parametrize("seed", range(15))
def test_mechanisms_whose_matrices_change_agree(seed: int) -> None:
    graph, _ = random_mechanism(random.Random(seed))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model = simulator(bg.derive(graph), NUMBERS).closed
    if not model.program.affine and not model.program.joint:
        assert _compared(model, seed) >= 1


@pytest.mark.parametrize("seed", range(5))
def test_laws_on_one_side_of_corners_agree(seed: int) -> None:
    model = _random(seed)
    sides = len(model.program.sides)
    if sides:
        for sign in (1, -1):
            assert _compared(model.on_sides((sign,) * sides), seed) >= 0


FAILING = {
    "1/q_s**2": (0.0, "a law has no value"),
    "q_s**0.3": (-1.0, "a law has no value"),
    "1/(q_s - 1)": (1.0, "a law has no value"),
}


@pytest.mark.parametrize("law", FAILING)
def test_what_has_no_value_is_told_by_the_evaluation(law: str) -> None:
    """The same place and time as without them."""
    state, words = FAILING[law]
    graph = bond_graph([bg.One("n"), bg.I("m", 1, flow="v"), bg.C("s", law=law)], "n>m n>s")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model = simulator(bg.derive(graph), {}).closed
    rates = model.rates([], ())
    with pytest.raises(SimulationError, match=rf"at t = 0\.25 {words}"), np.errstate(all="ignore"):
        rates(0.25, np.array([0.0, state]))


def test_a_level_below_zero_is_told_by_the_evaluation() -> None:
    nodes = [bg.Se("push", "F"), bg.One("n"), bg.I("m", 1, flow="v"), bg.C("s", law="q_s**3"),
             bg.R("rub", law=bg.DryFriction("1 - 4*F**2"))]  # fmt: skip
    model = simulator(bg.derive(bond_graph(nodes, "push>n n>m n>s n>rub")), {}).closed
    assert model.straight.of((1,)) is not None
    rates = model.rates([constant_piece(0.0, 1.0)], (1,))
    with pytest.raises(SimulationError, match=r"at t = 0\.5 the friction at 'rub' has level -3"):
        rates(0.5, np.array([0.1, 0.2]))


def test_rates_that_are_not_finite_end_a_run_where_they_are() -> None:
    graph = bond_graph(
        [bg.One("n"), bg.I("m", 1, flow="v"), bg.R("r", law="-exp(f_r**2)")], "n>m n>r"
    )
    ready = simulator(bg.derive(graph), {})
    with pytest.raises(SimulationError, match="at t = "):
        ready.run(np.linspace(0, 50, 11), {"v": 1.0})


def test_samples_are_what_an_evaluation_at_each_gives() -> None:
    model = simulator(_loops(), {"k": 2.0})
    run = model.run(np.linspace(0, 1, 21), {"q_s": 0.7}, {"F": Constant(0.3)})
    for at in (0, 7, 20):
        force = run["F"][at] - 2.0 * run["q_s"][at] ** 3 - run["e_r"][at]
        rate = model.rhs(run.time[at], [run["v"][at], run["q_s"][at]], [0.3])
        assert rate[0] == pytest.approx(force, rel=1e-9)


def _loops() -> bg.StateEquations:
    nodes = [bg.Se("push", "F"), bg.One("n"), bg.I("m", 1, flow="v"), bg.C("s", law="k*q_s**3"),
             bg.Zero("o"), bg.R("r", law="f_r + f_r**3"),
             bg.R("q", law="tanh(e_q)", gives="flow")]  # fmt: skip
    return bg.derive(bond_graph(nodes, "push>n n>m n>s n>o o>r o>q"), outputs=["r"])
