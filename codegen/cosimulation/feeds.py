"""Which inputs a model's signals depend on at once, by structure."""

from collections.abc import Iterable, Mapping

import sympy as sp

from bondgraph.nodes.tasks import Task
from codegen.fmu.dependencies import Place, reach, symbols_of
from codegen.modes.closed import ClosedModel
from codegen.program.records import Program

INPUT_KINDS = ("FMU_INPUT", "FMU_SLOPE")


class Feeds:
    """Of a model: ``of(signal)`` are the inputs that rule a signal at the instant itself.

    ``tasks``: those that work at communication points: what they set is told by what they read there.
    Impacts and switches that turn are no part of it.

    >>> import bondgraph as bg
    >>> from codegen import simulator
    >>> cart = bg.graph([bg.Se("push", "F"), bg.One("cart"), bg.I("m", "m", flow="v"),
    ...                  bg.R("air", "c", effort="f")], "push > cart > m, cart > air")
    >>> feeds = Feeds(simulator(bg.derive(cart, outputs=["air"]), {"m": 1, "c": 2}).closed, [])
    >>> sorted(feeds.of("v")), sorted(feeds.of("F"))
    ([], ['F'])
    """

    def __init__(self, model: ClosedModel, tasks: Iterable[Task]) -> None:
        program = model.program
        self._inputs = [symbol.name for symbol in program.external]
        self._where = symbols_of(program)
        self._places = {symbol.name: place for symbol, place in self._where.items()}
        self._varying = program.varying
        self._reach = reach(program, self._set_by(program, tasks))

    def of(self, signal: str) -> frozenset[str]:
        """The inputs, by name; all of them where it is not known better."""
        place = self._places.get(signal)
        every = frozenset(self._inputs)
        if place is None or (self._varying and place[0] != "FMU_STATE"):
            return every if signal not in self._inputs else frozenset([signal])
        led = self._reach.get(place, frozenset([place]))
        return frozenset(self._inputs[at] for kind, at in led if kind in INPUT_KINDS)

    def _set_by(self, program: Program, tasks: Iterable[Task]) -> Mapping[Place, set[Place]]:
        found = dict[Place, set[Place]]()
        for task in tasks:
            for reset in task.resets:
                read = reset.value.free_symbols if task.step is None else {*task.reads}
                places = {self._where[one] for one in _symbols(read) if one in self._where}
                found[self._where[reset.state]] = places
        return found


def _symbols(names: Iterable[object]) -> list[sp.Symbol]:
    return [one for one in names if isinstance(one, sp.Symbol)]
