"""What works out the signals and the energies of a run, as its record asks for them."""

from collections.abc import Collection, Hashable, Sequence
from typing import Protocol

from bondgraph.nodes.tasks import Transition
from codegen.energy.audit import Audit
from codegen.numbers.arrays import Array


class Named(Protocol):
    """What has signals by name."""

    def __getitem__(self, name: str, /) -> Array:
        """The values of one; `KeyError` naming what there is."""


class Accountant(Protocol):
    """What integrates a run's powers and signals."""

    def work(self, node: Hashable) -> Array:
        """What a one-port absorbs, or a source supplies, up to each sample."""

    def integral(self, name: str) -> Array:
        """A signal integrated up to each sample."""

    def audit(self) -> Audit:
        """The power balance of the run."""


class Watcher(Protocol):
    """What works out a run's signals, bonds, powers and energies."""

    def names(self) -> Sequence[str]:
        """Of the signals that it works out."""

    def nodes(self) -> Collection[Hashable]:
        """Where events may happen: the nodes of the graph and the ports of its fields."""

    def transitions(self) -> Collection[Transition]:
        """Those of the graph's state machines."""

    def signal(self, name: str) -> Array:
        """A named effort or flow."""

    def bond(self, tail: Hashable, head: Hashable) -> tuple[Array, Array]:
        """Effort and flow of a bond."""

    def power(self, node: Hashable) -> Array:
        """Effort times flow of a one-port."""

    def energy(self, node: Hashable) -> Array:
        """What a storage holds."""
