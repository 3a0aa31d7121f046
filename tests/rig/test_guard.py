"""Tests that never end are ended, whatever they do; those that are slow are not."""

import subprocess
import sys
import time
from pathlib import Path

import pytest

from rig import watcher
from rig.watcher import Used, Watch

RIG = Path(__file__).parents[1]

pytestmark = pytest.mark.skipif(
    not Path("/proc/self/schedstat").exists(), reason="needs to know what processes use"
)


def _tested(folder: Path, body: str, *limits: str) -> subprocess.CompletedProcess[str]:
    """A run of pytest over one test with this body and another after it."""
    lines = "\n    ".join(body.splitlines())
    text = f"import ctypes, signal, subprocess, sys, time\n\ndef test_one():\n    {lines}\n"
    (folder / "test_one.py").write_text(text + "\ndef test_two():\n    pass\n")
    (folder / "pytest.ini").write_text("[pytest]\nmarkers =\n    most: seconds\n")
    command = [sys.executable, "-m", "pytest", "-q", "-p", "rig.guard", *limits, str(folder)]
    return subprocess.run(
        command,
        cwd=folder,
        env={"PYTHONPATH": str(RIG)},
        capture_output=True,
        text=True,
        check=False,
    )


def test_an_endless_loop_is_ended(tmp_path: Path) -> None:
    done = _tested(tmp_path, "while True:\n    pass", "--most=0.2", "--idle=0.8")
    assert "TimeoutError: no end after 0.2 s of a processor" in done.stdout
    assert "1 failed, 1 passed" in done.stdout


def test_what_a_test_starts_counts(tmp_path: Path) -> None:
    body = "subprocess.run([sys.executable, '-c', 'while True: pass'])"
    done = _tested(tmp_path, body, "--most=0.2", "--idle=0.8")
    assert "TimeoutError: no end after 0.2 s of a processor" in done.stdout
    assert "1 failed, 1 passed" in done.stdout


def test_a_test_that_waits_for_ever_is_ended(tmp_path: Path) -> None:
    done = _tested(tmp_path, "time.sleep(1e6)", "--idle=0.8")
    assert "TimeoutError: nothing done for 0.8 s" in done.stdout
    assert "1 failed, 1 passed" in done.stdout


def test_one_that_takes_no_exception_is_ended_with_its_process(tmp_path: Path) -> None:
    body = "signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGALRM])\ntime.sleep(1e6)"
    done = _tested(tmp_path, body, "--idle=0.8")
    assert done.returncode != 0
    assert "Fatal Python error: Aborted" in done.stderr
    assert "test_one.py" in done.stderr


def _watched(monkeypatch: pytest.MonkeyPatch, looks: list[Used], limit: float) -> list[str]:
    """What is told of a test that is looked at every five seconds."""
    told: list[str] = []
    clock, left = iter(range(0, 10**6, 5)), iter(looks)
    monkeypatch.setattr(time, "monotonic", lambda: next(clock))
    monkeypatch.setattr(watcher, "used", lambda pid: next(left))
    monkeypatch.setattr(Watch, "_tell", lambda self, what: told.append(what.name))
    watch = Watch(1, limit, 60.0)
    for _ in looks:
        watch.look()
    return told


def test_time_without_a_processor_is_no_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    """An hour in which a test runs for a second in all, as it is always kept waiting."""
    busy = [Used(1e-3 * k, 4.9 * k, False) for k in range(720)]
    assert _watched(monkeypatch, busy, 180.0) == []


def test_time_at_a_disk_is_no_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    assert _watched(monkeypatch, [Used(0.0, 0.0, k % 2 == 0) for k in range(100)], 180.0) == []


def test_a_slow_poll_is_a_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    polls = [Used(0.05 * k, 0.1 * k, False) for k in range(13)]
    assert _watched(monkeypatch, polls, 180.0) == ["SIGALRM"]
    assert _watched(monkeypatch, polls[:12], 180.0) == []


def test_only_the_processors_time_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    """Half of one processor: the limit of 180 s comes after six minutes."""
    half = [Used(7.0 + 2.5 * k, 2.5 * k, False) for k in range(74)]
    assert _watched(monkeypatch, half, 180.0) == ["SIGXCPU"]
    assert _watched(monkeypatch, half[:73], 180.0) == []
