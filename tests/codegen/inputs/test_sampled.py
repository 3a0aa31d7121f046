"""Samples as inputs: what is between them, by numpy and scipy, and that long rows cost no more an instant."""

from pathlib import Path

import numpy as np
import pytest
from oracles.driven import mass
from scipy.interpolate import PchipInterpolator

import bondgraph as bg
import codegen
from codegen import Lag, Sampled, Signal, ZeroOrderHold
from codegen.inputs.chains import by_pieces
from codegen.inputs.pieces import Piece
from codegen.numbers.arrays import Array

RNG = np.random.default_rng(5)
TIMES = np.cumsum(RNG.uniform(0.05, 0.3, 24)) - 0.4
VALUES = RNG.normal(0.0, 3.0, 24)
INSIDE = np.linspace(TIMES[0], TIMES[-1], 997)[:-1]


def _held(t: Array) -> Array:
    return VALUES[np.searchsorted(TIMES, t, side="right") - 1]


BETWEEN = {
    "linear": lambda t: np.interp(t, TIMES, VALUES),
    "held": _held,
    "pchip": PchipInterpolator(TIMES, VALUES),
}


@pytest.mark.parametrize("kind", BETWEEN)
def test_between_samples_it_is_what_numpy_and_scipy_make_of_them(kind: str) -> None:
    signal = Sampled(TIMES, VALUES, kind)
    assert signal.sampled(INSIDE) == pytest.approx(BETWEEN[kind](INSIDE), rel=1e-12, abs=1e-12)
    assert [signal(t) for t in INSIDE.tolist()] == signal.sampled(INSIDE).tolist()
    assert [signal(t) for t in TIMES.tolist()] == pytest.approx(VALUES.tolist(), rel=1e-15)


@pytest.mark.parametrize("kind", BETWEEN)
def test_outside_the_first_and_the_last_value_are_held(kind: str) -> None:
    signal = Sampled(TIMES, VALUES, kind)
    outer = np.array([TIMES[0] - 5, TIMES[0] - 1e-9, TIMES[-1], TIMES[-1] + 5])
    assert signal.sampled(outer).tolist() == [VALUES[0], VALUES[0], VALUES[-1], VALUES[-1]]
    assert signal.sampled(outer, rates=True).tolist() == [0.0] * 4


def test_rates_are_those_of_scipys_cubics() -> None:
    found = Sampled(TIMES, VALUES, "pchip").sampled(INSIDE, rates=True)
    assert found == pytest.approx(PchipInterpolator(TIMES, VALUES)(INSIDE, 1), rel=1e-9, abs=1e-9)


def test_cubics_do_not_overshoot() -> None:
    signal = Sampled([0, 1, 2, 3, 4], [0, 0, 1, 1, 5], "pchip")
    assert signal.sampled(np.linspace(0, 1, 50)).tolist() == [0.0] * 50
    assert signal.sampled(np.linspace(2, 2.999, 50)).tolist() == pytest.approx(
        [1.0] * 50, abs=1e-15
    )
    rising = signal.sampled(np.linspace(1, 2, 200))
    assert (np.diff(rising) >= 0).all()


def test_held_samples_are_a_zero_order_hold() -> None:
    one, other = Sampled(TIMES, VALUES, "held"), ZeroOrderHold(TIMES, VALUES)
    assert (one.breakpoints, one.pieces) == (other.breakpoints, other.pieces)


def _speeds(kind: str, t: Array) -> Array:
    """The integral of the force over 2 kg from the first sample on."""
    if kind == "pchip":
        return np.asarray(PchipInterpolator(TIMES, VALUES).antiderivative()(t)) / 2
    every = np.unique(np.concatenate([t, TIMES]))
    force = BETWEEN[kind]
    if kind == "linear":
        steps = np.diff(every) * (force(every)[1:] + force(every)[:-1]) / 2
    else:
        steps = np.diff(every) * force(every[:-1])
    return np.interp(t, every, np.append(0.0, np.cumsum(steps))) / 2


@pytest.mark.parametrize("kind", BETWEEN)
@pytest.mark.parametrize("method", ["exact", "DOP853"])
@pytest.mark.parametrize("backend", ["numpy", "c"])
def test_runs_integrate_them_exactly(kind: str, method: str, backend: str) -> None:
    inputs = {"F": Sampled(TIMES, VALUES, kind)}
    run = mass(backend).run(INSIDE, {"v": 0.0}, inputs, method)
    assert run.backend == backend
    assert run["v"] == pytest.approx(_speeds(kind, INSIDE), abs=1e-9)


def test_straight_lines_and_cubics_do_not_jump_however_large_they_are() -> None:
    """From 1e9 down to 1e-9 a line's end is off by more than the sample there."""
    for kind in ("linear", "pchip"):
        assert Sampled([0, 0.3, 1], [1e9, 1e-9, 1], kind).first_jump(-1, 2) is None
    held = Sampled([0, 1, 2, 3], [1, 1, 4, 4], "held")
    assert (held.first_jump(-1, 9), held.first_jump(2, 9)) == (2.0, None)


@pytest.mark.parametrize("kind", BETWEEN)
def test_sums_multiples_and_lags_are_of_what_is_between(kind: str) -> None:
    signal = Sampled(TIMES, VALUES, kind)
    total = 2 * signal + codegen.Step(0.5, 1.0)
    expected = 2 * BETWEEN[kind](INSIDE) + (INSIDE >= 0.5)
    assert total.sampled(INSIDE) == pytest.approx(expected, rel=1e-9, abs=1e-9)
    behind = Lag(signal, 0.2)
    late, step = INSIDE[400], 1e-5
    slope = (behind(late + step) - behind(late - step)) / (2 * step)
    assert 0.2 * slope + behind(late) == pytest.approx(BETWEEN[kind](late), abs=1e-6)


def test_a_long_row_shows_itself_by_a_digest() -> None:
    one, other = Sampled(np.arange(100), np.zeros(100)), Sampled(np.arange(100), np.ones(100))
    assert repr(one).startswith("Sampled(<100 samples from 0.0 to 99.0 s, sha256 ")
    assert repr(one) != repr(other)
    assert repr(Sampled([0, 1], [2, 3], "held")) == (
        "Sampled(times=(0.0, 1.0), values=(2.0, 3.0), kind='held')"
    )


ROWS = 20_000
LONG = np.arange(ROWS) * 1e-3
SIGNALS: dict[str, Signal] = {
    **{kind: Sampled(LONG, np.sin(LONG), kind) for kind in BETWEEN},
    "hold": ZeroOrderHold(LONG, np.sin(LONG)),
}


@pytest.mark.parametrize("name", SIGNALS)
def test_what_is_asked_at_an_instant_makes_nothing_of_all_rows(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Neither a copy of the breakpoints nor the pieces of all stretches."""
    signal, made = SIGNALS[name], [0]
    plain = Piece.__init__

    def counting(*given: object) -> None:
        made[0] += 1
        plain(*given)  # type: ignore[arg-type]

    monkeypatch.setattr(Piece, "__init__", counting)
    assert signal.breakpoints is signal.breakpoints
    for t in np.linspace(5.0, 5.0099, 100).tolist():
        signal.piece(t)
        signal.following(t)
        signal.preceding(t)
    assert made[0] <= 12
    signal.sampled(np.linspace(0.0, 20.0, ROWS))
    assert made[0] <= 40


class _Looked(np.ndarray):
    """Places that count how many of them are compared."""

    compared = 0

    def __eq__(self, other: object) -> object:
        type(self).compared += self.size
        return np.asarray(self) == other


def test_values_of_many_pieces_take_no_look_at_all_times_for_each() -> None:
    pieces = [Piece(0.0, ((0, (float(k),)),)) for k in range(500)]
    which = np.random.default_rng(0).integers(0, 500, 2000)
    found = by_pieces(which.view(_Looked), pieces, np.zeros(2000))
    assert found.tolist() == which.tolist()
    assert _Looked.compared == 0


def test_two_columns_of_a_file_are_an_input(tmp_path: Path) -> None:
    path = tmp_path / "cycle.csv"
    path.write_text("t,F,note\n0,0,1\n1,10,2\n3,30,3\n")
    assert Sampled.read(path, value="F") == Sampled([0, 1, 3], [0, 10, 30])
    assert Sampled.read(str(path), "t", "note", "held")(1.5) == 2.0


def test_what_is_no_row_of_samples_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "cycle.csv"
    path.write_text("t,v\n0,0\n\n2,1\n2,3\n")
    told = (
        r"cycle\.csv, line 5, column 't': times must increase, but 2\.0 follows 2\.0; sort the rows"
    )
    with pytest.raises(bg.SignalError, match=told):
        Sampled.read(path)
    path.write_text("t,v\n0,0\n")
    with pytest.raises(bg.SignalError, match=r"cycle\.csv: 1 row\(s\); samples need two"):
        Sampled.read(path)
    with pytest.raises(bg.SignalError, match=r"kind='pchp' \(did you mean 'pchip'\?\); there are"):
        Sampled([0, 1], [0, 1], "pchp")
