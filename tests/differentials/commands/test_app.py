"""Errors are one line that says how to go on; the status tells what kind of error."""

import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

from differentials.commands.app import app
from differentials.commands.homes import COMMANDS

Call = Callable[..., Result]

ROOT = Path(__file__).parents[3]
OSCILLATOR = "examples/oscillator.json"
NUMBERS = ("--set", "m=2", "--set", "k=800", "--set", "b=4")


def command(*arguments: str) -> subprocess.CompletedProcess[str]:
    """A command in a process of its own."""
    return subprocess.run(
        [sys.executable, *arguments], capture_output=True, text=True, check=False, cwd=ROOT
    )


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["show", "alds"], "no differential is called 'alds' (did you mean 'alsd'?); there is passive"),
        (["show", "passive_input_shaft", "--halfshafts"], "no model with halfshafts"),
        (["show", OSCILLATOR, "--halfshafts"], "a file has only one"),
        (["show", "nothing.json"], "there is no file 'nothing.json'"),
        (["show", "alsd", "--on", "d"], "alsd has no switches"),
        (["show", "examples/rectifier.json", "--on", "d", "--off", "d"], "'d' is on by --on and off"),
        (["modes", "examples/rectifier.json", "--on", "d", "--mode", "d=off"], "'d' is in --on and in"),
        (["modes", "examples/rectifier.json", "--mode", "d=shut"], "'d' can be 'on' or 'off', not 'shut'"),
        (["modes", "examples/rectifier.json", "--mode", "key=on"], "no switch or port is called 'key'"),
        (["show", "examples/rectifier.json", "--on", "diode"], "no switch is called 'diode'; there is d"),
        (["derive", OSCILLATOR, "--output", "sprung"], "'sprung' is not a node"),
        (["modes", "alsd", "--stuck", "clutches"], "no clutch is called 'clutches' (did you mean 'clutch'?)"),
        (["modes", "alsd", "--set", "kk=1"], "no parameter is called 'kk' (did you mean 'k'?)"),
        (["modes", OSCILLATOR, "--speed", "3"], "use --at"),
        (["modes", OSCILLATOR, "--set", "m=1"], "missing parameter(s) b, k"),
        (["simulate", "alsd", "--scenario", "fig13"], "1 clutch(es); the scenario gives 2"),
        (["simulate", "alsd", "--scenario", "figg11"], "'figg11' (did you mean 'fig11'?)"),
        (["simulate", "alsd", "--set", "k=0"], "1/k"),
        (["simulate", "alsd", "--set", "k=nan"], "parameter 'k': nan is not a finite number"),
        (["simulate", "alsd", "--initial", "omega_9=1"], "'omega_9' (did you mean 'omega_"),
        (["simulate", "alsd", "--input", "tau_x=1"], "no input is called 'tau_x'"),
        (["simulate", "alsd", "--law", "tyre_1=0"], "no clutch or tire 'tyre_1'"),
        (["simulate", "alsd", "--until", "1000", "--sample", "1e-9"], "longer --sample"),
        (["simulate", "passive_halfshafts", "--backlash"], "no shaft that could have backlash"),
        (["simulate", OSCILLATOR, "--scenario", "fig11"], "use --initial, --input and --until"),
        (["simulate", OSCILLATOR, "--set", "m=2"], "no number for b, k; add --set b=NUMBER --set k=NUMBER"),
        (["simulate", OSCILLATOR, *NUMBERS], "nothing gives F; add --input F="),
        (["sweep", "alsd", "--grid", "k=1:2:2"], "add --peak SIGNAL"),
        (["sweep", "alsd", "--grid", "kk=1:2:2", "--peak", "tau_k1"], "(did you mean 'k'?)"),
        (["sweep", "alsd", "--grid", "k=1:2:2", "--peak", "tau_q1"], "no signal is called 'tau_q1'"),
        (["sweep", "alsd", "--grid", "k=1:2:2", "--first", "clutch:stuck"], "(did you mean 'stick'?)"),
        (["sweep", "alsd", "--grid", "k=1:2:2", "--first", "clutsh:stick"], "(did you mean 'clutch'?)"),
        (["sweep", "examples/rectifier.json", "--grid", "C=1,2", "--peak", "v"], "add --set R_l="),
        (["export", "alsd", "--to", "fmu"], "no target is called 'fmu' (did you mean 'fmu"),
        (["export", "alsd", "--to", "fmu2", "--platforms", "beos"], "no platform is called 'beos'"),
        (["figures", "fig10"], "no figure is called 'fig10'"),
    ],
)  # fmt: skip
def test_what_cannot_be_done_is_one_clear_line(
    arguments: list[str], message: str, call: Call, tmp_path: Path
) -> None:
    done = call(*arguments)
    assert (done.exit_code, done.stdout) == (2, "")
    assert done.stderr.startswith(f"bondgraph {arguments[0]}: ")
    assert message in done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert [path.name for path in tmp_path.iterdir()] == ["examples"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["dance"], "No such command 'dance'"),
        (["simulate"], "Missing argument 'MODEL'"),
        (["simulate", "alsd", "--set", "k"], "'k' is not NAME=NUMBER, as in k=4300"),
        (["simulate", "alsd", "--set", "=3"], "'=3' is not NAME=NUMBER"),
        (["simulate", "alsd", "--set", "k=stiff"], "'k=stiff' is not NAME=NUMBER"),
        (["simulate", "alsd", "--set", "k=1", "--set", "k=2"], "k is given twice"),
        (["simulate", "alsd", "--input", "tau_e=stp(1)"], "tau_e: 'stp(1)' is neither a number nor a signal"),
        (["simulate", "alsd", "--until", "0"], "--until"),
        (["simulate", "alsd", "-o", "run.txt"], "must end in .csv, .nc, .parquet, .mat or .png"),
        (["simulate", "alsd", "--bakend", "c"], "'--backend'"),
        (["derive", "alsd", "--json", "--latex"], "keep one"),
        (["sweep", "alsd", "--peak", "tau_k1"], "give at least one --grid"),
        (["sweep", "alsd", "--grid", "k=1:2"], "'k=1:2' is not NAME=FROM:TO:COUNT"),
        (["sweep", "alsd", "--grid", "k=-1:2:3:log"], "equal ratios"),
        (["export", "alsd", "--to", "c", "--platforms", "all"], "leave it out"),
        (["draw", "alsd", "-o", "alsd.gif"], "must end in .svg, .png or .pdf"),
        (["convert", "alsd"], "Missing option '-o'"),
        (["list", "--loud"], "'--loud'"),
    ],
)  # fmt: skip
def test_what_is_not_understood_is_one_clear_line(
    arguments: list[str], message: str, call: Call
) -> None:
    done = call(*arguments)
    assert (done.exit_code, done.stdout) == (2, "")
    assert message in done.stderr
    assert "--help)" in done.stderr
    assert len(done.stderr.splitlines()) == 1


def test_what_fails_on_the_way_is_one_line_and_another_status(call: Call, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    done = call("simulate", "passive", "--out", "file/deeper")
    assert (done.exit_code, done.stdout) == (1, "")
    assert len(done.stderr.splitlines()) == 1
    assert "file" in done.stderr


def test_a_broken_file_is_told_by_its_name(call: Call, tmp_path: Path) -> None:
    (tmp_path / "broken.json").write_text('{"format": "bondgraph", "version": 2}')
    done = call("show", "broken.json")
    assert done.exit_code == 2
    assert done.stderr == (
        "bondgraph show: broken.json: version 2 is unknown; this toolkit reads version 1\n"
    )


def test_without_a_command_the_help_is_shown(call: Call) -> None:
    done = call()
    assert done.exit_code == 2
    assert "bondgraph simulate alsd --scenario fig11" in done.stderr
    for name in app.commands:
        assert re.search(rf"^  {name} +\w", done.stderr, re.MULTILINE), name


def test_every_command_explains_itself_with_examples(call: Call) -> None:
    for name in app.commands:
        done = call(name, "--help")
        assert done.exit_code == 0
        assert f"  bondgraph {name}" in done.stdout


def test_the_version_is_the_packages(call: Call) -> None:
    assert re.fullmatch(r"bondgraph, version \d+\.\d+\.\d+\n", call("--version").stdout)


def test_the_module_is_the_same_command_line() -> None:
    done = command("-m", "differentials", "list")
    assert (done.returncode, done.stderr) == (0, "")
    assert "superposition_tvd" in done.stdout
    done = command("-m", "differentials", "show", "alds")
    assert done.returncode == 2
    assert done.stderr.startswith("python -m differentials show: no differential is called 'alds'")


def test_without_click_it_says_what_to_install() -> None:
    program = (
        "import sys; sys.modules['click'] = None; from differentials.__main__ import main; main([])"
    )
    done = command("-c", program)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == (
        "the command line needs click; install the optional extra: "
        "pip install bondgraph-toolkit[cli]\n"
    )


def test_help_imports_no_command() -> None:
    code = (
        "import sys; from differentials.__main__ import main\n"
        "try: main(['--help'])\n"
        "except SystemExit: pass\n"
        "assert 'sympy' not in sys.modules and 'numpy' not in sys.modules"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert [line.split()[0] for line in done.stdout.split("Commands:")[1].splitlines()[1:15]] == [
        *COMMANDS
    ]


def test_each_command_has_its_home() -> None:
    for name, home in COMMANDS.items():
        assert app.commands[name].name is not None
        assert home.short.endswith(".")
    assert [*app.commands] == [*COMMANDS]
