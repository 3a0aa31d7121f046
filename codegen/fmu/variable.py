"""`Variable`: one variable of a functional mock-up unit."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Variable:
    """One variable; its place in the list is its value reference.

    ``kind`` and ``index``: what it is to the C glue (`enum fmu_kind`). ``array``: where all of its values
    start, row by row, where it has several, of such ``sizes``. ``derivative``: the value
    reference of the state that it is the rate of. ``description``: for people.
    """

    name: str
    kind: str
    index: int = 0
    causality: str = "local"
    variability: str = "continuous"
    initial: str | None = "calculated"
    start: float | None = None
    unit: str = ""
    derivative: int | None = None
    description: str = ""
    array: tuple[float, ...] = ()
    sizes: tuple[int, ...] = ()

    @property
    def integer(self) -> bool:
        """Friction modes and switches are whole numbers."""
        return self.kind in ("FMU_MODE", "FMU_SWITCH", "FMU_SLIDES")
