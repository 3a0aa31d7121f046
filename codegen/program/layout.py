"""What stands where at an instant: one order of parts, for numpy, C and exported Python."""

from codegen.program.records import Program

STATES, LAW_STATES, INPUTS, RATES_OF_INPUTS, READINGS, RATE, CAPS, EXTERNAL = range(8)
"""The parts of an instant: x, z, u, u', y, the rate of s, what ports may hold, external inputs."""

RECORDED = (STATES, LAW_STATES, INPUTS, RATES_OF_INPUTS, READINGS, RATE, EXTERNAL)
"""The parts that are kept of each sample."""

NAMES = ("x", "z", "u", "du", "y", "rate", "caps", "external")
"""What the parts are called in records of numpy and C, in their order."""


def widths(program: Program) -> tuple[int, ...]:
    """How many numbers each part has, in their order."""
    states, own = len(program.states), len(program.law_states)
    inputs, readings = len(program.inputs), len(program.readings)
    return (
        states, own, inputs, inputs, readings, states + own, len(program.friction),
        len(program.external),
    )  # fmt: skip


def recorded(program: Program) -> tuple[int, ...]:
    """How many numbers each part has that is kept of a sample."""
    sizes = widths(program)
    return tuple(sizes[part] for part in RECORDED)


def places(program: Program) -> dict[str, int]:
    """Each signal's place among x, z, u, u' and readings; -1 - j for the external input j."""
    # What a run is given goes before readings that show the same.
    named = (
        (STATES, program.states), (LAW_STATES, program.law_states), (INPUTS, program.inputs),
        (EXTERNAL, program.external), (READINGS, program.readings),
    )  # fmt: skip
    sizes, found = widths(program), dict[str, int]()
    for part, names in named:
        begin = sum(sizes[:part])
        for at, name in enumerate(names):
            found.setdefault(name.name, -1 - at if part == EXTERNAL else begin + at)
    return found
