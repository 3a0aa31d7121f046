"""What stands where at an instant, by hand."""

import re
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path

import pytest
from references.build import bond_graph

import bondgraph as bg
from codegen import lower
from codegen.c.runtime import runtime_file
from codegen.program.layout import NAMES, RECORDED, SHOT, layout_text, places, recorded, widths


def test_the_parts_of_an_instant_by_hand() -> None:
    """A mass on a nonlinear spring with a brake and a push: one state, one of a law, four inputs."""
    nodes = [
        bg.Se("push", "P"), bg.One("n"), bg.I("m", "m", flow="v"), bg.R("brake", flow="slip"),
        bg.C("spring", effort="F", law="k*q_spring**3"),
    ]  # fmt: skip
    graph = bond_graph(nodes, "push>n>m n>brake n>spring")
    program = lower(bg.derive(graph), {"brake": bg.DryFriction("L")}, ["m", "k"])
    assert [name.name for name in (*program.states, *program.law_states)] == ["v", "q_spring"]
    assert [name.name for name in program.inputs] == ["P", "e_brake", "F"]
    assert [name.name for name in program.external] == ["P", "L"]
    readings = len(program.readings)
    assert widths(program) == (1, 1, 3, 3, readings, 2, 1, 2)
    assert recorded(program) == (1, 1, 3, 3, readings, 2, 2)
    assert [NAMES[part] for part in RECORDED] == ["x", "z", "u", "du", "y", "rate", "external"]
    found = places(program)
    assert {name: found[name] for name in ("v", "q_spring", "P", "e_brake", "F", "L")} == {
        "v": 0, "q_spring": 1, "P": 2, "e_brake": 3, "F": 4, "L": -2,
    }  # fmt: skip
    assert found["slip"] == 8 + [name.name for name in program.readings].index("slip")


def test_a_model_without_states_has_one_rate() -> None:
    """For integrators, which need something."""
    graph = bond_graph([bg.Se("push", "P"), bg.R("air", "b")], "push>air")
    program = lower(bg.derive(graph, outputs=["air"]), {}, ["b"])
    assert widths(program)[5] == 1
    assert widths(program)[:2] == (0, 0)


def test_c_is_told_the_same_order() -> None:
    shown, kept = (
        re.findall(r"\w+\((\w+), BG", part) for part in layout_text().split("/* What is kept")
    )
    assert shown == list(NAMES[:-1])
    assert kept == [*(NAMES[part] for part in RECORDED[:-1]), "w"]


def test_the_exact_engine_has_its_parts_in_the_same_order() -> None:
    places = re.findall(r"EX_AT_(\w+) =", runtime_file("exact.h"))
    assert [name.lower() for name in places] == list(SHOT)


PARTS = re.compile(r"\b(x|z|u|du|y|rate|caps)\b")
SIZES = re.compile(r"\b(N|OWN|M|ROWS|K|BG_[A-Z_]+|[a-z_.]*\b(states|law_states|inputs|readings))\b")
SUM = re.compile(
    r"\b(OWN|\w*law_states\)?|BG_LAW_STATES)\s*\+\s*(2 \* )?(M|BG_INPUTS|len\(\w*\.?inputs\))"
)


def _spelled(text: str) -> Iterator[str]:
    """Lines that go through the parts one by one, and sums of their sizes."""
    yield from (found[0] for found in SUM.finditer(text))
    lines = [line.strip() for line in text.splitlines()]
    # What only declares parts says nothing of where they stand.
    lines = [line for line in lines if not re.fullmatch(r"\w+: \w+|double \S+;", line)]
    alike = groupby(lines, lambda line: SIZES.sub("SIZE", PARTS.sub("PART", line)))
    for pattern, group in alike:
        if "PART" in pattern and len(found := list(group)) > 3:
            yield "; ".join(found)


@pytest.mark.parametrize("root", ["codegen", "differentials"])
def test_no_order_of_parts_is_spelled_out_elsewhere(root: str) -> None:
    files = [*Path(root).rglob("*.py"), *Path(root).rglob("*.[ch]")]
    assert files
    found = {str(file): list(_spelled(file.read_text(encoding="utf-8"))) for file in files}
    assert {file: lines for file, lines in found.items() if lines} == {}


def test_the_search_sees_what_it_has_to() -> None:
    puts = "\n".join(f"to = put(to, {size}, shot->{part});" for size, part in
                     zip(("N", "OWN", "M", "M"), ("x", "z", "u", "du"), strict=True))  # fmt: skip
    sums = "a = N + OWN + 2 * M;\nb = len(states) + len(p.law_states) + len(p.inputs)"
    assert [len(list(_spelled(text))) for text in (puts, sums)] == [1, 2]
