"""The judge of drivelines with friction: motions known in closed form, and faults that it must see."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from oracles.drivelines import SPAN, Random, as_signal, complaints, joined, random_driveline
from references.friction import Course, Machine, Wave

TIMES = np.linspace(0.0, SPAN, 21)
NOTHING = Wave()


def _constant(value: float) -> Wave:
    return Wave(values=(value,))


def _line(**changes: object) -> Random:
    """A mass of 1 on the ground, at rest, held by a friction of level 1."""
    line = Random((1.0,), (), {}, {}, ((0, None),), (_constant(1.0),), (NOTHING,), (0.0,))
    return replace(line, **changes)


def _run(line: Random) -> Course:
    return Machine(line.matrices()).run(TIMES)


def test_a_mass_is_braked_to_rest() -> None:
    course = _run(_line(start=(0.5,)))
    (time, port, kind), *more = course.events
    assert (port, kind, more) == (0, "stick", [])
    assert time == pytest.approx(0.5, abs=1e-9)
    assert np.array(course.states)[:, 0] == pytest.approx(np.maximum(0.5 - TIMES, 0), abs=1e-12)


def test_a_pulse_of_force_moves_a_mass_by_what_is_above_the_level() -> None:
    """Triangle of height 5 over 2e-4 s, crossing 1 at a fifth of each flank: by momentum, at rest again
    when what was gained, (5 - 1)^2/(2*5e4)*2, has been lost; after the pulse at a rate of 1."""
    pulse = joined(0.0, [(0.5, 0.0), (0.5001, 5.0), (0.5002, 0.0)])
    events = _run(_line(forces=(pulse,))).events
    gained = 2 * (5 - 1) ** 2 / (2 * 5e4)
    lost_in_pulse = 1 / (2 * 5e4)
    assert [kind for *_, kind in events] == ["slip", "stick"]
    assert events[0][0] == pytest.approx(0.50002, abs=1e-9)
    assert events[1][0] == pytest.approx(0.5002 + gained - lost_in_pulse, abs=1e-9)


def test_a_slip_that_a_source_rules_passes_through_zero() -> None:
    ramp = Wave(values=(-1.0,), slopes=(2.0,))
    line = Random((), (ramp,), {}, {}, ((0, None),), (_constant(10.0),), (), ())
    course = _run(line)
    assert [(round(t, 9), kind) for t, _, kind in course.events] == [(0.5, "cross")]
    assert set(course.modes) == {(-1,), (1,)}


def test_one_mass_does_not_stick_to_two_shafts_of_different_speeds() -> None:
    """Levels 3 and 1 at shafts of speed 1.9 and 1.5: it accelerates by 4, by 2 past the weaker one."""
    line = _line(
        speeds=(_constant(1.9), _constant(1.5)), friction=((0, 1), (0, 2)),
        levels=(_constant(3.0), _constant(1.0)),
    )  # fmt: skip
    course = _run(line)
    assert [(round(t, 9), port, kind) for t, port, kind in course.events] == [
        (0.375, 1, "cross"), (0.575, 0, "stick")
    ]  # fmt: skip
    assert course.modes[-1] == (0, 1)


def test_what_two_ports_hold_together_is_no_less_than_their_levels_add_up_to() -> None:
    ramp = Wave(values=(0.0,), slopes=(1.0,))
    levels = (_constant(0.7), _constant(0.5))
    line = _line(friction=((0, None), (0, None)), levels=levels, forces=(ramp,))
    assert [(round(t, 6), kind) for t, _, kind in _run(line).events] == [(1.2, "slip")] * 2


@dataclass
class _Told:
    """What stands for a run: signals by name, and events."""

    signals: dict[str, np.ndarray]
    events: list["_Event"]

    def __getitem__(self, name: str) -> np.ndarray:
        return self.signals[name]


@dataclass
class _Event:
    time: float
    port: str
    kind: str


@pytest.fixture(scope="module")
def seen() -> tuple[Random, Course]:
    """A driveline of a mass that moves, with several events."""
    for seed in range(50):
        line = random_driveline(np.random.default_rng(seed))
        course = _run(line)
        if line.masses and len(course.events) > 3:
            return line, course
    raise AssertionError("no driveline of this family has events")


def _told(line: Random, course: Course) -> _Told:
    states, machine = np.array(course.states), Machine(line.matrices())
    n = len(line.masses)
    signals = {f"v{i}": states[:, i].copy() for i in range(n)}
    signals |= {f"F{k}": c * states[:, n + k] for k, c in enumerate(line.springs.values())}
    efforts = np.array([
        machine.efforts(t, x, mode)
        for t, x, mode in zip(TIMES, states, course.modes, strict=True)
    ])  # fmt: skip
    signals |= {f"f{k}": np.nan_to_num(column) for k, column in enumerate(efforts.T)}
    return _Told(signals, [_Event(t, f"rub{k}", kind) for t, k, kind in course.events])


def test_the_judge_agrees_with_itself(seen: tuple[Random, Course]) -> None:
    assert complaints(seen[0], TIMES, _told(*seen), seen[1]) == []


def test_the_judge_sees_a_flipped_sign(seen: tuple[Random, Course]) -> None:
    told = _told(*seen)
    told.signals["f0"] *= -1
    assert any("f0" in text for text in complaints(seen[0], TIMES, told, seen[1]))


def test_the_judge_sees_a_dropped_event(seen: tuple[Random, Course]) -> None:
    told = _told(*seen)
    del told.events[1]
    assert any("events" in text for text in complaints(seen[0], TIMES, told, seen[1]))


def test_the_judge_sees_a_lost_joule(seen: tuple[Random, Course]) -> None:
    """A mass that has lost a millionth of its speed since the start."""
    told = _told(*seen)
    told.signals["v0"] *= 1 - 1e-6
    assert any("v0" in text for text in complaints(seen[0], TIMES, told, seen[1]))


def test_waves_are_the_signals_that_the_toolkit_is_given() -> None:
    rng = np.random.default_rng(7)
    for _ in range(20):
        line = random_driveline(rng)
        for wave in (*line.speeds, *line.forces, *line.levels):
            signal = as_signal(wave)
            inside = rng.uniform(0, SPAN, 20)
            assert [signal(t) for t in inside] == pytest.approx([wave(t) for t in inside], abs=1e-9)
