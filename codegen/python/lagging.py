"""Delays of generated Python: what they read, how late they are, and what they give at first."""

from codegen.program.gains import written_out
from codegen.program.records import Block, Program, block
from codegen.python.blocks import Names, bound, values_function
from codegen.python.text import names_tuple, plain


def lagging_functions(program: Program, names: Names) -> list[str]:
    """What delays read at an instant, and their numbers; nothing where there are none."""
    if not program.delayed:
        return []
    read, numbers = _parts(program)
    given = [plain(name.name) for name in program.delayed]
    rows = [f"{name} late" for name in given]
    lines = values_function("read_late", "What each delay reads.", read, rows, names)
    rows = [*(f"how late {name} is [s]" for name in given), *(f"{name} before" for name in given)]
    return lines + values_function(
        "lags", "Of each delay its time and its start.", numbers, rows, names
    )


def delayed_table(program: Program) -> list[str]:
    """The inputs that delays give."""
    names = names_tuple("DELAYED", [name.name for name in program.delayed])
    return ["", "# What delays give, of the inputs.", *names] if program.delayed else []


def lagging(program: Program) -> str:
    """What a model with delays binds to its parameters."""
    if not program.delayed:
        return ""
    read, numbers = (
        bound(name, part).replace("tables)", "self.tables)")
        for name, part in zip(("read_late", "lags"), _parts(program), strict=True)
    )
    count = len(program.delayed)
    return (
        f"\n        self.read_late = BlockFormula({read}, self.parameters, {count})"
        f"\n        self.memory = Memory(*lags_told({numbers}(self.parameters, None), DELAYED))"
    )


def _parts(program: Program) -> tuple[Block, Block]:
    """What delays read; their times and, after these, their starts."""
    told = written_out(program.delaying)
    return block(told[::3]), block([*told[1::3], *told[2::3]])
