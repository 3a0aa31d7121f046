"""The command line as a newcomer meets it."""

import subprocess
import sys
from pathlib import Path

import numpy as np


def command(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "differentials", *arguments],
        capture_output=True,
        text=True,
        check=False,
    )


def test_the_demo_prints_what_it_found_and_writes_what_it_says(tmp_path: Path) -> None:
    done = command("demo", "--out", str(tmp_path / "made here"))
    assert (done.returncode, done.stderr) == (0, "")
    for part in ("dependent (derivative causality):   I_i", "A = ", "B = ", "F = [1/2  -1/2]"):
        assert part in done.stdout
    assert "t = 0.501222 s   clutch sticks" in done.stdout
    assert "t = 0.568431 s   clutch slips again" in done.stdout
    table, picture = (tmp_path / "made here" / f"alsd_fig11.{end}" for end in ("csv", "png"))
    assert str(table) in done.stdout
    assert str(picture) in done.stdout
    assert picture.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    data = np.genfromtxt(table, delimiter=",", names=True)
    assert len(data) == 1001
    assert abs(data["omega_f"][510:560]).max() < 1e-9


def test_a_folder_that_cannot_be_made_is_one_clear_line(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    done = command("demo", "--out", str(tmp_path / "file" / "deeper"))
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1
    assert "python -m differentials: " in done.stderr


def test_help_and_unknown_commands() -> None:
    assert "demo" in command("--help").stdout
    wrong = command("dance")
    assert wrong.returncode == 2
    assert "invalid choice: 'dance'" in wrong.stderr
