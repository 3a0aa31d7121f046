"""Sampled tasks of generated Python: their instants, and what they set."""

from collections.abc import Sequence

from codegen.program.records import Program
from codegen.python.blocks import bound
from codegen.standalone.switchings import Reset


def reset_rows(resets: Sequence[Reset]) -> list[str]:
    """Resets as text."""
    return [f"    Reset({one.port}, {one.sign}, {one.place}, {one.value})," for one in resets]


def clocks(program: Program) -> list[str]:
    """The instants of tasks, and what these set."""
    rows = [f"    Clock({one.every!r}, {one.offset!r}, {one.unit!r})," for one in program.clocks]
    lines = ["", "# The instants of tasks, (k*every + offset)/unit [s].", "CLOCKS = (", *rows, ")"]
    note = "# What tasks set: -1 less the place of the clock; places of state and value."
    return [*lines, "", note, "TICKS = (", *reset_rows(program.ticks), ")"]


def ticking(program: Program) -> str:
    """What a model with tasks binds to its parameters."""
    if not program.clocks:
        return ""
    block = bound("switch_conditions", program.guards).replace("tables)", "self.tables)")
    count = len(program.guards.results)
    formula = f"BlockFormula({block}, self.parameters, {count})"
    return f"\n        self.told_by_tasks = {formula}"


def set_by_tasks(program: Program) -> list[str]:
    """For each value that a task sets what it is."""
    states = (*program.states, *program.law_states)
    tasks = program.equations.tasks
    return [f"{states[one.place]} set by {tasks[-1 - one.port].name}" for one in program.ticks]
