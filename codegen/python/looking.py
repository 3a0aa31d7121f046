"""Tables of generated Python: their constants, how others come in their place, and where they end."""

from bondgraph.inverses.tabled import fixed
from bondgraph.tables.pieces import pieces
from codegen.corners.refusing import arguments, refusals
from codegen.program.printing import table_name
from codegen.program.records import Block, Program
from codegen.python.blocks import bound
from codegen.python.text import listing, quoted


def lookup_tables(program: Program) -> list[str]:
    """What is looked into: breaks along each axis, degree, what is beyond the ends, factors of cells."""
    lines = []
    for table in program.tables:
        breaks, degree, outside, factors = pieces(table)
        lines += ["", f"_{table_name(table)} = (", "    ("]
        for knots in breaks:
            lines += listing("(", map(repr, knots), "),", indent=8)
        lines += ["    ),", f"    {degree},", f'    "{outside}",']
        lines += [*listing("(", map(repr, factors), "),", indent=4), ")"]
    if not lines:
        return []
    rows = [f"    {quoted(one.name)}: _{table_name(one)}," for one in program.tables]
    lines += ["", "# The tables by name.", "TABLES = {", *rows, "}"]
    return lines


def table_shapes(program: Program) -> list[str]:
    """How other values of tables become polynomials, and what arguments of some are inside of."""
    lines = ["# How values of tables become polynomials, and their points.", "SHAPES = {"]
    kept = fixed(program.tables)
    for table in (one for one in program.tables if one.name not in kept):
        opening = f'    {quoted(table.name)}: Shape("{table.method}", "{table.outside}", ('
        if pieces(table)[0] == table.axes:
            lines += [f"{opening}*_{table_name(table)}[0],)),"]
            continue
        lines += [opening]
        for axis in table.axes:
            lines += listing("(", map(repr, axis), "),", indent=8)
        lines += ["    )),"]
    lines += ["}"]
    rows = [
        f"    Refusing({quoted(one.table.name)}, {quoted(str(one.argument))}, {low!r}, {high!r}"
        f"{f', {quoted(one.never)}' * bool(one.never)}),"
        for one in refusals(program)
        for low, high in [one.ends]
    ]
    what = (
        "# Tables that refuse what is outside, their arguments, and from where to where they are."
    )
    return [*lines, *(["", what, "REFUSING = (", *rows, ")"] if rows else [])]


def model_words(program: Program) -> dict[str, str]:
    """What a model with tables takes beside its parameters."""
    if not program.tables:
        return dict.fromkeys(("tables", "own", "other", "values"), "")
    own = "\n        self.tables = with_values(tables or {}, TABLES, SHAPES)"
    if count := len(refusals(program)):
        block = _bound("table_places", arguments(program))
        own += f"\n        self.places = BlockFormula({block}, self.parameters, {count})"
    told = (
        "\n\n    ``tables``: for some of TABLES other values at their points, over two axes a row for each x;"
        "\n    of cubic ones that needs scipy."
    )
    return {"tables": ", tables=None", "own": own, "other": ", tables", "values": told}


def _bound(name: str, code: Block) -> str:
    """The same of a model's own tables."""
    return bound(name, code).replace("tables)", "self.tables)")
