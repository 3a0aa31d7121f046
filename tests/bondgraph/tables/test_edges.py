"""Corners of tables: sides tell the stretch, change one at a time, and polynomials go on beyond them."""

import numpy as np
import pytest
from references.interpolated import METHODS, random_table

from bondgraph.tables.edges import bits, edge, edges
from bondgraph.tables.looking import FREE, looked_up
from bondgraph.tables.pieces import pieces

OUTSIDE = ("hold", "extend", "refuse")


def _sides(table: object, axis: int, x: float) -> tuple[int, ...]:
    count = bits(len(edges(table, axis)))
    return tuple(1 if edge(table, axis, bit, x) >= 0 else -1 for bit in range(count))


@pytest.mark.parametrize("outside", OUTSIDE)
@pytest.mark.parametrize("method", METHODS)
def test_each_corner_changes_one_side_alone(method: str, outside: str) -> None:
    given, _ = random_table(method, outside)
    table = pieces(given)
    for axis in range(len(given.axes)):
        corners = edges(table, axis)
        seen = []
        for at in corners:
            before, after = _sides(table, axis, at - 1e-9), _sides(table, axis, at + 1e-9)
            assert sum(a != b for a, b in zip(before, after, strict=True)) == 1
            # On a corner one side is at zero, and it is that one.
            zero = [edge(table, axis, bit, at) == 0 for bit in range(len(before))]
            assert zero == [a != b for a, b in zip(before, after, strict=True)]
            seen += [before] if not seen else []
            seen.append(after)
        assert len(set(seen)) == len(seen)


@pytest.mark.parametrize("outside", OUTSIDE)
@pytest.mark.parametrize("method", METHODS)
def test_corners_are_where_one_polynomial_takes_over(method: str, outside: str) -> None:
    """Of lines slopes jump there, of cubics second slopes; of splines not beside the ends."""
    given, (x, *_) = random_table(method, outside)
    inner = list(x[2:-2] if method == "bicubic" else x[1:-1])
    ends = [x[0], x[-1]] if outside != "extend" else []
    assert list(edges(pieces(given), 0)) == sorted([*inner, *ends])


@pytest.mark.parametrize("outside", ["hold", "extend"])
@pytest.mark.parametrize("method", ["linear", "akima"])
def test_on_its_stretch_a_table_is_what_it_is_and_goes_on_beyond(method: str, outside: str) -> None:
    given, (x, _) = random_table(method, outside)
    table = pieces(given)
    corners = edges(table, 0)
    free, _ = random_table(method, "extend")
    rng = np.random.default_rng(3)
    for at in rng.uniform(x[0] - 1, x[-1] + 1, 300).tolist():
        region = int(np.searchsorted(corners, at, "right"))
        assert looked_up(table, (0,), (at,), (region,)) == looked_up(table, (0,), (at,))
    # From the stretch before the last corner, beyond it: what goes on without a corner there.
    region, beyond = len(corners) - 1, x[-1] + 0.5
    if outside == "hold":
        on = looked_up(table, (0,), (beyond,), (region,))
        assert on == pytest.approx(float(free(beyond)), rel=1e-12)


def test_on_a_stretch_two_sides_hang_on_its_ends_alone() -> None:
    given, (x, _) = random_table("linear", "extend")
    table = pieces(given)
    corners = edges(table, 0)
    for region in range(len(corners) + 1):
        inside = 0.5 * (
            (corners[region - 1] if region else x[0])
            + (corners[region] if region < len(corners) else x[-1])
        )
        for bit in range(bits(len(corners))):
            sign = 1 if edge(table, 0, bit, inside) >= 0 else -1
            assert sign * edge(table, 0, bit, inside, region) > 0
        for at in corners[max(region - 1, 0) : region + 1]:
            zero = [edge(table, 0, bit, at, region) == 0 for bit in range(bits(len(corners)))]
            assert sum(zero) == 1
        for far in (x[0] - 50, x[-1] + 50):
            turned = [
                edge(table, 0, bit, far, region) * edge(table, 0, bit, inside, region) < 0
                for bit in range(bits(len(corners)))
            ]
            assert sum(turned) == (region < len(corners) if far > x[-1] else region > 0)


def test_no_number_is_none_anywhere() -> None:
    for method, outside in (("linear", "hold"), ("akima", "extend"), ("linear", "refuse")):
        table = pieces(random_table(method, outside)[0])
        assert np.isnan(looked_up(table, (0,), (np.nan,), (FREE,)))
        assert np.isnan(looked_up(table, (0,), (np.nan,), (1,)))
