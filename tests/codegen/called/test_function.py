"""Python functions as inputs: runs against closed forms, and what is refused where."""

import math
import pickle
from collections.abc import Callable

import numpy as np
import pytest
from oracles.driven import mass
from oracles.models import series_circuit
from oracles.sweeping import spring_mass
from references.build import bond_graph

import bondgraph as bg
import codegen
from codegen import Sampled, TimeFunction

TIMES = np.linspace(0.0, 4.0, 81)


def _spike(t: float) -> float:
    return math.exp(-((t - 2.05) ** 2) * 1e6)


CASES: dict[str, tuple[Callable[[float], float], tuple[float, ...], Callable[[float], float]]] = {
    "smooth": (lambda t: math.cos(3 * t), (), lambda t: math.sin(3 * t) / 3),
    "fast": (lambda t: math.cos(400 * t), (), lambda t: math.sin(400 * t) / 400),
    "decay": (lambda t: math.exp(-50 * t), (), lambda t: -math.expm1(-50 * t) / 50),
    "corner": (lambda t: abs(t - 1.3), (), lambda t: (abs(t - 1.3) * (t - 1.3) + 1.69) / 2),
    "corner told": (lambda t: abs(t - 1.3), (1.3,), lambda t: (abs(t - 1.3) * (t - 1.3) + 1.69) / 2),
    "jump": (lambda t: float(t > math.pi / 2), (), lambda t: max(t - math.pi / 2, 0.0)),
    "jump told": (lambda t: float(t >= 1.3), (1.3,), lambda t: max(t - 1.3, 0.0)),
    "jump halfway": (lambda t: float(t > 2.0), (), lambda t: max(t - 2.0, 0.0)),
    "root": (math.sqrt, (), lambda t: t**1.5 / 1.5),
    "spike that a sample meets": (
        _spike, (), lambda t: math.sqrt(math.pi) / 2e3 * (math.erf(1e3 * (t - 2.05)) + 1)),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("method", ["exact", "DOP853"])
def test_the_speed_of_a_mass_is_the_integral_in_closed_form(name: str, method: str) -> None:
    function, breaks, integral = CASES[name]
    given = TimeFunction(function, breaks) if breaks else function
    run = mass().run(TIMES, {"v": 0.0}, {"F": given}, method)
    # Exact steps keep to rounding and what the function is missed by, DOP853 to a run's tolerances.
    off = 1e-10 if method == "exact" else 1e-7
    assert run["v"] == pytest.approx([integral(t) / 2 for t in TIMES.tolist()], abs=off)
    assert run["F"] == pytest.approx([function(t) for t in TIMES.tolist()], rel=1e-10, abs=1e-11)


@pytest.mark.parametrize("name", CASES)
def test_between_the_samples_it_is_missed_by_no_more_than_the_tolerance(name: str) -> None:
    function, breaks, _ = CASES[name]
    signal = TimeFunction(function, breaks).over(TIMES)
    times = np.sort(np.random.default_rng(1).uniform(0.0, 4.0, 5000))
    expected = np.array([function(t) for t in times.tolist()])
    assert signal.sampled(times) == pytest.approx(expected, rel=1e-10, abs=2e-11)


def test_a_larger_tolerance_takes_fewer_polynomials() -> None:
    function = CASES["fast"][0]
    fine, coarse = TimeFunction(function).over(TIMES), TimeFunction(function, (), 1e-4).over(TIMES)
    assert len(coarse.pieces) < len(fine.pieces) / 2
    times = np.linspace(0.0, 3.9, 3000)
    missed = abs(coarse.sampled(times) - np.cos(400 * times)).max()
    assert 1e-9 < missed < 2e-4


def test_corners_are_no_jumps_and_jumps_are() -> None:
    """What would be an impulse is refused, where the function has it and not where polynomials meet."""
    for name, jump in (
        ("smooth", None), ("corner", None), ("corner told", None), ("root", None),
        ("jump", math.pi / 2), ("jump told", 1.3), ("jump halfway", 2.0),
    ):  # fmt: skip
        found = TimeFunction(*CASES[name][:2]).over(TIMES).first_jump(0.0, 4.0)
        assert found == (jump if jump is None else pytest.approx(jump, abs=1e-10)), name


def test_impulses_of_functions_are_refused_as_of_signals() -> None:
    nodes = [bg.Sf("drive", "w"), bg.One("j"), bg.I("m", 2.0, flow="v"), bg.R("b", 1.0)]
    ready = codegen.simulator(
        bg.derive(bond_graph(nodes, "drive>j j>m j>b"), outputs=["drive"]), {}
    )
    run = ready.run(TIMES, {}, {"w": math.sin})
    assert run["e_drive"][:-1] == pytest.approx(
        2 * np.cos(TIMES[:-1]) + np.sin(TIMES[:-1]), abs=1e-9
    )
    assert run["e_drive"][-1] == pytest.approx(2 * math.cos(4.0) + math.sin(4.0), abs=1e-9)
    with pytest.raises(bg.SimulationError, match=r"input 'w' steps at t = 1\.3"):
        ready.run(TIMES, {}, {"w": TimeFunction(*CASES["jump told"][:2])})


def test_events_come_where_the_closed_form_has_them() -> None:
    """1 kg sticks on dry friction of 1 N until the force of 2 sin t is above: at pi/6."""
    nodes = [
        bg.Se("push", "F"),
        bg.One("j"),
        bg.I("m", 1.0, flow="v"),
        bg.R("rub", effort="F_r", flow="w"),
    ]
    ready = codegen.simulator(
        bg.derive(bond_graph(nodes, "push>j j>m j>rub")), {}, {"rub": bg.DryFriction("1")})  # fmt: skip
    run = ready.run(TIMES, {"v": 0.0}, {"F": lambda t: 2 * math.sin(t)})
    assert (run.events[0].kind, run.events[0].time) == (
        "slip",
        pytest.approx(math.pi / 6, abs=1e-9),
    )


@pytest.mark.parametrize(
    ("function", "told"),
    [
        (lambda t: 1 / (t - 2), r"input 'F': TimeFunction\(.*\) raised ZeroDivisionError at t = 2"),
        (lambda t: "a", r"input 'F': .* gives 'a' at t = 0, which is no finite number"),
        (lambda t: 1j, r"gives 1j at t = 0"),
        (lambda t: float("nan"), r"gives nan at t = 0"),
        (lambda t: [t], r"gives \[0.0\] at t = 0"),
        (lambda: 1.0, r"raised TypeError at t = 0"),
        (lambda t: hash(t) % 1000 / 1e3, r"does more than 100000 polynomials .*codegen\.Sampled"),
    ],
)
def test_what_gives_no_input_is_refused_by_name(function: Callable[..., object], told: str) -> None:
    with pytest.raises(bg.SignalError, match=told):
        mass().run(TIMES, {}, {"F": function})


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ((3,), r"3 is no Python function"),
        ((codegen.Constant(1),), r"is no Python function"),
        ((math.sin, ["a"]), r"TimeFunction\(math\.sin.*breakpoints must be numbers"),
        ((math.sin, [math.inf]), r"a breakpoint is not finite"),
        ((math.sin, (), 0.0), r"tolerance=0\.0 is not between 0 and 1"),
        ((math.sin, (), True), r"tolerance=True is not between"),
    ],
)
def test_what_is_no_function_is_refused(arguments: tuple[object, ...], told: str) -> None:
    with pytest.raises(bg.SignalError, match=told):
        TimeFunction(*arguments)  # type: ignore[arg-type]


@pytest.mark.parametrize("times", [[0.0], [1.0, 1.0], [0.0, math.inf], ["a", "b"]])
def test_a_stretch_has_two_ends(times: list[float]) -> None:
    with pytest.raises(bg.SignalError, match=r"two finite times or more|must be numbers"):
        TimeFunction(math.sin).over(times)


OUT = r"'V'.*only runs in numpy call; give its polynomials, .*over\(times\), or samples, codegen\.Sampled"
NUMBERS = {"R": 1.0, "L": 1.0, "C": 1.0}


def test_c_and_exports_refuse_it_and_tell_the_ways_out() -> None:
    equations = bg.derive(series_circuit())
    with pytest.raises(bg.SignalError, match=OUT):
        codegen.simulator(equations, NUMBERS, backend="c").run(TIMES, {}, {"V": math.sin})
    with pytest.raises(bg.SignalError, match=OUT):
        codegen.to_c(equations, NUMBERS, main=True, inputs={"V": math.sin})
    with pytest.raises(bg.SignalError, match=OUT):
        codegen.write_fmu("a.fmu", equations, NUMBERS, inputs={"V": TimeFunction(math.sin)})
    family = codegen.Family(equations, NUMBERS, backend="c")
    with pytest.raises(bg.SignalError, match=OUT):
        codegen.sweep(
            family, {"R": [1, 2]}, TIMES, {"i": codegen.final("i")}, inputs={"V": math.sin}
        )
    with pytest.raises(bg.SignalError, match="a lag follows a signal, not"):
        codegen.Lag(TimeFunction(math.sin), 0.1)  # type: ignore[arg-type]


def test_the_ways_out_give_what_the_function_gives() -> None:
    expected = np.sin(TIMES) / 2
    over = TimeFunction(math.cos).over(TIMES)
    assert mass("c").run(TIMES, {}, {"F": over})["v"] == pytest.approx(expected, abs=1e-10)
    fine = np.linspace(0.0, 4.0, 4001)
    cubics = Sampled(fine, np.cos(fine), "pchip")
    assert mass("c").run(TIMES, {}, {"F": cubics})["v"] == pytest.approx(expected, abs=1e-6)
    lagged = codegen.Lag(over, 0.5)(3.0)
    # 0.5 y' + y = cos t from y = 1 on.
    steady = (math.cos(3.0) + 0.5 * math.sin(3.0)) / 1.25
    assert lagged == pytest.approx(steady + (1 - 1 / 1.25) * math.exp(-6.0), abs=1e-10)


@pytest.mark.parametrize("workers", [0, 1])
def test_sweeps_in_numpy_take_functions(workers: int) -> None:
    """Processes get what was made of them: a lambda could not be sent."""
    found = codegen.sweep(
        spring_mass(), {"v": [0.0, 1.0]}, TIMES, {"end": codegen.samples("P")},
        inputs={"P": lambda t: math.cos(t)}, workers=workers, progress=False,
    )  # fmt: skip
    assert not found.failed
    assert found["end"][0] == pytest.approx(np.cos(TIMES), abs=1e-11)


def test_sparse_runs_take_functions() -> None:
    nodes = [bg.Se("push", "F"), bg.One("j"), bg.I("m", 2.0, flow="v")]
    model = codegen.sparse_model(bond_graph(nodes, "push>j>m"), {})
    run = codegen.run_sparse(model, TIMES, inputs={"F": math.cos})
    assert run["v"] == pytest.approx(np.sin(TIMES) / 2, abs=1e-7)


def test_what_is_made_is_the_same_every_time_and_tells_itself() -> None:
    one, other = (TimeFunction(math.sin).over(TIMES) for _ in range(2))
    assert (one, repr(one)) == (other, repr(other))
    assert pickle.loads(pickle.dumps(one)) == one
    assert repr(TimeFunction(math.cos).over(TIMES)) != repr(one)
    assert repr(one).startswith("<function math.sin from 0.0 to 4.")
    assert repr(TimeFunction(math.sin, [2, 1])) == "TimeFunction(math.sin, breakpoints=(1.0, 2.0))"
