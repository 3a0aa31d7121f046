"""Exports tell, as they are written, of switches that stay on while their commands rest at zero."""

import shutil
import warnings
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from references.build import bond_graph

import bondgraph as bg
from codegen import Constant, Ramp, Sine, Step, to_c, to_python, write_fmu
from codegen.exports import target
from codegen.inputs.signal import Signal
from codegen.model.commands import commands
from codegen.model.exact_values import exact_parameters
from codegen.model.resting import rests
from codegen.targets import Export

T = np.linspace(0.0, 2.0, 5)
FALLS = Step(1.0, 0.0, 1.0)
TOLD = "switch 's' stays on while its command gate rests at zero, from t = 1 on: it turns off as -gate rises"
TURNS = "turns on as gate rises above zero, off as -gate does; zero changes nothing"
FOUND = shutil.which("cc") is not None
needs_compiler = pytest.mark.skipif(not FOUND, reason="needs a C compiler")

Write = Callable[[Path, dict[str, Any], tuple[str, ...]], object]


def _switched(on: str = "gate") -> bg.StateEquations:
    """A capacitor of 1 that a switch joins to a source of 1."""
    nodes = [bg.Se("u", 1), bg.One("l"), bg.R("R", 1), bg.Sw("s", on=on), bg.C("C", 1, effort="v")]
    return bg.derive(bond_graph(nodes, "u>l l>R l>s l>C"))


def _c(to: Path, inputs: dict[str, Any], on: tuple[str, ...]) -> object:
    return to_c(_switched(), {}, main=True, inputs=inputs, initially_on=on)


def _python(to: Path, inputs: dict[str, Any], on: tuple[str, ...]) -> object:
    return target("python").write(Export("m", _switched(), {}, {}, {}, inputs, T, on), to)


def _c_folder(to: Path, inputs: dict[str, Any], on: tuple[str, ...]) -> object:
    return target("c").write(Export("m", _switched(), {}, {}, {}, inputs, T, on), to)


def _unit(to: Path, inputs: dict[str, Any], on: tuple[str, ...]) -> object:
    return write_fmu(to / "m.fmu", _switched(), {}, inputs=inputs, initially_on=on)


WRITERS = [_c, _c_folder, _python, pytest.param(_unit, marks=needs_compiler)]


def _messages(write: Write, to: Path, gate: Signal, on: tuple[str, ...]) -> list[str]:
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        write(to, {"gate": gate}, on)
    assert all(one.filename == __file__ and one.category is bg.ModelWarning for one in told)
    return [str(one.message) for one in told]


@pytest.mark.parametrize("write", WRITERS)
def test_a_run_that_is_written_with_its_signals_is_told_of_once(
    write: Write, tmp_path: Path
) -> None:
    [message] = _messages(write, tmp_path, FALLS, ())
    assert message.startswith(TOLD)
    assert message.endswith("write on='gate - 1/2'")
    [message] = _messages(write, tmp_path, Constant(0.0), ("s",))
    assert "from t = 0 on" in message


@pytest.mark.parametrize("write", [_c, _python])
def test_commands_that_turn_it_off_are_not_told(write: Write, tmp_path: Path) -> None:
    """Through zero; to zero while it is off; and a gate of 0 and 1 with half of that as its level."""
    for gate in (Step(1.0, -1.0, 1.0), Ramp(0.0, -1.0, 1.0), Sine(1.0, 0.5), Step(1.0, 0.0, -1.0)):
        assert not _messages(write, tmp_path, gate, ())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        to_c(_switched("gate - 1/2"), {}, main=True, inputs={"gate": FALLS})
        to_c(_switched(), {}, inputs={"gate": FALLS})
        to_python(_switched(), {})


@pytest.mark.parametrize(
    ("gate", "on", "time"),
    [
        (FALLS, (), 1.0), (Constant(0.0), ("s",), 0.0), (Constant(0.0), (), None),
        # On at first and never told; and off before it comes to rest.
        (Step(0.3, -1.0) + Step(0.6, 1.0), ("s",), 0.0), (Step(0.3, 0.0, -1.0), ("s",), None),
        (Ramp(0.25, -2.0, 1.0, 0.75), (), 0.75), (Step(0.6, 1.0) + Step(0.61, -1.0), (), 0.61),
        (Step(7.0, 1.0), (), None),
    ],
)  # fmt: skip
def test_where_a_command_comes_to_rest(
    gate: Signal, on: tuple[str, ...], time: float | None
) -> None:
    told = commands(_switched(), exact_parameters({}))
    found = rests(told, {"gate": gate}, T, on)
    assert [rest.time for rest in found] == ([] if time is None else [time])
    assert rests(told, {}, T, on) == ()


def test_what_turns_a_switch_is_in_the_files() -> None:
    """In the head of the module and of the C, with which whoever gives the input meets it."""
    assert f"switch s: {TURNS}" in to_python(_switched(), {})
    assert f" * switch s: {TURNS}" in to_c(_switched(), {})["model.c"]
    nodes = [bg.Se("u", "u"), bg.One("j"), bg.Diode("d"), bg.R("R", 1), bg.C("C", 1, effort="v")]
    ideal = bg.derive(bond_graph(nodes, "u>j j>d j>R j>C"))
    assert "zero changes nothing" not in to_python(ideal, {}) + to_c(ideal, {})["model.c"]


@pytest.mark.parametrize("length", range(1, 40))
def test_the_head_is_one_comment_however_its_lines_break(length: int) -> None:
    """Also where a line ends just before the mark that closes a comment."""
    nodes = [bg.Se("u", 1), bg.One("j"), bg.Sw("s" * length, on="gate"), bg.R("R", 1), bg.C("C", 1)]
    head, rest = to_c(bg.derive(bond_graph(nodes, f"u>j j>{'s' * length} j>R j>C")), {})[
        "model.c"
    ].split("*/", 1)
    assert "turns on as gate rises" in head
    assert rest.lstrip().startswith("#include <math.h>")


@needs_compiler
@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_what_turns_a_switch_is_told_at_it_and_at_its_input(version: str, tmp_path: Path) -> None:
    """Where the importer gives the gate, nothing is known of it, whatever it starts at."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        made = write_fmu(
            tmp_path / "m.fmu", _switched(), {}, version=version, inputs={"gate": 0.0}, initially_on=["s"]
        )  # fmt: skip
    text = zipfile.ZipFile(made).read("modelDescription.xml").decode()
    told = {one.get("name"): one.get("description") for one in ElementTree.fromstring(text).iter()}
    assert told["gate"] == f"switch s {TURNS}"
    assert told["s"] == f"1 on, 0 off; {TURNS}"
    assert {name for name, about in told.items() if about} == {"s", "gate"}
