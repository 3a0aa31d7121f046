"""Points and rectangles, y downwards, in points."""

from dataclasses import dataclass

Point = tuple[float, float]


def turned(point: Point) -> Point:
    """The point with across and down exchanged."""
    return point[1], point[0]


@dataclass(frozen=True)
class Box:
    """A rectangle."""

    left: float
    top: float
    right: float
    bottom: float

    def overlaps(self, other: "Box") -> bool:
        """True where the two have an area in common."""
        across = self.left < other.right and other.left < self.right
        return across and self.top < other.bottom and other.top < self.bottom

    def crossed(self, first: Point, second: Point) -> bool:
        """True where the line from one point to the other runs through the inside (Liang, Barsky)."""
        begin, end = 0.0, 1.0
        (x, y), (dx, dy) = first, (second[0] - first[0], second[1] - first[1])
        for step, room in (
            (-dx, x - self.left), (dx, self.right - x), (-dy, y - self.top), (dy, self.bottom - y),
        ):  # fmt: skip
            if step == 0:
                if room <= 0:
                    return False
            elif step < 0:
                begin = max(begin, room / step)
            else:
                end = min(end, room / step)
        return begin < end

    @property
    def turned(self) -> "Box":
        """The rectangle with across and down exchanged."""
        return Box(self.top, self.left, self.bottom, self.right)

    def grown(self, by: float) -> "Box":
        """The rectangle with a margin."""
        return Box(self.left - by, self.top - by, self.right + by, self.bottom + by)


def around(boxes: list[Box]) -> Box:
    """The smallest rectangle that holds all of them."""
    return Box(
        min(box.left for box in boxes),
        min(box.top for box in boxes),
        max(box.right for box in boxes),
        max(box.bottom for box in boxes),
    )
