"""How wide text is: the advances of DejaVu Sans, which every picture is set in."""

from types import MappingProxyType

from bondgraph.drawing.rich import Rich

FAMILY = "DejaVu Sans"
SMALL = 0.72
"""Size of subscripts and exponents, of the line's."""

ASCENT, DESCENT = 0.76, 0.24
"""Height of letters over the line and their depth under it, of the size."""

SHIFT = MappingProxyType({0: 0.0, -1: 0.2, 1: -0.36})
"""How much lower than the line a run is set, of the line's size."""

_BY_WIDTH = {
    275: "'", 278: "ijl", 295: "IJΙ", 318: " ,.·", 337: "/:;\\|", 338: "ι", 352: "f", 361: "-",
    390: "()[]", 392: "t", 401: "!", 411: "r", 460: '"', 500: "*_`", 521: "s∫", 525: "z", 531: "?",
    541: "ε", 544: "ζ", 550: "c", 557: "LΓ", 558: "ξ", 559: "ν", 575: "F", 578: "χ", 579: "kυ",
    587: "ς", 589: "κ", 592: "vxyγλ", 602: "πτ", 603: "PΡ", 611: "TYΤΥ", 612: "oδθο", 613: "a",
    615: "e", 632: "EΕΞΣ", 634: "hnuησ", 635: "Sbdgpqρ", 636: "$0123456789{}μ", 637: "√", 638: "β",
    656: "KΚ", 659: "α", 660: "φψ", 684: "AVΑΔΛ", 685: "XZΖΧ", 686: "BΒ", 695: "R", 698: "C",
    732: "U", 748: "NΝ", 752: "HΗΠ", 764: "Ω", 770: "D", 775: "G", 780: "&", 787: "OQΘΟΦΨ",
    818: "w", 837: "ω", 838: "#+<=>^~−≤≥", 863: "MΜ", 950: "%", 974: "m", 989: "W", 1000: "@…",
}  # fmt: skip

ADVANCES = MappingProxyType(
    {letter: wide for wide, letters in _BY_WIDTH.items() for letter in letters}
)
"""Thousandths of the size, by character; others count as a thousand."""


def run_width(text: str, level: int, size: float) -> float:
    """Width of a run, in the units of the size of its line."""
    scale = size * (SMALL if level else 1.0)
    return sum(ADVANCES.get(letter, 1000) for letter in text) * scale / 1000


def depth(rich: Rich, size: float) -> float:
    """How far a line of text reaches below where it stands: a subscript farther than letters."""
    return max(
        ((SHIFT[run.level] + DESCENT * (SMALL if run.level else 1.0)) * size for run in rich),
        default=DESCENT * size,
    )


def height(rich: Rich, size: float) -> float:
    """How far a line of text reaches above where it stands: an exponent farther than letters."""
    return max(
        ((ASCENT * (SMALL if run.level else 1.0) - SHIFT[run.level]) * size for run in rich),
        default=ASCENT * size,
    )


def width(rich: Rich, size: float) -> float:
    """Width of a line of text, in the units of its size."""
    return sum(run_width(run.text, run.level, size) for run in rich)
