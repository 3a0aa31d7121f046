"""`check` on the command line: findings as text and as data, and the status that scripts see."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from click.testing import Result

Call = Callable[..., Result]

Data = Callable[..., Any]


def test_nothing_is_found_in_a_differential(call: Call) -> None:
    done = call("check", "alsd", "--halfshafts")
    assert (done.exit_code, done.stdout) == (0, "nothing found\n")


def test_a_number_that_nothing_reads_is_a_doubt_and_a_status(call: Call) -> None:
    done = call("check", "examples/oscillator.json", "--set", "m=2", "--set", "kk=3")
    assert done.exit_code == 1
    assert "no value or law reads the parameter kk" in done.stdout
    assert "did you mean 'k'?" in done.stdout


def test_strokes_of_a_file_are_judged_as_data(call: Call, data: Data) -> None:
    graph = json.loads(Path("examples/oscillator.json").read_text(encoding="utf-8"))
    for edge, stroke in zip(graph["edges"], ("head", "head", "tail", "tail"), strict=True):
        edge["stroke"] = stroke
    Path("drawn.json").write_text(json.dumps(graph), encoding="utf-8")
    found = data("check", "drawn.json")
    assert found["findings"] == []
    assert [(one["bond"], one["verdict"]) for one in found["strokes"]][1] == (
        ["mass", "m"],
        "right",
    )
    graph["edges"][1]["stroke"] = "tail"
    Path("drawn.json").write_text(json.dumps(graph), encoding="utf-8")
    done = call("check", "drawn.json")
    assert done.exit_code == 1
    assert "[WRONG] mass -> m, stroke at mass" in done.stdout


def test_derivative_causality_is_preferred_where_it_is_asked(call: Call, data: Data) -> None:
    """Of the oscillator all may be derivative; with its strokes drawn for integral causality none is."""
    graph = json.loads(Path("examples/oscillator.json").read_text(encoding="utf-8"))
    for edge, stroke in zip(graph["edges"], ("head", "head", "tail", "tail"), strict=True):
        edge["stroke"] = stroke
    Path("drawn.json").write_text(json.dumps(graph), encoding="utf-8")
    assert data("check", "drawn.json")["findings"] == []
    for named in ("all", "m"):
        done = call("check", "drawn.json", "--derivative", named)
        assert done.exit_code == 1
        assert "I 'm' has integral causality, though it could have derivative" in done.stdout
    done = call("check", "drawn.json", "--derivative", "damper")
    assert done.exit_code == 2
    assert "no storage is called 'damper'" in done.stderr
