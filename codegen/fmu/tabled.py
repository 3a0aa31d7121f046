"""Tables as variables of a unit: arrays with their axes, or values one by one."""

from collections.abc import Iterator, Sequence
from itertools import product

from bondgraph.inverses.tabled import fixed
from bondgraph.tables.record import Sampled
from codegen.fmu.variable import Variable
from codegen.tuning import TUNING


def arrays_of(tables: Sequence[Sampled]) -> Iterator[Variable]:
    """The values of each, row by row, as a parameter, and its axes."""
    kept = fixed(tables)
    for at, table in enumerate(tables):
        sizes = tuple(map(len, table.axes))
        yield Variable(
            table.name, "FMU_TABLE", at, "local" if table.name in kept else "parameter", initial="exact",
            array=table.values, sizes=sizes,
        )  # fmt: skip
        for axis, (letter, points) in enumerate(zip("xy", table.axes, strict=False)):
            yield Variable(
                f"{table.name}.{letter}", "FMU_AXIS", 2 * at + axis, initial="exact", array=points,
                sizes=(len(points),),
            )  # fmt: skip


def scalars_of(tables: Sequence[Sampled]) -> Iterator[Variable]:
    """Each value as a parameter that tells its place; none of tables of many."""
    first, kept = 0, fixed(tables)
    for table in tables:
        places = product(*(range(len(axis)) for axis in table.axes))
        few = len(table.values) <= TUNING.most_scalars and table.name not in kept
        for k, (place, value) in enumerate(zip(places, table.values, strict=True) if few else ()):
            numbers = ",".join(str(one + 1) for one in place)
            yield Variable(
                f"{table.name}[{numbers}]", "FMU_TABLE_VALUE", first + k, "parameter", initial="exact",
                start=value, description=_told(table, place),
            )  # fmt: skip
        first += len(table.values)


def _told(table: Sampled, place: Sequence[int]) -> str:
    """The arguments of one value."""
    told = zip("xy", table.axes, place, strict=False)
    return "at " + ", ".join(f"{letter} = {axis[at]!r}" for letter, axis, at in told)
