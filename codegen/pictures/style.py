"""How pictures look: colours and lines that differ for every eye and in print without colours."""

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#000000", "#E69F00", "#56B4E9")
"""Okabe and Ito (2008), without their yellow, which is too light for lines on white."""

LINES: tuple[object, ...] = (
    "-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (9, 2)),
)  # fmt: skip

FAINT, SHADE, QUIET = "0.55", "0.90", "0.35"
"""Greys of marks, of shaded spans, and of what is said about them."""

TEXT, SMALL = 9.0, 7.5
"""Sizes of letters [pt]."""


def curve(number: int) -> dict[str, object]:
    """Colour and line of a curve by its number; the first 42 differ.

    >>> curve(1)
    {'color': '#D55E00', 'linestyle': '--'}
    """
    return {
        "color": COLOURS[number % len(COLOURS)],
        "linestyle": LINES[number % len(LINES)],
    }
