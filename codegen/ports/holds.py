"""What has to be known of friction ports before they are written out as a model of its own."""

from itertools import combinations

from bondgraph.errors import StructureError
from codegen.ports.slips import ExactSlips
from codegen.program.records import Program

FEW = 8
"""Of so many ports every set is looked at, where a port is one that only some sets can hold."""


def check_sets(program: Program, slips: ExactSlips) -> None:
    """Whether what holds every set of ports can be told; raises `StructureError` where not."""
    ports = range(len(program.friction))
    if slips.bent and len(ports) > FEW:
        names = ", ".join(map(repr, slips.bent.values()))
        raise StructureError(
            f"the slips of {names} have factors that move with the rates of states; that is written for at "
            f"most {FEW} ports of friction and switches, not {len(ports)}: put storages between"
        )
    for count in ports if slips.bent else ():
        for chosen in combinations(ports, count + 1):
            slips.held(chosen)


def all_plain(program: Program, slips: ExactSlips) -> bool:
    """Whether the slips of every set of ports bind the states, each by itself, and no law answers."""
    found = slips.held(range(len(program.friction)))
    return not found.moved and not found.direct and len(found.kept) == len(found.null)
