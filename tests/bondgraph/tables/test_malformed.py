"""Points that are no table are refused, by the table's name and the row."""

import math
import random
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bondgraph as bg

Samples = list[Any]

NAN, INF = math.nan, math.inf


@pytest.mark.parametrize(
    ("samples", "how", "says"),
    [
        (([], []), {}, r"x has 0 point\(s\); linear needs 2"),
        (([1], [1]), {}, r"x has 1 point\(s\); linear needs 2"),
        (([0, 1], [1, 2]), {"method": "akima"}, r"x has 2 point\(s\); akima needs 3"),
        (([0, 1, 2], [0, 1, 2, 3], np.ones((3, 4))), {"method": "bicubic"},
         r"x has 3 point\(s\); bicubic needs 4"),
        (([0, 1, 2, 3], [0, 1, 2], np.ones((4, 3))), {"method": "bicubic"},
         r"y has 3 point\(s\); bicubic needs 4"),
        (([0, 1, 1], [1, 2, 3]), {}, r"x must increase, but row 3 has 1.0 after 1.0"),
        (([0, 2, 1], [1, 2, 3]), {}, r"x must increase, but row 3 has 1.0 after 2.0"),
        (([0, 1], [3, 3], np.ones((2, 2))), {}, r"y must increase, but row 2 has 3.0 after 3.0"),
        (([0, NAN, 2], [1, 2, 3]), {}, "x, row 2: nan; fill the gap"),
        (([0, 1, 2], [1, 2, INF]), {}, "z, row 3: inf; fill the gap"),
        (([0, 1, 2], [1, None, 3]), {}, "z, row 2: None is not a number"),
        (([0, 1, 2], [1, "2", 3]), {}, "z, row 2: '2' is not a number"),
        (([0, 1, 2], [1, True, 3]), {}, "z, row 2: True is not a number"),
        (([0, 1, 2], [1, 2j, 3]), {}, "z, row 2: 2j is not a number"),
        (([0, 1, 2], [1, 2]), {}, r"z has 2 row\(s\) for 3 of x"),
        (([0, 1], [0, 1], [[1, 2], [3]]), {}, r"row 2 of z has 1 value\(s\) for 2 of y"),
        (([0, 1], [0, 1], [[1, 2]]), {}, r"z has 1 row\(s\) for 2 of x"),
        (([0, 1], [0, 1], [1, 2]), {}, "row 1 of z must be a list or an array, not 1"),
        (([0, 1], [[1, 2], [3, 4]]), {}, r"z, row 1: \[1, 2\] is not a number"),
        (([0, 1], [0, 1], [[1, NAN], [3, 4]]), {}, "row 1 of z, row 2: nan"),
        ((5, [1, 2]), {}, "x must be a list or an array, not 5"),
        (("01", [1, 2]), {}, "x must be a list or an array, not '01'"),
        ((np.array(1.0), [1, 2]), {}, "x is one number"),
        (([0, 1],), {}, r"\[0, 1\] is no pandas Series or DataFrame"),
        ((), {}, r"give x and z, or x, y and z.*not 0 argument"),
        (([0, 1], [0, 1], [0, 1], [0, 1]), {}, r"not 4 argument"),
        (([0, 1], [0, 1]), {"method": "cubic"}, "method='cubic'.*there are linear, pchip, akima"),
        (([0, 1], [0, 1]), {"method": "bilinear"}, "over one axis there are linear, pchip, akima"),
        (([0, 1], [0, 1], np.ones((2, 2))), {"method": "pchip"}, "over two axes there are bilinear, bicubic"),
        (([0, 1], [0, 1]), {"outside": "clamp"}, "outside='clamp'; there are hold, extend, refuse"),
        (([0, 1], [0, 1]), {"outside": None}, "outside=None"),
        ((range(100_001), range(100_001)), {}, "100001 values; at most 100000"),
    ],
)  # fmt: skip
def test_points_are_refused(samples: Samples, how: dict[str, Any], says: str) -> None:
    with pytest.raises(bg.TableError, match=f"^table 'map'.*{says}"):
        bg.LookupTable("map", *samples, **how)


@pytest.mark.parametrize(
    "name", ["", "2x", "a b", "for", "pi", "t", "sin", "Max", "Piecewise", None, 3]
)
def test_names_are_refused(name: Any) -> None:
    with pytest.raises(bg.TableError, match=r"table"):
        bg.LookupTable(name, [0, 1], [0, 1])


def _spoiled(rng: random.Random) -> tuple[Samples, dict[str, str], str]:
    """A good table with one thing wrong, and what the refusal has to name."""
    two = rng.random() < 0.5
    counts = [rng.randint(5, 9) for _ in range(1 + two)]
    axes = [sorted(rng.sample(range(100), count)) for count in counts]
    z: Any = [[rng.random() for _ in range(counts[-1])] for _ in range(counts[0])]
    z = z if two else [row[0] for row in z]
    samples: Samples = [[float(x) for x in axis] for axis in axes] + [z]
    which = rng.randrange(1 + two)
    at, letter = rng.randrange(1, counts[which]), "xy"[which]
    row = rng.randrange(counts[0])
    wrong = rng.choice([NAN, INF, -INF, None, "gap", 1j])

    def not_rising() -> str:
        samples[which][at] = samples[which][at - 1] - rng.choice([0.0, 1.0])
        return rf"{letter} must increase, but row {at + 1} "

    def no_number() -> str:
        samples[which][at] = wrong
        return rf"{letter}, row {at + 1}: "

    def gap() -> str:
        if two:
            column = rng.randrange(counts[1])
            z[row][column] = wrong
            return rf"row {row + 1} of z, row {column + 1}: "
        z[row] = wrong
        return rf"z, row {row + 1}: "

    def short() -> str:
        if two and rng.random() < 0.5:
            z[row].pop()
            return rf"row {row + 1} of z has {counts[1] - 1} value\(s\) for {counts[1]} of y"
        z.pop()
        return rf"z has {counts[0] - 1} row\(s\) for {counts[0]} of x"

    spoil: Callable[[], str] = rng.choice([not_rising, no_number, gap, short])
    method = rng.choice(["bilinear", "bicubic"] if two else ["linear", "pchip", "akima"])
    return samples, {"method": method}, spoil()


@pytest.mark.parametrize("seed", range(100))
def test_a_hundred_spoiled_tables_are_refused(seed: int) -> None:
    samples, how, says = _spoiled(random.Random(seed))
    with pytest.raises(bg.TableError, match=f"^table 'torque': {says}"):
        bg.LookupTable("torque", *samples, **how)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "no lines"),
        ("\n\n", "no lines"),
        ("x\n1\n2\n", "one column"),
        ("x,z\n0,1\n1\n", r"line 3: 1 column\(s\), but the first line has 2"),
        ("x,z\n0,1\n1,2,3\n", r"line 3: 3 column\(s\)"),
        ("x,z\n0,1\n1,\n", "line 3: an empty cell"),
        ("x,z\n0,1\n1,one\n", "line 3: 'one' is not a number"),
        ("x,z\n0,1\n1,nan\n", "line 3: nan is not a finite number"),
        ("x;z\n0;1\n1;-inf\n", "line 3: -inf is not a finite number"),
        ("map,0,1\n0,1,2\n1,2\n", r"line 3: 2 column\(s\)"),
        ("map,0,b\n0,1,2\n1,2,3\n", "line 1: 'b' is not a number"),
        ('x,z\n0,"1\n', "not CSV"),
        ("x,z\n0,1\n", r"x has 1 point\(s\)"),
        ("x,z\n", r"x has 0 point\(s\)"),
    ],
)
def test_files_are_refused_by_line(text: str, says: str, tmp_path: Path) -> None:
    path = tmp_path / "map.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(bg.TableError, match=f"table 'map'.*{says}"):
        bg.LookupTable.read("map", path)


def test_other_bytes_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "map.csv"
    path.write_bytes(b"x,z\n0,\xff\n")
    with pytest.raises(bg.TableError, match=re.escape("not UTF-8")):
        bg.LookupTable.read("map", path)
    with pytest.raises(FileNotFoundError):
        bg.LookupTable.read("map", tmp_path / "none.csv")
