"""Where every signal of a program stands in a snapshot: one order for numpy, C and sweeps."""

from codegen.program.records import Program


def places(program: Program) -> dict[str, int]:
    """Each signal's place among x, z, u, u' and readings; -1 - j for the external input j."""
    states = len(program.states) + len(program.law_states)
    groups = (
        (program.states, range(states)),
        (program.law_states, range(len(program.states), states)),
        (program.inputs, range(states, states + len(program.inputs))),
        (program.external, range(-1, -1 - len(program.external), -1)),
        (program.readings, range(states + 2 * len(program.inputs), 1 << 20)),
    )
    found: dict[str, int] = {}
    for names, rows in groups:
        for name, row in zip(names, rows, strict=False):
            found.setdefault(name.name, row)
    return found
