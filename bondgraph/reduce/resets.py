"""What switches set states to at their events: only what is a state, and independent."""

from collections.abc import Sequence

from bondgraph.errors import StructureError
from bondgraph.reduce.sorting import Reduction
from bondgraph.reduce.switch_port import SwitchPort


def check_resets(switches: Sequence[SwitchPort], reduction: Reduction) -> None:
    """Refuse resets of what is no state, and of a dependent storage, which follows from states."""
    structure = reduction.structure
    states = [*reduction.names, *structure.states_of_laws]
    kept = {p.element.co_energy: p for p in structure.ports if p.element.kind.stores}
    for one in switches:
        for reset in one.switch.resets:
            if reset.state in states:
                continue
            where = f"node {one.name!r}: reset of {reset.state}"
            if reset.state in kept:
                raise StructureError(
                    f"{where}: the storage {kept[reset.state].element.name!r} is dependent, what it holds "
                    "follows from states; reset one of these, or give it a higher priority"
                )
            raise StructureError(
                f"{where}, which is no state; there is {', '.join(map(str, states)) or 'none'}"
            )
