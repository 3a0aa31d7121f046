"""How runs of generated Python begin: with states by name, and with what storages hold."""

from collections.abc import Mapping

from codegen.energy.holdings import Holdings
from codegen.program.records import Program
from codegen.python.blocks import Names, looks, values_function
from codegen.python.text import plain, quoted

_BEGUN = """model = Model(parameters{other})
    begun = started(initial, STATES, HELD, lambda begin: held_values(model.parameters, begin{tables}))
    """
"""Where a start may tell what storages hold."""


def beginning(words: Mapping[str, str], held: Holdings) -> dict[str, str]:
    """How a run begins: with states by name, and what storages hold."""
    if not held.names:
        initial = words["initial"].replace("begun", "initial")
        model = f"Model(parameters{words['other']})"
        return {"begin": "", "model": model, "initial": initial, "also_held": ""}
    tables = ", model.tables" if looks(held.values) else ""
    begin = _BEGUN.format(other=words["other"], tables=tables)
    return {"begin": begin, "model": "model", "also_held": " and HELD"}


def held_table(held: Holdings) -> list[str]:
    """What a start may tell of storages."""
    if not held.names:
        return []
    rows = [
        f"    {quoted(name)}: Held({row!r}{', by_law=True' * by_law}),"
        for name, row, by_law in zip(held.names, held.rows, held.by_law, strict=True)
    ]
    note = "What storages hold that a start may tell: the places of the states that it is a sum of."
    return ["", f"# {note}", "HELD = {", *rows, "}"]


def held_function(held: Holdings, program: Program, names: Names) -> list[str]:
    """What storages hold, over the states."""
    if not held.names:
        return []
    rows = [
        f"{plain(name)} by its law gives {plain(program.states[at].name)}" if by_law else
        f"{plain(name)} over {plain(program.states[at].name)}"
        for name, row, by_law in zip(held.names, held.rows, held.by_law, strict=True) for at in row
    ]  # fmt: skip
    doc = "How states follow from what storages hold at a start."
    return values_function("held_values", doc, held.values, rows, names)
