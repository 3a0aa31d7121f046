"""Sums of names count as numbers do, and lines are noted once."""

import random

from codegen.straight.sums import Lines, Sum, needed
from codegen.straight.words import text_of


def test_a_sum_is_what_its_text_says() -> None:
    """Random sums, products with numbers, differences, beside the same of numbers."""
    for seed in range(50):
        rng = random.Random(seed)
        numbers = {f"s{at}": rng.uniform(-2, 2) for at in range(3)}
        value, expected = 0.0, 0.0
        names = Lines().given("s", 3)
        for _ in range(8):
            at, factor = rng.randrange(3), rng.choice([-2.5, -1.0, 0.0, 0.5, 1.0])
            way = rng.randrange(4)
            if way == 0:
                value, expected = value + factor * names[at], expected + factor * numbers[f"s{at}"]
            elif way == 1:
                value, expected = names[at] - value, numbers[f"s{at}"] - expected
            elif way == 2:
                value, expected = value * factor + factor, expected * factor + factor
            else:
                value, expected = factor - value, factor - expected
        assert abs(eval(text_of(value), dict(numbers)) - expected) < 1e-12


def test_what_cancels_is_gone() -> None:
    x, y = Lines().given("s", 2)
    assert x + y - x - y == 0.0
    assert not isinstance(0 * x, Sum)


def test_equal_products_are_one_line_and_what_nobody_reads_is_left_out() -> None:
    lines = Lines()
    x, y, z = lines.given("s", 3)
    one, other, _ = x * y, y * x, x * z
    assert one.key == other.key
    assert [line.names for line in needed(lines.listed, [one + 1])] == [("a0",)]
    assert len(lines.listed) == 2
