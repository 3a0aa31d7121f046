"""Laws that are turned round by a search, as functions of Python."""

from collections.abc import Sequence

from bondgraph.inverses.inverse import PLACE, Turning
from codegen.python.blocks import Names, text_of
from codegen.python.text import assignment, plain


def turned_laws(turnings: Sequence[Turning]) -> list[str]:
    """A function for each, of the value and the law's parameters."""
    lines: list[str] = []
    for turning in turnings:
        given = "".join(f", {name}" for name in turning.parameters)
        lines += ["", "", f"def _{turning.code}(value{given}):"]
        lines += [f'    """The {PLACE} where {plain(str(turning.law))} has this value."""', ""]
        lines += [
            f"    def law({PLACE}):",
            "        # The law, its slope, and what is positive.",
            "        return (",
        ]
        for one in turning.evaluated():
            lines += assignment("", text_of(one, Names({}, {})), indent=12, end=",", sign="")
        begin = "" if turning.begin == 0 else f", {text_of(turning.begin, Names({}, {}))}"
        lines += ["        )", "", f"    return place_where(law, value{begin})"]
    return lines
