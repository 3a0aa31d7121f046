"""Switches that time alone drives: their conditions read known sources and other external inputs only."""

from collections.abc import Iterable

from codegen.program.gains import written_out
from codegen.program.records import Program


def timed_ports(program: Program) -> tuple[int, ...]:
    """The places of these switches among the ports; none where a condition is not affine."""
    if not program.guards_affine:
        return ()
    outside = {*program.external, *program.parameters}
    alone = [guard.free_symbols <= outside for guard in written_out(program.guards)]
    return tuple(
        i
        for i, port in enumerate(program.friction)
        if port.switch is not None and not port.switch.side
        if alone[port.switch.guard] and alone[port.switch.guard + 1]
    )


def opposed_ports(program: Program, ports: Iterable[int]) -> frozenset[int]:
    """Those of these whose one condition is the other turned round, so that never both hold."""
    told = dict(zip(program.external[len(program.asked) :], program.sources, strict=True))
    guards = [guard.xreplace(told) for guard in written_out(program.guards)]
    switches = {i: program.friction[i].switch for i in ports}
    return frozenset(
        i for i, switch in switches.items()
        if switch is not None and guards[switch.guard] == -guards[switch.guard + 1]
    )  # fmt: skip
