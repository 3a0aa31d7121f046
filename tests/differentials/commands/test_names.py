"""What is typed as a name, and what the shell completes."""

import pytest
from click.shell_completion import ShellComplete

from differentials.commands.app import app


def completed(*words: str) -> set[str]:
    """What the shell offers for the last word."""
    *before, last = words
    shell = ShellComplete(app, {}, "bondgraph", "_BONDGRAPH_COMPLETE")
    return {item.value for item in shell.get_completions(before, last)}


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("s",), {"show", "simulate", "sweep"}),
        (("show", "passive_i"), {"passive_input_clutch", "passive_input_shaft"}),
        (("simulate", "alsd", "--scenario", "fig13"), {"fig13", "fig13_superposition"}),
        (("export", "alsd", "--to", "f"), {"fmu2", "fmu3"}),
        (("figures", "fig11", "fig14"), {"fig14"}),
        (("modes", "--stu"), {"--stuck"}),
    ],
)
def test_the_shell_completes_names(words: tuple[str, ...], expected: set[str]) -> None:
    assert completed(*words) == expected


def test_the_shell_completes_files_where_no_differential_begins_so() -> None:
    shell = ShellComplete(app, {}, "bondgraph", "_BONDGRAPH_COMPLETE")
    assert [item.type for item in shell.get_completions(["show"], "examples/o")] == ["file"]
