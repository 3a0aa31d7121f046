"""What is exchanged at one instant: signals that pass through, loops, events, and what is refused."""

import numpy as np
import pytest
from scipy.optimize import brentq

import bondgraph as bg
import codegen
from bondgraph.errors import AlgebraicLoopError, SignalError, SimulationError
from codegen.cosimulation.ends import End
from codegen.cosimulation.master import Master
from codegen.cosimulation.part import Given
from codegen.cosimulation.wires import Wire


def _function(name: str, text: str, *more: object) -> codegen.Simulator:
    return codegen.simulator(bg.derive(bg.graph([bg.Function(name, text), *more])), {})


def test_signals_pass_through_models_at_the_instant_itself() -> None:
    """In whatever order they are told: c = 2 b, b = a + 1, a = t^2."""
    parts = {
        "c": _function("c", "2*b"), "b": _function("b", "a + 1"), "a": _function("a", "t**2"),
    }  # fmt: skip
    run = codegen.cosimulate(parts, {"b.b": "c.b", "a.a": "b.a"}, end=1, every=0.25)
    assert run["c.c"].round(12).tolist() == [2.0, 2.125, 2.5, 3.125, 4.0]


def test_a_signal_may_go_to_and_fro_between_two_models() -> None:
    """No loop: each passes on another signal than it is told by."""
    one = _function("back", "3*there + out", bg.Function("out", "t"))
    other = _function("echo", "2*there", bg.Function("there", "heard + 1"))
    run = codegen.cosimulate(
        {"one": one, "other": other}, {"one.out": "other.heard", "other.there": "one.there"},
        end=1, every=0.5,
    )  # fmt: skip
    assert run["one.back"].round(12).tolist() == [3.0, 5.0, 7.0]


def test_a_loop_at_one_instant_is_refused_by_its_names() -> None:
    parts = {"a": _function("x", "1 - y/2"), "b": _function("y", "1 + x")}
    with pytest.raises(AlgebraicLoopError) as told:
        codegen.cosimulate(parts, {"a.x": "b.x", "b.y": "a.y"}, end=1, every=0.5)
    text = str(told.value)
    assert all(name in text for name in ("a.x", "b.x", "b.y", "a.y", "put a state"))


def test_a_state_on_the_way_opens_the_loop() -> None:
    """y' = (1 + x - y)/T, x = 1 - y/2: it rests at x = 1/3, y = 4/3."""
    lag = codegen.simulator(bg.derive(bg.graph([bg.State("y", "(1 + x - y)/T")])), {"T": 0.1})
    run = codegen.cosimulate(
        {"a": _function("x", "1 - y/2"), "b": lag}, {"a.x": "b.x", "b.y": "a.y"}, end=3, every=0.01
    )
    assert abs(run["b.y"][-1] - 4 / 3) < 1e-9


def test_controllers_of_two_models_that_read_one_another_are_a_loop() -> None:
    def one(gives: str, reads: str, offset: str) -> codegen.Simulator:
        node = bg.Controller(
            "c", every="1/10", offset=offset, reads=[reads], gives={gives: f"1 + {reads}"}
        )
        return codegen.simulator(bg.derive(bg.graph([node])), {})

    wires = {"a.p": "b.p", "b.q": "a.q"}
    with pytest.raises(AlgebraicLoopError):
        codegen.cosimulate(
            {"a": one("p", "q", "0"), "b": one("q", "p", "0")}, wires, end=1, every="1/10"
        )
    run = codegen.cosimulate(
        {"a": one("p", "q", "0"), "b": one("q", "p", "1/20")}, wires, end="3/10", every="1/10"
    )
    # At 0 a gives 1; b reads that in the middle, and gives 2, which a reads at 1/10.
    assert run["a.p"].tolist() == [1.0, 3.0, 5.0, 7.0]


def test_events_are_told_once_and_by_participant() -> None:
    """A block that rubs with 3 N, pushed by another model's square wave of 5 N, 1 s on and 1 s off."""
    graph = bg.graph(
        [bg.Se("push", "F"), bg.One("cart"), bg.I("m", 2, flow="v"),
         bg.R("rub", law=bg.DryFriction(3), effort="f")],
        "push > cart > m, cart > rub",
    )  # fmt: skip
    block = codegen.simulator(bg.derive(graph), {})
    hand = _function("push", "5*on")
    wanted = block.run(np.arange(41) / 10, inputs={"F": codegen.Square(0.5, 0.0, 5.0)})
    run = codegen.cosimulate(
        {"hand": hand, "block": block}, {"hand.push": "block.F"}, end=4, every=0.1,
        inputs={"hand.on": codegen.Square(0.5, 0.0, 1.0)},
    )  # fmt: skip
    told = [(event.port, event.kind, round(event.time, 9)) for event in run.events]
    assert told == [("block.rub", e.kind, round(e.time, 9)) for e in wanted.events]
    assert len(told) > 2
    assert np.abs(run["block.v"] - wanted["v"]).max() < 1e-9


def test_a_switched_model_takes_part() -> None:
    """i' = 1 - t - i from rest: i = 2 - t - 2 exp(-t), until the diode lets it go at its zero."""
    graph = bg.graph(
        [bg.Se("E", "E"), bg.One("wire"), bg.Diode("d"), bg.R("R", 1), bg.I("L", 1, flow="i")],
        "E > wire > d, wire > R, wire > L",
    )
    parts = {"net": codegen.switched_simulator(graph, {}), "source": _function("e", "1 - t")}
    run = codegen.cosimulate(parts, {"source.e": "net.E"}, end=3, every=0.01)
    (event,) = run.events
    zero = brentq(lambda t: 2 - t - 2 * np.exp(-t), 1, 2)
    assert (event.port, event.kind) == ("net.d", "off")
    assert abs(event.time - zero) < 0.01
    assert run["net.d"].tolist() == (run.time < event.time).astype(float).tolist()


def test_an_input_is_taken_for_what_was_told_until_it_is_known() -> None:
    """1/u has no value at 0."""
    parts = {"a": _function("y", "1/u"), "b": _function("x", "2 + t")}
    run = codegen.cosimulate(parts, {"b.x": "a.u"}, end=1, every=0.5, initial={"a": {"u": 1.0}})
    assert run["a.y"].round(9).tolist() == [0.5, 0.4, round(1 / 3, 9)]


def test_what_is_not_finite_is_refused_with_its_participant() -> None:
    parts = {"a": _function("y", "log(u)"), "b": _function("x", "1 - t")}
    with pytest.raises(bg.BondGraphError, match="participant 'a'"):
        codegen.cosimulate(parts, {"b.x": "a.u"}, end=2, every=0.5, initial={"a": {"u": 1.0}})


CART = bg.graph([bg.Se("push", "F"), bg.One("cart"), bg.I("m", 2, flow="v")], "push > cart > m")


@pytest.mark.parametrize(
    ("more", "match"),
    [
        ({"connections": {"a.w": "b.F"}}, r"there is no signal|'w'"),
        ({"connections": {"c.v": "b.F"}}, "no participant 'c'"),
        ({"connections": {"v": "b.F"}}, "write it as 'participant.signal'"),
        ({"connections": {"a.v": "b.G"}}, "'b' has no input 'G'.*it has F"),
        ({"connections": {"a.v": ["b.F", "b.F"]}}, "connected twice"),
        ({"connections": ["a.v"]}, "connections must map"),
        ({"inputs": {"a.F": 1, "b.F": 2}}, "connected to 'a.v', and has a signal as well"),
        ({"inputs": {"a.f": 1}}, "'a' has no input 'f'"),
        ({"inputs": {}}, "participant 'a': missing input.* F "),
        ({"initial": {"d": {}}}, "initial: there is no participant 'd'"),
        ({"initial": {"a": "equilibrium"}}, "initial of 'a' must map"),
        ({"initial": {"a": {"w": 1}}}, "participant 'a': 'w' is not a state"),
        ({"initial": {"b": {"F": "x"}}}, "not a finite number"),
        ({"order": ["a"]}, "order must name each participant once"),
        ({"linear": ["a.F"]}, "the input is not connected"),
        ({"linear": "b.F"}, "linear must be a list"),
        ({"every": 0.3}, r"no whole number; they end at end=0\.9 or end=1\.2"),
        ({"every": 0}, "the interval is above zero"),
        ({"every": "one"}, "number of seconds"),
        ({"end": -1}, "end after the start"),
        ({"participants": {"a": CART}}, "'a' must be a simulator or the path of a unit"),
        ({"participants": {}}, "participants must map names"),
        ({"participants": {"a.b": CART}}, "a text without a dot"),
        ({"method": "Euler"}, "unknown method"),
    ],
)  # fmt: skip
def test_what_is_refused(more: dict[str, object], match: str) -> None:
    cart = codegen.simulator(bg.derive(CART), {})
    asked = {
        "participants": {"a": cart, "b": cart}, "connections": {"a.v": "b.F"}, "end": 1, "every": 0.1,
        "inputs": {"a.F": 1}, **more,
    }  # fmt: skip
    with pytest.raises(SignalError, match=match):
        codegen.cosimulate(**asked)


def test_names_of_the_record() -> None:
    cart = codegen.simulator(bg.derive(CART), {})
    run = codegen.cosimulate({"a": cart}, {}, end=1, every=0.5, inputs={"a.F": 4})
    assert run["a.p_m"].tolist() == [0.0, 2.0, 4.0]
    with pytest.raises(KeyError, match=r"did you mean 'a\.v'"):
        run["b.v"]
    with pytest.raises(SignalError, match="there is no participant 'b'"):
        run.of("b")


class _Mirror:
    """A participant that shows the opposite of what it is given, and says that it does not."""

    inputs, time, columns, units, events = ("u",), 0.0, {}, {}, ()

    def __init__(self, name: str) -> None:
        self.name, self._u = name, 0.0

    def fed(self, signal: str, first: bool) -> frozenset[str]:
        return frozenset()

    def certain(self, first: bool) -> bool:
        return True

    def begin(self, time: float) -> None:
        self.time = time

    def give(self, given: dict[str, Given]) -> bool:
        before, self._u = self._u, given["u"].value
        return self._u != before

    def read(self, signal: str) -> float:
        return 1.0 - 2.0 * self._u


def test_signals_that_do_not_settle_are_refused() -> None:
    parts = {name: _Mirror(name) for name in "ab"}
    wires = [Wire(End("a", "y"), End("b", "u")), Wire(End("b", "y"), End("a", "u"))]
    with pytest.raises(SimulationError, match=r"signals between ., . do not settle"):
        Master(parts, wires, None).run(np.array([0.0, 1.0]))


def test_tables(tmp_path: object) -> None:
    cart = codegen.simulator(bg.derive(CART), {})
    run = codegen.cosimulate({"a": cart, "b": cart}, {"a.v": "b.F"}, 1, 0.5, inputs={"a.F": 4})
    assert run.to_pandas()["b.v"].tolist() == run["b.v"].tolist()
    assert run.to_xarray()["a.v"].values.tolist() == [0.0, 1.0, 2.0]
    for write, name in (
        (run.write_csv, "r.csv"),
        (run.write_parquet, "r.parquet"),
        (run.write_mat, "r.mat"),
    ):
        write(tmp_path / name)
        again = codegen.Sampled.read(tmp_path / name, "t", "b.v")
        assert again(1.0) == run["b.v"][-1]
    run.write_netcdf(tmp_path / "r.nc")
    assert "2 intervals" in str(run)


def test_pictures() -> None:
    cart = codegen.simulator(bg.derive(CART), {})
    run = codegen.cosimulate({"a": cart, "b": cart}, {"a.v": "b.F"}, 1, 0.5, inputs={"a.F": 4})
    assert len(run.plot().axes) == 1
    assert len(run.plot(["a.v", "b.v"], "a.F").axes) == 2
    assert run.plot("b.v").axes[0].lines[0].get_ydata().tolist() == run["b.v"].tolist()
    with pytest.raises(SignalError, match="participant 'b': no signal 'w'"):
        run.plot("b.w")
