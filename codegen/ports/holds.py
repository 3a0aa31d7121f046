"""What holds every set of friction ports, for targets that ship with a table of it."""

from bondgraph.errors import StructureError
from codegen.ports.slips import SlipRows, held_set
from codegen.program.records import Program
from codegen.standalone.holding import HeldSet

MOST_PORTS = 8
"""A table has an entry for every set of sticking ports: two to the power of this at most."""


def held_sets(program: Program, slips: SlipRows) -> dict[tuple[int, ...], HeldSet]:
    """Every set of sticking ports by its ports, in the order of the number whose bits these are.

    Raises `StructureError` for more friction ports than a table can have.
    """
    count = len(program.friction)
    if count > MOST_PORTS:
        names = ", ".join(repr(port.name) for port in program.friction)
        raise StructureError(
            f"{names} are {count} friction ports; a table of what holds every set of them takes at most "
            f"{MOST_PORTS}"
        )
    chosen = [tuple(i for i in range(count) if bits >> i & 1) for bits in range(2**count)]
    return {ports: held_set(slips, ports) for ports in chosen}


def unlike_plain(program: Program, slips: SlipRows) -> dict[tuple[int, ...], HeldSet]:
    """The sets of sticking ports of which some slip does not bind the states by itself, or laws answer.

    Where all ports together are plain, so is every set. Raises as `held_sets` does where they are not.
    """
    every = tuple(range(len(program.friction)))
    if _plain(held_set(slips, every)):
        return {}
    return {ports: held for ports, held in held_sets(program, slips).items() if not _plain(held)}


def _plain(held: HeldSet) -> bool:
    return not held.moved and not held.direct and len(held.kept) == len(held.null)
