"""Works, integrals and power balances of sweeps in C: closed forms over two samples."""

import numpy as np
import pytest
from oracles.models import block
from references.build import bond_graph

import bondgraph as bg
from codegen import Family, Sine, Step, balance, final, integral, peak, samples, sweep, work
from codegen.batch.exact import ExactLoop
from codegen.batch.located import LocatedLoop
from codegen.sweeps.job import Job
from codegen.sweeps.measuring import batch_of

QUIET = {"progress": False, "workers": 2}
ENDS = np.array([0.0, 5.0])


def _damped(law: object = None) -> Family:
    """A mass on a damper, with a spring that may be slack."""
    damper = bg.R("b", "b", effort="F_b") if law is None else bg.R("b", law=law, effort="F_b")
    graph = bond_graph([bg.One("m"), bg.I("M", "m", flow="v"), damper], "m>M m>b")
    return Family(bg.derive(graph), {"m": 2, "b": 40}, backend="c")


@pytest.mark.parametrize("method", ["auto", "DOP853", "Radau"])
def test_what_a_damper_takes_over_two_samples(method: str) -> None:
    measures = {"lost": work("b"), "way": integral("v"), "open": balance(), "end": final("v"),
                "all": samples("v"), "most": peak("v")}  # fmt: skip
    found = sweep(
        _damped(), {"b": [4.0, 40.0], "v": [5.0, -3.0]}, ENDS, measures, method=method, **QUIET
    )
    b, v = found["b"], found["v"]
    gone = np.exp(-b / 2 * 5.0)
    assert found["lost"] == pytest.approx(v**2 * (1 - gone**2), rel=1e-8)
    assert found["way"] == pytest.approx(2 * v / b * (1 - gone), rel=1e-8)
    assert (found["open"] < 1e-9).all()
    assert found["all"] == pytest.approx(np.column_stack([v, v * gone]), abs=1e-8)
    assert found["most"] == pytest.approx(abs(v))


def test_the_loops_do_these_runs_themselves() -> None:
    for method, kind in (("auto", ExactLoop), ("Radau", LocatedLoop)):
        settings = {"method": method, "rtol": 1e-10, "atol": 1e-11}
        job = Job(
            _damped(),
            ("b",),
            ENDS,
            {"lost": work("b"), "open": balance()},
            {"v": 5.0},
            None,
            settings,
        )
        loop = batch_of(job)
        assert loop is not None
        assert isinstance(loop.loop, kind)
        (lost, _), left = loop([(40.0,), (20.0,)])
        assert left == []
        assert lost == pytest.approx([25, 25], rel=1e-8)


def test_a_law_whose_number_is_swept_closes_by_its_power() -> None:
    found = sweep(
        _damped("b*v**3"), {"b": [0.5, 4.0]}, ENDS, {"lost": work("b"), "open": balance()},
        {"v": 3.0}, **QUIET,
    )  # fmt: skip
    ends = 9 / (1 + found["b"] * 9 * 5.0)
    assert found["lost"] == pytest.approx(9 - ends, rel=1e-8)
    assert (found["open"] < 1e-9).all()


def test_friction_that_sticks_is_worked_out_by_hand() -> None:
    """A mass of 2 under friction F slides 36/F m, losing its 36 J, and then holds a push of 1."""
    family = Family(bg.derive(block()), {"m": 2.0, "F_c": 4.0}, backend="c")
    measures = {
        "lost": work("ground"),
        "gave": work("push"),
        "held": integral("f"),
        "open": balance(),
    }
    for method in ("auto", "DOP853"):
        found = sweep(
            family, {"F_c": [4.0, 6.0]}, [0.0, 10.0], measures, {"v": 6.0}, {"P": Step(5.0, 1.0)},
            method=method, **QUIET,
        )  # fmt: skip
        assert found["lost"] == pytest.approx([36, 36], rel=1e-8)
        assert found["gave"] == pytest.approx([0, 0], abs=1e-7)
        assert found["held"] == pytest.approx([17, 17], rel=1e-8)
        assert (found["open"] < 1e-9).all()


def test_a_stretch_of_many_time_constants() -> None:
    """5 s of a pole at -1e4/s beside one at -0.1/s, in one interval."""
    nodes = [bg.Se("battery", "E"), bg.Zero("bus"), bg.One("a"), bg.C("fast", "c", effort="u"),
             bg.R("r", 1), bg.One("b"), bg.C("slow", 1, effort="w"), bg.R("s", 10)]  # fmt: skip
    equations = bg.derive(bond_graph(nodes, "battery>bus>a>fast a>r bus>b>slow b>s"))
    family = Family(equations, {"c": 1e-4}, backend="c")
    measures = {"slow": work("s"), "fast": work("r"), "open": balance()}
    found = sweep(family, {"u": [3.0, 1.0], "c": [1e-4]}, ENDS, measures, None, {"E": 2.0}, **QUIET)
    assert found["slow"] == pytest.approx(2 * (1 - np.exp(-1)), rel=1e-9)
    assert found["fast"] == pytest.approx(0.5e-4, rel=1e-8)
    assert (found["open"] < 1e-9).all()


def test_fields_and_nodes_that_are_none() -> None:
    nodes = [bg.Se("push", "P"), bg.One("a"), bg.One("b"), bg.R("r", 4), bg.R("s", 1),
             bg.I("pair", [["m", 1], [1, 3]], ports=["x", "y"])]  # fmt: skip
    graph = bond_graph(nodes, "push>a>r b>s")
    graph.add_edge("a", "pair", port="x")
    graph.add_edge("b", "pair", port="y")
    family, inputs = Family(bg.derive(graph, []), {"m": 2}, backend="c"), {"P": Sine(2.0, 0.4)}
    measures = {"pair": work("pair"), "x": work("pair.x"), "y": work("pair.y"), "open": balance()}
    found = sweep(family, {"m": [2.0, 5.0]}, ENDS, measures, None, inputs, **QUIET)
    alone = family.simulator(m=5.0).run(ENDS, {}, inputs)
    assert found["pair"] == pytest.approx(found["x"] + found["y"])
    assert found["pair"][1] == pytest.approx(alone.work("pair")[-1], rel=1e-9)
    assert (found["open"] < 1e-9).all()
    here = {"progress": False, "workers": 0}
    wrong = sweep(family, {"m": [2.0]}, ENDS, {"w": work("a")}, None, inputs, **here)
    assert "'a' is not a one-port" in wrong.failed[0].message
