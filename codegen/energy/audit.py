"""`Audit`: the power balance of a run."""

from collections.abc import Hashable, Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

from bondgraph.show.blocks import aligned


@dataclass(frozen=True)
class Audit:
    """Where the energy of a run came from and where it went; every node of the graph is in it once.

    ``gave``: of each source. ``took``: of each storage what it holds at the end less what it held at the
    start, and what it took from whatever moves its value. ``lost``: of each resistance, law, friction port
    and open port. ``conserving``: transformers, gyrators, junctions and detectors, which take nothing.
    ``impacts``: what jumps took at which ports came to rest or switches changed over. ``resets``: what
    storages held less after resets of their states, negative where these put energy in. ``turned_over``:
    the magnitudes of all these and of what storages hold at both ends, beside which ``residual`` is small.

    Energies are in J where efforts and flows are in units of SI.

    Raises nothing.
    """

    gave: Mapping[Hashable, float]
    took: Mapping[Hashable, float]
    lost: Mapping[Hashable, float]
    conserving: tuple[Hashable, ...] = field(repr=False)
    impacts: float
    turned_over: float
    resets: float = 0.0

    def __post_init__(self) -> None:
        for name in ("gave", "took", "lost"):
            object.__setattr__(self, name, MappingProxyType(dict(getattr(self, name))))

    def __reduce__(self) -> tuple[Any, ...]:
        """Copied and pickled by its parts, as read-only mappings by themselves cannot be."""
        gave, took, lost = map(dict, (self.gave, self.took, self.lost))
        return Audit, (
            gave,
            took,
            lost,
            self.conserving,
            self.impacts,
            self.turned_over,
            self.resets,
        )

    @property
    def residual(self) -> float:
        """What sources gave less all that was taken and lost: zero but for the run's tolerance."""
        taken = sum(self.took.values()) + sum(self.lost.values()) + self.impacts
        taken += self.resets
        return sum(self.gave.values()) - taken

    @property
    def _reset(self) -> list[tuple[str, str]]:
        """What resets took, where there were any."""
        return [("resets took", f"{self.resets:.6g}")] if self.resets else []

    def __str__(self) -> str:
        """A table."""
        rows: list[tuple[str, ...]] = []
        for title, part in (("gave", self.gave), ("took", self.took), ("lost", self.lost)):
            rows += [(f"{node} {title}", f"{value:.6g}") for node, value in part.items()]
            rows.append((f"{title} in all", f"{sum(part.values()):.6g}"))
        rows += [
            ("impacts took", f"{self.impacts:.6g}"), *self._reset, ("residual", f"{self.residual:.2g}"),
            ("energy turned over", f"{self.turned_over:.6g}"),
        ]  # fmt: skip
        lines = aligned(rows)
        if self.conserving:
            lines.append(f"  conserve power: {', '.join(map(str, self.conserving))}")
        return "\n".join(lines)


def turned_over(
    audited: tuple[Mapping[Hashable, float], ...], jumps: Iterable[float],
    held: Mapping[Hashable, float],
) -> float:  # fmt: skip
    """The magnitudes of what was gained and lost, and of what storages hold at both ends together."""
    parts = [abs(value) for part in audited for value in part.values()]
    return sum(parts) + sum(map(abs, jumps)) + sum(held.values())
